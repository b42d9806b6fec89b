#include "obscura/apps/bench_pareto.h"

#include <cmath>
#include <cstdio>

#include "obscura/apps/bench_frame.h"
#include "obscura/apps/bench_measure.h"
#include "obscura/apps/error_output.h"
#include "obscura/apps/gnuplot.h"
#include "obscura/apps/ray_estimator.h"
#include "obscura/apps/signals.h"
#include "obscura/engine/digest.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/image_file.h"
#include "obscura/engine/plane_image.h"
#include "obscura/raster/stopwatch.h"

namespace obscura::apps {
namespace {

template <class T>
std::vector<std::string> namesOf(const Names<T>& names) {
  std::vector<std::string> out;
  for (const auto& n : names) out.push_back(n.first);
  return out;
}

// What a row's method writes to, and what it needs from frame to frame. Rows of one quantity share one.
struct Bench {
  engine::Renderer renderer;
  engine::Frame frame;
  post::TransferSums sums;
  explicit Bench(const raster::Settings& s) : renderer(s) {}

  PlaneRefs result(const ParetoRow& row) const {
    const post::Transfer& t = frame.transfer;
    if (row.transfer()) return {&t.w[0], &t.w[1], &t.w[2]};
    return {&t.obscurance};
  }
};

void runRow(const engine::Scene& scene, engine::FrameSettings settings, const ParetoRow& row, Bench& bench) {
  settings.aovs = {row.transfer() ? engine::Aov::Transfer : engine::Aov::Obscurance};
  settings.transfer = row.settings;
  if (row.settings.layers == 2) settings.separation = float(engine::kLayerSeparation * double(row.settings.radius));
  if (const auto done = bench.renderer.render(scene, settings, bench.frame); !done) throw std::runtime_error(done.error().text());
}

// By Embree or by a peer, on the G-buffer that the frame has.
void runOther(const RayScene* rays, const engine::FrameSettings& settings, const ParetoRow& row, raster::Parallel& parallel,
              raster::Target target, Bench& bench) {
  engine::Frame& f = bench.frame;
  const raster::Window window = {f.x, f.y, f.width, f.height};
  post::TransferInput in = {&f.g, post::makeProjector(settings.camera, f.imageWidth, f.imageHeight, window), row.settings, {}, nullptr};
  const auto forRows = [&](const auto& body) {
    parallel.forRanges(size_t(f.height), 8, [&](size_t y0, size_t y1, int) { body(int(y0), int(y1)); });
  };
  raster::Stopwatch watch;
  bench.sums = post::makeTransferSums(in, std::move(bench.sums));
  if (row.peer) {
    in.offsets = peerPoints(*row.peer, row.settings);
    forRows([&](int y0, int y1) { peerOcclusion(*row.peer, in, y0, y1, bench.sums, target); });
  } else {
    traceObscurance(*rays, in, parallel, bench.sums);
  }
  f.timings.transfer = watch.lap();
  f.transfer = post::makeTransfer(f.width, f.height, {true}, std::move(f.transfer));
  forRows([&](int y0, int y1) {
    post::depthFilter(in, bench.sums, y0, y1, f.transfer, target);
    if (row.peer) clampPeers(y0, y1, f.transfer);
  });
  f.timings.filter = watch.lap();
}

std::string digestOfPlanes(const PlaneRefs& p) {
  return engine::digest(p.size() == 1 ? engine::interleave({p[0]}) : engine::interleave({p[0], p[1], p[2]}));
}

}  // namespace

ParetoBenchmark::ParetoBenchmark() {
  asPeersCompute(options);
  options.raster.threads = 2;
}

void ParetoBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* c = app.add_subcommand("pareto", "Run time against error: estimators, settings, Embree and other methods, by the traced truth");
  c->add_option("scenes", scenes, "one or more .gltf or .glb files")->required();
  c->add_option("--frames", frames, "measured for each row, in turns, after one that is not")
      ->check(CLI::Range(1, 10000))->capture_default_str();
  options.addTo(*c);
  removeEstimatorOptions(*c, options, {"--radius", "--membership", "--bias", "--filter-threshold"});
  const auto list = [&](const char* name, auto& values, const char* what, const CLI::Validator& valid) {
    c->add_option(name, values, what)->delimiter(',')->allow_extra_args(false)->check(valid)->capture_default_str()->group("Sweep");
  };
  list("--samples", sweep.samples, "n, rays per pixel", CLI::Range(1, 64));
  list("--steps", sweep.steps, "m, test points per ray", CLI::Range(1, post::kMaxSteps));
  list("--rays-embree", sweep.rays, "rays a pixel of Embree's rows", CLI::Range(1, 1024));
  list("--estimator", sweep.estimators, "where the rays come from", CLI::IsMember(namesOf(kEstimatorNames)));
  list("--peer", sweep.peers, "methods of other people: peer_methods.h", CLI::IsMember(namesOf(kPeerMethodNames)));
  list("--peer-steps", sweep.peerSteps, "steps of hbao and gtao in each of their n directions", CLI::Range(1, 16));
  list("--interleave", sweep.interleave, "other rays in each pixel of the pattern", CLI::IsMember({"on", "off"}));
  list("--layers", sweep.layers, "of depth that occlude; what the second costs to draw is in no row", CLI::Range(1, 2));
  list("--silhouette-bound", sweep.silhouetteBound, "whether what lies R or more before a test point lets it through", CLI::IsMember({"on", "off"}));
  std::vector<std::string> filters = namesOf(kFilterGuideNames);
  filters.insert(filters.begin(), "off");
  list("--filter", sweep.filters, "none, or a box guided by these", CLI::IsMember(filters));
  list("--quantity", sweep.quantities, "obscurance, what each peer aims at itself, or the transfer by whose albedo", CLI::IsMember(namesOf(kParetoQuantityNames)));
  truth.addTo(*c);
  const char* output = "Output";
  c->add_flag("--json", json, "one JSON object instead of tables")->group(output);
  c->add_option("--csv", csv, "all rows to this file")->type_name("FILE")->group(output);
  c->add_option("--plot", plot, "RMSE over time, by gnuplot: .svg, .png, or .gp for its script")
      ->check(wrongPlotFile)->type_name("FILE")->group(output);
  c->add_option("--map", map,
                kMapHelp)
      ->expected(2)->type_name("ROW FILE")->group(output);
  c->add_flag("--quiet", quiet, "no progress bar")->group(output);
  c->callback([this, &status] { status = guarded([this] { return run(); }); });
}

