#include "obscura/apps/bench_irradiance.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_frame.h"
#include "obscura/apps/bench_measure.h"
#include "obscura/apps/error_output.h"
#include "obscura/apps/painted_scene.h"
#include "obscura/apps/signals.h"

namespace obscura::apps {

IrradianceBenchmark::IrradianceBenchmark() { asPeersCompute(options); }

void IrradianceBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* c = app.add_subcommand("irradiance", "An environment's diffuse light, nine coefficients times O or W, by the traced truth");
  c->add_option("scene", scene, "a .gltf or .glb file")->required();
  options.addTo(*c);
  std::vector<std::string> kept = {"--quality", "--radius", "--membership", "--bias", "--silhouette-bound", "--filter-threshold", "--samples", "--steps",
                                   "--estimator", "--layers", "--interleave", "--filter", "--filter-guide", "--albedo"};
  kept.insert(kept.end(), kEnvironmentOptions.begin(), kEnvironmentOptions.end());
  removeEstimatorOptions(*c, options, kept);
  c->get_option("--environment")->required();
  truth.addTo(*c);
  const char* output = "Output";
  c->add_flag("--json", json, "one JSON object instead of a table")->group(output);
  c->add_option("--csv", csv, "all rows to this file")->type_name("FILE")->group(output);
  c->add_option("--map", map,
                "PNG of a row's error: white where it is right, red where too bright, blue where too dark, full at a quarter of the truth's mean")
      ->expected(2)->type_name("ROW FILE")->group(output);
  c->add_flag("--quiet", quiet, "no progress bar")->group(output);
  c->callback([this, &status] { status = guarded([this] { return run(); }); });
}

namespace {

std::string csvOf(const std::vector<IrradianceRow>& rows) {
  std::string out = "row,light,factor,source,truth,mean,rmse,bias,p95,max,ssim\n";
  for (size_t k = 0; k < rows.size(); ++k) {
    const IrradianceRow& r = rows[k];
    out += formatted("%zu,%s,%s,%s,%s,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n", k + 1, nameOf(kLightSourceNames, r.light).c_str(),
                     nameOf(kLightFactorNames, r.factor).c_str(), r.source().c_str(), nameOf(kLightTruthNames, r.truth).c_str(), r.mean,
                     r.error.rmse, r.error.bias, r.error.p95, r.error.max, r.error.ssim);
  }
  return out;
}

std::string tableOf(const std::vector<IrradianceRow>& rows) {
  std::string out = formatted("%4s %-5s %-6s %-9s %-8s %8s %8s %8s %8s %8s %8s %8s\n", "row", "light", "factor", "by", "truth", "mean", "rmse",
                              "of mean", "bias", "p95", "max", "ssim");
  for (size_t k = 0; k < rows.size(); ++k) {
    const IrradianceRow& r = rows[k];
    out += formatted("%4zu %-5s %-6s %-9s %-8s %8.4f %8.4f %7.1f%% %+8.4f %8.4f %8.4f %8.5f\n", k + 1, nameOf(kLightSourceNames, r.light).c_str(),
                     nameOf(kLightFactorNames, r.factor).c_str(), r.source().c_str(), nameOf(kLightTruthNames, r.truth).c_str(), r.mean,
                     r.error.rmse, r.mean > 0 ? 100 * r.error.rmse / r.mean : 0, r.error.bias, r.error.p95, r.error.max, r.error.ssim);
  }
  return out;
}

}  // namespace

std::string IrradianceBenchmark::headOf(const TracedFrame& traced, const SceneTruth& found) const {
  const post::AmbientSettings& t = traced.resolved.frame.transfer;
  std::string out = scene + " in " + options.environment.file +
                    formatted(", %dx%d, R = %g, %s membership; depth map: %s, n = %d, m = %d\ntruth: irradiance / pi, %d rays a pixel; its standard error:",
                              traced.frame.width, traced.frame.height, double(t.radius), nameOf(kMembershipNames, t.membership).c_str(),
                              nameOf(kEstimatorNames, t.estimator).c_str(), t.samples, t.steps, truth.rays);
  const auto seen = seenOf(traced.frame, scene);
  for (const auto& [name, red] : kLightTruthNames) {
    const raster::Plane<float>* error = &found.truth.error[size_t(red)];
    out += " " + name + formatted(" %.5f", rmsOver({error, error + 1, error + 2}, *seen));
  }
  return out + "\n\n";
}

int IrradianceBenchmark::run() {
  endCleanlyOnSignals();
  std::vector<IrradianceRow> rows = irradianceRows();
  std::optional<size_t> mapped;
  if (map.size() == 2) {
    const auto row = mapRow(map[0], rows.size());
    if (!row) return fail(row.error());
    mapped = *row;
  }
  Progress progress(5, quiet);
  const auto traced = renderTraced(scene, options, {}, progress, removeLights);
  if (!traced) return fail(traced.error());
  const auto found = truthOfFrame(traced->scene, traced->resolved, traced->frame, truth, progress, traced->environment);
  if (!found) return fail(found.error());
  const auto seen = seenOf(traced->frame, scene);
  if (!seen) return fail(seen.error());
  progress.step("measuring");
  engine::Image image;
  measureIrradiance(*traced, found->truth, *seen, rows, mapped, image);
  progress.finish();
  if (mapped)
    if (const auto done = writeErrorMap(map[1], std::move(image)); !done) return fail(done.error());
  if (!csv.empty())
    if (const auto done = writeText(csv, csvOf(rows)); !done) return fail(done.error());
  if (!json) {
    std::fputs((headOf(*traced, *found) + tableOf(rows)).c_str(), stdout);
    return 0;
  }
  nlohmann::ordered_json out = {{"scene", scene}, {"environment", options.environment.file}, {"size", {traced->frame.width, traced->frame.height}},
                                {"radius", traced->resolved.frame.transfer.radius}, {"truth_rays", truth.rays},
                                {"truth_key", found->environmentKey}};
  for (size_t k = 0; k < rows.size(); ++k) {
    const IrradianceRow& r = rows[k];
    out["rows"].push_back({{"row", k + 1}, {"light", nameOf(kLightSourceNames, r.light)}, {"factor", nameOf(kLightFactorNames, r.factor)},
                           {"source", r.source()}, {"truth", nameOf(kLightTruthNames, r.truth)}, {"mean", r.mean}, {"rmse", r.error.rmse},
                           {"bias", r.error.bias}, {"p95", r.error.p95}, {"max", r.error.max}, {"ssim", r.error.ssim}});
  }
  std::printf("%s\n", out.dump().c_str());
  return 0;
}

}  // namespace obscura::apps
