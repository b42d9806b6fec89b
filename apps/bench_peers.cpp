#include "obscura/apps/bench_peers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_measure.h"
#include "obscura/apps/gl_frame.h"
#include "obscura/apps/scene_truth.h"
#include "obscura/engine/gltf.h"

namespace obscura::apps {
namespace {

struct Stage {
  const char* name;
  std::vector<double> ours, theirs;  // ms, one per frame

  void add(double a, double b) { ours.push_back(a), theirs.push_back(b); }
  double ratio() const {  // median of the frames' ratios
    std::vector<double> ratios;
    for (size_t k = 0; k < ours.size(); ++k) ratios.push_back(theirs[k] / ours[k]);
    return quantile(ratios, 0.5);
  }
};

struct Difference {
  double rms = 0, mean = 0, far = 0, most = 0;  // of 1; far: share of values more than 2/255 apart
};

Difference differenceOf(const engine::Frame& frame, const std::vector<uint8_t>& theirs) {
  Difference d;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double v = std::min(double(frame.g.albedo[c].at(x, y)) * double(frame.transfer.w[c].at(x, y)), 1.0);
        const double by = theirs[(size_t(y) * size_t(frame.width) + size_t(x)) * 4 + size_t(c)] / 255.0 - v;
        d.rms += by * by, d.mean += by, d.far += std::fabs(by) > 2 / 255.0, d.most = std::max(d.most, std::fabs(by));
      }
  const double n = 3.0 * frame.width * frame.height;
  d.rms = std::sqrt(d.rms / n), d.mean /= n, d.far /= n;
  return d;
}

// Leaves what both draw: base colours, their textures, alpha masks, triangles; no lights.
void simplify(engine::Scene& scene) {
  scene.implicits.clear();
  scene.lights.clear();
  for (raster::Material& m : scene.materials) {
    m.normalMap.texture = m.emissiveMap.texture = m.heightMap.texture = -1;
    m.emissive = glm::vec3(0);
    m.unlit = false;
  }
}

}  // namespace

void PeersBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* c = app.add_subcommand("peers", "The same frame by Mesa's llvmpipe, stage by stage, and how far both pictures are apart");
  c->add_option("scene", scene, "a .gltf or .glb file")->required();
  c->add_option("--frames", frames, "measured, in turns, after two that are not")->check(CLI::Range(1, 10000))->capture_default_str();
  c->add_flag("--json", json, "one JSON object instead of a table");
  options.addTo(*c);
  removeEstimatorOptions(*c, options, {"--radius", "--membership", "--samples", "--bias", "--filter-threshold"});
  c->remove_option(c->get_option("--crop"));
  c->callback([this, &status] { status = guarded([this] { return run(); }); });
}

int PeersBenchmark::run() {
  auto loaded = engine::sceneFromGltf(scene, options.load());
  if (!loaded) return fail(loaded.error());
  simplify(*loaded);
  auto resolved = options.resolve(*loaded);
  if (!resolved) return fail(resolved.error());
  if (resolved->frame.camera.projection != raster::Projection::Perspective)
    return fail({engine::ErrorCode::Usage, "peers are compared through a perspective camera", scene, ""});
  resolved->frame.aovs = {engine::Aov::Color, engine::Aov::Albedo, engine::Aov::Transfer};
  resolved->frame.lights.clear();
  const int threads = resolved->raster.threads > 0 ? resolved->raster.threads : int(std::max(1u, std::thread::hardware_concurrency()));
  GlFrame gl(openGl(threads), *loaded, resolved->frame);
  engine::Renderer renderer(resolved->raster);
  engine::Frame frame;
  Stage stages[] = {{"G-buffer", {}, {}}, {"transfer", {}, {}}, {"filter, light", {}, {}}, {"frame", {}, {}}};
  for (int k = -kWarmUp; k < frames; ++k) {
    if (const auto done = renderer.render(*loaded, resolved->frame, frame); !done) return fail(done.error());
    const GlTimings t = gl.render();
    if (k < 0) continue;
    const engine::FrameTimings& o = frame.timings;
    stages[0].add(o.gbuffer, t.gbuffer);
    stages[1].add(o.transfer, t.transfer);
    stages[2].add(o.filter + o.light, t.filter);
    stages[3].add(o.gbuffer + o.transfer + o.filter + o.light, t.gbuffer + t.transfer + t.filter);
  }
  const Difference d = differenceOf(frame, gl.pixels());
  const std::string target = raster::targetName(raster::chooseTarget(resolved->raster.target));
  if (json) {
    nlohmann::ordered_json out = {{"scene", scene}, {"size", {frame.width, frame.height}}, {"target", target}, {"threads", threads},
                                  {"peer", gl.renderer()}, {"samples", resolved->frame.transfer.samples}, {"frames", frames}};
    for (const Stage& s : stages)
      out["stages"].push_back({{"stage", s.name}, {"obscura_ms", quantile(s.ours, 0.5)}, {"peer_ms", quantile(s.theirs, 0.5)}, {"ratio", s.ratio()}});
    out["difference"] = {{"rms", d.rms}, {"mean", d.mean}, {"beyond_2_of_255", d.far}, {"max", d.most}};
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  std::printf("%s, %dx%d, %d samples, %s, %d threads, %d frames in turns\nagainst %s\n\n%-14s %10s %10s %8s\n", scene.c_str(), frame.width,
              frame.height, resolved->frame.transfer.samples, target.c_str(), threads, frames, gl.renderer().c_str(), "stage", "obscura ms",
              "peer ms", "ratio");
  for (const Stage& s : stages)
    std::printf("%-14s %10.3f %10.3f %8.2f\n", s.name, quantile(s.ours, 0.5), quantile(s.theirs, 0.5), s.ratio());
  std::printf("\npictures, peer - obscura, linear, of 1: rms %.5f, mean %+.5f, max %.3f; %.3f %% differ by more than 2/255\n", d.rms, d.mean,
              d.most, 100 * d.far);
  return 0;
}

}  // namespace obscura::apps
