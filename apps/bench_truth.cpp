#include "obscura/apps/bench_truth.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_frame.h"
#include "obscura/apps/bench_measure.h"
#include "obscura/apps/setting_names.h"
#include "obscura/apps/signals.h"
#include "obscura/apps/truth_planes.h"

namespace obscura::apps {
namespace {

int seenPixels(const engine::Frame& frame) {
  int n = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) n += frame.g.instance.at(x, y) != raster::kNoTriangle;
  return n;
}

}  // namespace

TruthBenchmark::TruthBenchmark() { asPeersCompute(options); }

void TruthBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "truth", "What the estimators aim at, by tracing rays: O for each membership, the exact W, with standard errors");
  command->add_option("scene", scene, "a .gltf or .glb file")->required();
  command->add_option("-o,--output", outputs, "file to write, repeatable: .exr (all planes as layers), .npy or .pfm (STEM.PLANE.EXT)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--plane", planes, "what to write: classic, linear, sqrt, exponential, tangent_sphere, ball, horizon, transfer, bounce, with --environment also environment_open,"
                                            " environment_shadowed, environment_obscured, environment_lit; or all")
      ->delimiter(',')
      ->type_name("NAME,...")
      ->capture_default_str();
  command->add_flag("--json", json, "one JSON object instead of a table");
  command->add_flag("--quiet", quiet, "no progress bar");
  options.addTo(*command);
  std::vector<std::string> kept = {"--radius", "--membership"};
  kept.insert(kept.end(), kEnvironmentOptions.begin(), kEnvironmentOptions.end());
  removeEstimatorOptions(*command, options, kept);
  truth.addTo(*command);
  command->callback([this, &status] { status = guarded([this] { return run(); }); });
}

int TruthBenchmark::run() {
  endCleanlyOnSignals();
  const auto files = planTruthFiles(outputs, planes, !options.environment.file.empty());
  if (!files) return fail(files.error());
  Progress progress(options.environment.file.empty() ? 3 : 4, quiet);
  const auto traced = renderTraced(scene, options, {}, progress);
  if (!traced) return fail(traced.error());
  const auto& [loaded, resolved, frame, environment] = *traced;
  const auto found = truthOfFrame(loaded, resolved, frame, truth, progress, environment);
  if (!found) return fail(found.error());
  for (const TruthFile& file : *files)
    if (const auto done = writeTruthFile(file, found->truth, frame); !done) return fail(done.error());
  progress.finish();
  print(resolved, frame, *found);
  return 0;
}

void TruthBenchmark::print(const ResolvedFrame& resolved, const engine::Frame& frame, const SceneTruth& found) const {
  const std::string& membership = nameOf(kMembershipNames, resolved.frame.transfer.membership);
  nlohmann::ordered_json out;
  out["scene"] = scene;
  out["size"] = {frame.width, frame.height};
  out["pixels_seen"] = seenPixels(frame);
  out["radius"] = resolved.frame.transfer.radius;
  out["membership"] = membership;
  out["rays"] = truth.rays;
  out["scrambles"] = kTruthScrambles;
  out["key"] = found.key;
  if (!found.environmentKey.empty()) out["environment_key"] = found.environmentKey;
  out["file"] = found.file;
  out["cached"] = found.cached;
  out["build_ms"] = found.buildMs;
  out["trace_ms"] = found.traceMs;
  if (!json)
    std::printf("%s, %dx%d, %d pixels seen, R = %g, W with the %s membership, %d rays a pixel\n%s\n\n%-20s %9s %12s %12s\n",
                scene.c_str(), frame.width, frame.height, seenPixels(frame), double(resolved.frame.transfer.radius), membership.c_str(),
                truth.rays,
                found.cached ? ("from " + found.file).c_str()
                             : ("tree " + std::to_string(int(found.buildMs)) + " ms, rays " + std::to_string(int(found.traceMs)) + " ms").c_str(),
                "plane", "mean", "rms error", "max error");
  for (const TruthPlane& plane : truthPlanes()) {
    if (!has(found.truth, plane)) continue;
    const TruthSummary s = summaryOf(plane, found.truth, frame);
    out["planes"].push_back({{"name", plane.name}, {"mean", s.mean}, {"standard_error_rms", s.rmsError}, {"standard_error_max", s.maxError}});
    if (!json) std::printf("%-20s %9.5f %12.6f %12.6f\n", plane.name, s.mean, s.rmsError, s.maxError);
  }
  if (json) std::printf("%s\n", out.dump().c_str());
}

}  // namespace obscura::apps
