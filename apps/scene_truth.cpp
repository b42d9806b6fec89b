#include "obscura/apps/scene_truth.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "obscura/apps/cache_folder.h"
#include "obscura/apps/environment_truth.h"
#include "obscura/apps/truth_cache.h"
#include "obscura/engine/ambient_light.h"
#include "obscura/engine/gltf.h"
#include "obscura/raster/stopwatch.h"

namespace obscura::apps {

void TruthOptions::addTo(CLI::App& app) {
  const char* group = "Truth";
  app.add_option("--rays", rays, "a pixel, in " + std::to_string(kTruthScrambles) + " independent scrambles: a multiple of that")
      ->check([](const std::string& text) {
        char* end = nullptr;
        const long n = std::strtol(text.c_str(), &end, 10);
        const bool good = *end == 0 && n >= kTruthScrambles && n <= 1 << 20 && n % kTruthScrambles == 0;
        return good ? std::string() : "\"" + text + "\" is not a multiple of " + std::to_string(kTruthScrambles) + " up to 1048576";
      })
      ->capture_default_str()
      ->group(group);
  app.add_option("--cache", cache, "folder to keep truths in [$OBSCURA_CACHE, else $XDG_CACHE_HOME/obscura, else ~/.cache/obscura]")
      ->type_name("DIR")
      ->group(group);
  app.add_flag("--no-cache", noCache, "trace it, and keep nothing")->group(group);
}

const std::vector<std::string> kEnvironmentOptions = {"--environment", "--env-projection", "--env-rotate", "--env-intensity", "--env-cache"};

void removeEstimatorOptions(CLI::App& app, FrameOptions& options, const std::vector<std::string>& kept) {
  options.displacement = false;
  options.brdf = post::Brdf::Lambert;
  const auto concerned = [](const CLI::Option* o) {
    return o->get_group() == "Ambient transfer" || o->get_group() == "Environment" || o->get_group() == "Lights" ||
           o->get_group().rfind("Display", 0) == 0;
  };
  for (const CLI::Option* o : app.get_options(concerned))
    if (std::find(kept.begin(), kept.end(), o->get_name()) == kept.end()) app.remove_option(app.get_option(o->get_name()));
  for (const char* name : {"--supersample", "--border", "--background", "--ambient-light", "--separation", "--displacement", "--brdf", "--reference"})
    app.remove_option(app.get_option(name));
}

engine::Result<TracedFrame> renderTraced(const std::string& file, const FrameOptions& options, const std::vector<engine::Aov>& more,
                                         Progress& progress, const std::function<void(engine::Scene&)>& change) {
  progress.step("loading");
  engine::LoadOptions load;
  load.scene = options.scene;
  auto scene = engine::sceneFromGltf(file, load);
  if (!scene) return scene.error();
  if (change) change(*scene);
  auto resolved = options.resolve(*scene);
  if (!resolved) return resolved.error();
  TracedFrame out{std::move(*scene), std::move(*resolved), {}, {}};
  if (const EnvironmentOptions& e = options.environment; !e.file.empty()) {
    raster::Parallel parallel(out.resolved.raster.threads);
    auto map = engine::readEnvironmentMap(e.file, e.projection, parallel);
    if (!map) return map.error();
    out.environment = std::move(map->map);
  }

  progress.step("rendering");
  out.resolved.frame.aovs = truthAovs();
  out.resolved.frame.aovs.insert(out.resolved.frame.aovs.end(), more.begin(), more.end());
  if (const auto done = engine::Renderer(out.resolved.raster).render(out.scene, out.resolved.frame, out.frame); !done) return done.error();
  if (const auto seen = seenOf(out.frame, file); !seen) return seen.error();
  return out;
}

engine::Result<raster::Plane<uint8_t>> seenOf(const engine::Frame& frame, const std::string& file) {
  raster::Plane<uint8_t> seen(frame.width, frame.height);
  bool any = false;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) any |= (seen.at(x, y) = frame.g.instance.at(x, y) != raster::kNoTriangle);
  if (!any) return engine::Error{engine::ErrorCode::BadInput, "nothing is visible from this camera", file, ""};
  return seen;
}

double rmsOver(const PlaneRefs& planes, const raster::Plane<uint8_t>& seen) {
  double sum = 0, n = 0;
  for (const raster::Plane<float>* plane : planes)
    for (int y = 0; y < seen.height(); ++y)
      for (int x = 0; x < seen.width(); ++x)
        if (seen.at(x, y)) sum += double(plane->at(x, y)) * plane->at(x, y), ++n;
  return std::sqrt(sum / std::max(n, 1.0));
}

engine::Result<SceneTruth> truthOfFrame(const engine::Scene& scene, const ResolvedFrame& resolved, const engine::Frame& frame,
                                        const TruthOptions& options, Progress& progress,
                                        const std::optional<engine::EnvironmentMap>& environment) {
  TruthSettings settings;
  settings.radius = resolved.frame.transfer.radius;
  settings.membership = resolved.frame.transfer.membership;
  settings.rays = options.rays;
  settings.threads = resolved.raster.threads;

  const RaySurface surface(scene, resolved.frame.camera);
  const TruthStarts starts(scene, surface, resolved.frame, frame);
  std::optional<RayScene> rays;
  const std::string folder = options.noCache ? "" : options.cache.value_or(defaultCacheFolder());
  SceneTruth out;
  // From the cache, or traced and kept there. trace(done)
  const auto kept = [&](const char* what, const std::string& key, int quantities, const auto& trace) -> engine::Result<Truth> {
    progress.step(what);
    const std::string file = folder.empty() ? "" : truthFile(folder, key);
    if (!file.empty())
      if (auto found = loadTruth(file, key, frame.width, frame.height, quantities)) return std::move(*found);
    out.cached = false;
    if (!rays) rays.emplace(surface, settings.threads);
    out.buildMs = rays->buildMs();
    raster::Stopwatch watch;
    std::atomic<int> rows{0};
    Truth traced = trace([&](int n) { progress.at(double(rows += n) / frame.height); });
    out.traceMs += watch.lap();
    if (file.empty()) return traced;
    if (const auto stored = storeTruth(file, key, traced); !stored) {
      if (options.cache) return stored.error();
      progress.clear();
      std::fprintf(stderr, "obscura-bench: warning: the truth is not kept: %s\n", stored.error().text().c_str());
    }
    return traced;
  };

  out.key = truthKey(scene, surface, resolved.frame, frame, settings);
  if (!folder.empty()) out.file = truthFile(folder, out.key);
  auto truth = kept("tracing the truth", out.key, kTruthQuantities, [&](const auto& done) {
    return traceTruth(surface, *rays, starts, frame.width, frame.height, settings, done);
  });
  if (!truth) return truth.error();
  out.truth = std::move(*truth);
  if (!environment) return out;

  out.environmentKey = environmentTruthKey(out.key, *environment, resolved.frame);
  auto light = kept("tracing the environment's light", out.environmentKey, kEnvironmentQuantities, [&](const auto& done) {
    raster::Parallel parallel(settings.threads);
    const EnvironmentSampler sampler(*environment, engine::viewFromEnvironment(resolved.frame.camera, resolved.frame.environmentRotation),
                                     resolved.frame.environmentIntensity, parallel);
    return traceEnvironment(surface, *rays, starts, sampler, frame.width, frame.height, settings, done);
  });
  if (!light) return light.error();
  append(out.truth, std::move(*light));
  return out;
}

}  // namespace obscura::apps