engine::Result<ParetoScene> ParetoBenchmark::measure(const std::string& file, Progress& progress) const {
  progress.step("loading");
  engine::LoadOptions load;
  load.scene = options.scene;
  const auto scene = engine::sceneFromGltf(file, load);
  if (!scene) return scene.error();
  auto resolved = options.resolve(*scene);
  if (!resolved) return resolved.error();

  ParetoScene out;
  out.file = file;
  out.frames = frames;
  out.rays = truth.rays;
  out.radius = resolved->frame.transfer.radius;
  const raster::Target target = raster::chooseTarget(resolved->raster.target);
  out.target = raster::targetName(target);
  out.threads = resolved->raster.threads > 0 ? std::to_string(resolved->raster.threads) : "one per core";
  out.rows = rowsOf(sweep, resolved->frame.transfer);

  engine::FrameSettings settings = resolved->frame;
  settings.aovs = truthAovs();
  Bench rayBench(resolved->raster);
  if (const auto done = rayBench.renderer.render(*scene, settings, rayBench.frame); !done) return done.error();
  const engine::Frame& frame = rayBench.frame;
  out.width = frame.width, out.height = frame.height;
  const auto visible = seenOf(frame, file);
  if (!visible) return visible.error();
  const raster::Plane<uint8_t>& seen = *visible;

  const auto found = truthOfFrame(*scene, *resolved, frame, truth, progress);
  if (!found) return found.error();
  out.truthKey = found->key;
  out.truthError[0] = rmsOver({&found->truth.error[size_t(resolved->frame.transfer.membership)]}, seen);
  out.truthError[1] = rmsOver({&found->truth.error[size_t(TruthQuantity::TransferG)]}, seen);

  progress.step("measuring");
  raster::Parallel parallel(resolved->raster.threads);
  std::optional<RaySurface> surface;
  std::optional<RayScene> rays;
  std::optional<Bench> benches[kParetoQuantities];
  for (int k = -1; k < frames; ++k)
    for (size_t i = 0; i < out.rows.size(); ++i) {
      ParetoRow& row = out.rows[i];
      if (row.embree() && !rays) {
        surface.emplace(*scene, settings.camera);
        rays.emplace(*surface, resolved->raster.threads);
        out.buildMs = rays->buildMs();
      }
      const bool other = row.embree() || row.peer;
      std::optional<Bench>& own = benches[size_t(row.quantity)];
      if (!own && !other) own.emplace(resolved->raster);
      Bench& bench = other ? rayBench : *own;
      if (other) runOther(rays ? &*rays : nullptr, settings, row, parallel, target, bench);
      else runRow(*scene, settings, row, bench);
      const PlaneRefs result = bench.result(row);
      const std::string digest = digestOfPlanes(result);
      if (!row.digest.empty() && digest != row.digest)
        throw Differs("row " + std::to_string(i + 1) + ", frame " + std::to_string(k) + ": " + digest + ", not " + row.digest);
      row.digest = digest;
      progress.at((k + 1 + double(i) / double(out.rows.size())) / (frames + 1));
      if (k >= 0) {
        row.transferMs.push_back(bench.frame.timings.transfer);
        row.filterMs.push_back(bench.frame.timings.filter);
        continue;
      }
      const ErrorMeter meter(truthPlanesOf(row, found->truth), seen, parallel);
      row.error = meter.measure(result);
      if (map.size() == 2 && file == scenes[0] && std::to_string(i + 1) == map[0]) {
        if (const auto done = writeErrorMap(map[1], meter.map(result, kMapScale)); !done) return done.error();
      }
    }
  markFront(out.rows);
  return out;
}

int ParetoBenchmark::run() {
  endCleanlyOnSignals();
  if (map.size() == 2)
    if (const auto row = mapRow(map[0], rowsOf(sweep, {}).size()); !row) return fail(row.error());
  Progress progress(3 * int(scenes.size()), quiet);
  std::vector<ParetoScene> all;
  for (const std::string& file : scenes) {
    engine::Result<ParetoScene> scene = measure(file, progress);
    if (!scene) return fail(scene.error());
    all.push_back(std::move(*scene));
  }
  progress.finish();
  const auto done = writeScenes(all, csv, plot, json, writeParetoPlot);
  return done ? 0 : fail(done.error());
}

}  // namespace obscura::apps
