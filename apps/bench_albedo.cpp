#include "obscura/apps/bench_albedo.h"

#include <algorithm>
#include <cstdio>

#include "obscura/apps/bench_frame.h"
#include "obscura/apps/bench_measure.h"
#include "obscura/apps/error_output.h"
#include "obscura/apps/gnuplot.h"
#include "obscura/apps/painted_scene.h"
#include "obscura/apps/signals.h"

namespace obscura::apps {

AlbedoBenchmark::AlbedoBenchmark() { asPeersCompute(options); }

void AlbedoBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* c = app.add_subcommand("albedo", "Which W is nearest to the exact, recursive one, on which albedo");
  c->add_option("scenes", scenes, "one or more .gltf or .glb files")->required();
  options.addTo(*c);
  removeEstimatorOptions(*c, options,
                         {"--quality", "--radius", "--membership", "--bias", "--silhouette-bound", "--filter-threshold", "--samples", "--steps",
                          "--estimator", "--layers", "--interleave", "--filter", "--filter-guide"});
  c->add_option("--albedo", albedos, "of every surface, from 0 to 1, in place of the scene's; \"scene\": its own colours")
      ->delimiter(',')->allow_extra_args(false)->type_name("NUMBER|scene,...")->capture_default_str()
      ->check([](const std::string& text) { return albedoOf(text) ? std::string() : "\"" + text + "\" is neither a number from 0 to 1 nor \"scene\""; });
  truth.addTo(*c);
  const char* output = "Output";
  c->add_flag("--json", json, "one JSON object instead of tables")->group(output);
  c->add_option("--csv", csv, "all rows to this file")->type_name("FILE")->group(output);
  c->add_option("--plot", plot, "RMSE by albedo, by gnuplot: .svg, .png, or .gp for its script")
      ->check(wrongPlotFile)->type_name("FILE")->group(output);
  c->add_option("--map", map, kMapHelp)->expected(2)->type_name("ROW FILE")->group(output);
  c->add_flag("--quiet", quiet, "no progress bar")->group(output);
  c->callback([this, &status] { status = guarded([this] { return run(); }); });
}

engine::Result<AlbedoScene> AlbedoBenchmark::measure(const std::string& file, const std::vector<Albedo>& list, std::optional<size_t> mapped,
                                                     Progress& progress) const {
  AlbedoScene out;
  out.file = file;
  out.rays = truth.rays;
  out.truths.resize(list.size());
  out.rows = albedoRows(list.size());
  for (const AlbedoPass& pass : albedoPasses(list)) {
    const auto traced = renderTraced(file, options, {}, progress, [&](engine::Scene& scene) {
      removeLights(scene);
      if (pass.paint) paint(scene, *pass.paint);
    });
    if (!traced) return traced.error();
    const auto found = truthOfFrame(traced->scene, traced->resolved, traced->frame, truth, progress);
    if (!found) return found.error();
    const auto seen = seenOf(traced->frame, file);
    if (!seen) return seen.error();
    out.width = traced->frame.width, out.height = traced->frame.height;
    out.settings = traced->resolved.frame.transfer;

    progress.step("measuring");
    raster::Parallel parallel(traced->resolved.raster.threads);
    engine::Renderer renderer(traced->resolved.raster);
    for (const AlbedoPass::Part& part : pass.parts) {
      PlaneRefs exact, error;
      for (const size_t c : part.channels) {
        exact.push_back(&found->truth.value[size_t(TruthQuantity::TransferR) + c]);
        error.push_back(&found->truth.error[size_t(TruthQuantity::TransferR) + c]);
      }
      out.truths[part.albedo] = {list[part.albedo].name, found->key, rmsOver(error, *seen)};
      const ErrorMeter meter(exact, *seen, parallel);
      for (size_t i = 0; i < out.rows.size(); ++i) {
        AlbedoRow& row = out.rows[i];
        if (row.albedo != part.albedo) continue;
        const TransferPlanes w = row.traced ? tracedTransfer(row.model, found->truth, *traced) : estimatedTransfer(row.model, *traced, renderer);
        PlaneRefs planes;
        for (const size_t c : part.channels) planes.push_back(&w[std::min(c, w.size() - 1)]);
        row.error = meter.measure(planes);
        if (mapped == i)
          if (const auto done = writeErrorMap(map[1], meter.map(planes, kMapScale)); !done) return done.error();
      }
    }
  }
  markNearest(out.rows);
  return out;
}

int AlbedoBenchmark::run() {
  endCleanlyOnSignals();
  std::vector<Albedo> list;
  for (const std::string& text : albedos) list.push_back(*albedoOf(text));
  std::optional<size_t> mapped;
  if (map.size() == 2) {
    const auto row = mapRow(map[0], albedoRows(list.size()).size());
    if (!row) return fail(row.error());
    mapped = *row;
  }
  Progress progress(int(4 * albedoPasses(list).size() * scenes.size()), quiet);
  std::vector<AlbedoScene> all;
  for (size_t k = 0; k < scenes.size(); ++k) {
    engine::Result<AlbedoScene> scene = measure(scenes[k], list, k == 0 ? mapped : std::nullopt, progress);
    if (!scene) return fail(scene.error());
    all.push_back(std::move(*scene));
  }
  progress.finish();
  const auto done = writeScenes(all, csv, plot, json, writeAlbedoPlot);
  return done ? 0 : fail(done.error());
}

}  // namespace obscura::apps
