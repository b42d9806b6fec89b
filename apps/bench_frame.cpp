#include "obscura/apps/bench_frame.h"

#include <cstdio>
#include <vector>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_measure.h"
#include "obscura/engine/digest.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/plane_image.h"

namespace obscura::apps {
namespace {

struct Column {
  const char* name;
  double engine::FrameTimings::*value;
};
constexpr Column kColumns[] = {
    {"gbuffer_ms", &engine::FrameTimings::gbuffer}, {"shadows_ms", &engine::FrameTimings::shadows},
    {"direct_ms", &engine::FrameTimings::direct},   {"transfer_ms", &engine::FrameTimings::transfer},
    {"filter_ms", &engine::FrameTimings::filter},   {"light_ms", &engine::FrameTimings::light},
    {"downsample_ms", &engine::FrameTimings::downsample}, {"display_ms", &engine::FrameTimings::display},
    {"frame_ms", &engine::FrameTimings::frame},
};
}  // namespace

void asPeersCompute(FrameOptions& options) {
  post::setQuality(options.transfer, options.quality = post::Quality::Paper);
  options.transfer.albedo = post::TransferAlbedo::Neighbour;
  options.radius = 0.5;
  options.bias = 0.005;
  options.filterThreshold = 0.1;
}

void FrameBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("frame", "Stages of a frame of a scene: G-buffer, transfer, filter, light, display");
  command->add_option("scene", scene, "a .gltf or .glb file")->required();
  command->add_option("--frames", frames, "measured frames, after two that are not")->check(CLI::Range(1, 100000))->capture_default_str();
  command->add_flag("--json", json, "one JSON object instead of a table");
  options.addTo(*command);
  command->callback([this, &status] { status = run(); });
}

int FrameBenchmark::run() {
  const auto loaded = engine::sceneFromGltf(scene, options.load());
  if (!loaded) return fail(loaded.error());
  auto resolved = options.resolve(*loaded);
  if (!resolved) return fail(resolved.error());
  resolved->frame.display = true;

  engine::Renderer renderer(resolved->raster, resolved->reference);
  engine::Frame frame;
  std::vector<double> times[std::size(kColumns)];
  std::string digest;
  for (int k = 0; k < frames + kWarmUp; ++k) {
    if (const auto done = renderer.render(*loaded, resolved->frame, frame); !done) return fail(done.error());
    const std::string found = engine::digest(engine::interleave({&frame.color.rgb[0], &frame.color.rgb[1], &frame.color.rgb[2]}));
    if (!digest.empty() && found != digest) {
      std::fprintf(stderr, "obscura-bench: error: frame %d differs from the one before: %s, %s\n", k, found.c_str(), digest.c_str());
      return 1;
    }
    digest = found;
    if (k < kWarmUp) continue;
    for (size_t c = 0; c < std::size(kColumns); ++c) times[c].push_back(frame.timings.*kColumns[c].value);
  }

  const raster::Statistics& s = frame.statistics;
  if (json) {
    nlohmann::ordered_json out;
    out["renderer"] = "obscura";
    out["target"] = raster::targetName(raster::chooseTarget(resolved->raster.target));
    out["threads"] = resolved->raster.threads;
    out["size"] = {frame.width, frame.height};
    out["supersample"] = resolved->frame.supersample;
    out["samples"] = resolved->frame.transfer.samples;
    out["triangles"] = s.triangles;
    for (size_t c = 0; c < std::size(kColumns); ++c) out[kColumns[c].name] = quantile(times[c], 0.5);
    out["frame_ms_p10"] = quantile(times[std::size(kColumns) - 1], 0.1);
    out["frame_ms_p90"] = quantile(times[std::size(kColumns) - 1], 0.9);
    out["digest"] = digest;
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  std::printf("%s, %dx%d, %llu triangles, %d samples, %s, %d frames\n", scene.c_str(), frame.width, frame.height,
              static_cast<unsigned long long>(s.triangles), resolved->frame.transfer.samples,
              raster::targetName(raster::chooseTarget(resolved->raster.target)), frames);
  std::printf("%-13s %9s %9s %9s\n", "stage", "median", "p10", "p90");
  for (size_t c = 0; c < std::size(kColumns); ++c)
    std::printf("%-13s %9.3f %9.3f %9.3f\n", kColumns[c].name, quantile(times[c], 0.5), quantile(times[c], 0.1), quantile(times[c], 0.9));
  std::printf("digest %s\n", digest.c_str());
  return 0;
}

}  // namespace obscura::apps
