#include "obscura/apps/bench_raster.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_scenes.h"

namespace obscura::apps {
namespace {

// The twins look at every pixel of every triangle's box, one by one: images up to this many pixels are checked by them.
constexpr int kReferencePixels = 256 * 256;

raster::PlaneSet depthAndTriangle() {
  raster::PlaneSet planes;
  planes.depth = planes.triangle = true;
  return planes;
}

Differs wrong(int cell, const std::string& what) {
  return Differs("cells of " + std::to_string(cell) + " pixels: " + what);
}

int uncovered(const raster::GBuffer& g) {
  int count = 0;
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) count += g.triangle.at(x, y) == raster::kNoTriangle;
  return count;
}

}  // namespace

// One size of triangles; costs in the order of the targets.
struct RasterBenchmark::Row {
  int cell = 0;
  uint64_t triangles = 0;
  std::string digest;
  bool reference = false;  // the digest is the twins', too
  std::vector<FrameCost> costs;

  double millionsPerSecond(size_t k) const { return double(triangles) / costs[k].times.frame.median * 1e-3; }
  double nsPerTriangle(size_t k) const { return costs[k].times.frame.median * 1e6 / double(triangles); }
};

void RasterBenchmark::addTo(CLI::App& app, int& status) {
  std::vector<std::string> names = {"all"};
  for (const raster::Target t : raster::supportedTargets()) names.push_back(raster::targetName(t));
  CLI::App* command = app.add_subcommand(
      "raster", "Triangles a second: jittered grids that cover every pixel once, depth and triangle only");
  command->add_option("--width", width, "of the image, pixels")
      ->check(CLI::Range(1, kMostGridSize))
      ->capture_default_str();
  command->add_option("--height", height, "of the image, pixels")
      ->check(CLI::Range(1, kMostGridSize))
      ->capture_default_str();
  command->add_option("--cell", cells, "sizes of the grid's cells of two triangles, pixels")
      ->delimiter(',')
      ->check(CLI::Range(1, kMostGridSize))
      ->capture_default_str();
  command->add_option("--projection", projection, "of the camera")
      ->check(CLI::IsMember({"perspective", "orthographic"}))
      ->capture_default_str();
  command->add_option("--threads", threads, "0: one per core")->check(CLI::Range(0, 1024))->capture_default_str();
  command->add_option("--target", target, "instruction set")->check(CLI::IsMember(names))->capture_default_str();
  command
      ->add_option("--frames", budget.mostFrames,
                   "measured for each figure, after two that are not; fewer, but three, if they take more than 1.5 s")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_flag("--json", json, "one JSON object instead of tables");
  command->callback([this, &status] { status = guarded([this] { return run(); }); });
}

RasterBenchmark::Row RasterBenchmark::measure(int cell, const std::vector<raster::Target>& targets) const {
  const raster::PlaneSet planes = depthAndTriangle();
  const BenchScene scene =
      makeGrid(width, height, cell,
               projection == "perspective" ? raster::Projection::Perspective : raster::Projection::Orthographic);
  Row row;
  row.cell = cell;
  row.triangles = scene.triangles;

  raster::GBuffer g;
  raster::Settings settings;
  settings.threads = threads;
  settings.target = raster::Target::Scalar;
  raster::Rasterizer(settings).render(scene.list(), scene.camera, width, height, planes, g);
  if (const int holes = uncovered(g)) throw wrong(cell, std::to_string(holes) + " pixels are not covered");
  row.digest = digestOf(g, planes);
  if (width * height <= kReferencePixels) {
    raster::GBuffer twin;
    raster::renderReference(scene.list(), scene.camera, width, height, planes, twin);
    if (digestOf(twin, planes) != row.digest) throw wrong(cell, "the scalar target differs from the reference");
    row.reference = true;
  }

  for (const raster::Target t : targets) {
    settings.target = t;
    raster::Rasterizer rasterizer(settings);
    row.costs.push_back(measureFrames(rasterizer, scene.list(), scene.camera, width, height, planes, budget, g));
    if (row.costs.back().digest != row.digest)
      throw wrong(cell, std::string(raster::targetName(t)) + " differs from the scalar target");
  }
  return row;
}

void RasterBenchmark::print(const std::vector<raster::Target>& targets, const std::vector<Row>& rows) const {
  std::printf("%dx%d, %s, threads: %s; depth and triangle; medians of up to %d frames\n\n", width, height,
              projection.c_str(), threads > 0 ? std::to_string(threads).c_str() : "one per core", budget.mostFrames);
  const auto head = [&](const char* left, const char* columns, int columnWidth) {
    std::printf("%15s", "");
    for (const raster::Target t : targets) std::printf("  %-*s", columnWidth, raster::targetName(t));
    std::printf("\n%15s", left);
    for (size_t k = 0; k < targets.size(); ++k) std::printf("  %s", columns);
    std::printf("\n");
  };
  head("cell  triangles", " Mtri/s  ns/tri   ns/px", 23);
  for (const Row& row : rows) {
    std::printf("%4d %10llu", row.cell, static_cast<unsigned long long>(row.triangles));
    for (size_t k = 0; k < targets.size(); ++k)
      std::printf("  %7.2f %7.1f %7.2f", row.millionsPerSecond(k), row.nsPerTriangle(k),
                  row.costs[k].times.frame.median * 1e6 / (double(width) * height));
    std::printf("\n");
  }
  std::printf("\nmilliseconds: the stages' medians, and p10 and p90 of the frame\n");
  head("cell", "  setup   tiles     p10     p90", 31);
  for (const Row& row : rows) {
    std::printf("%15d", row.cell);
    for (const FrameCost& c : row.costs)
      std::printf("  %7.2f %7.2f %7.2f %7.2f", c.times.setup.median, c.times.tiles.median, c.times.frame.p10,
                  c.times.frame.p90);
    std::printf("\n");
  }
  std::printf("\n");
  for (const Row& row : rows)
    std::printf("digest %4d %s%s\n", row.cell, row.digest.c_str(), row.reference ? " = reference" : "");
}

void RasterBenchmark::printJson(const std::vector<raster::Target>& targets, const std::vector<Row>& rows) const {
  nlohmann::ordered_json out;
  out["renderer"] = "obscura";
  out["size"] = {width, height};
  out["projection"] = projection;
  out["threads"] = threads;
  for (const Row& row : rows)
    for (size_t k = 0; k < targets.size(); ++k) {
      const FrameCost& c = row.costs[k];
      nlohmann::ordered_json cell;
      cell["cell"] = row.cell;
      cell["target"] = raster::targetName(targets[k]);
      cell["triangles"] = row.triangles;
      cell["drawn"] = c.statistics.drawn;
      cell["mtri_per_s"] = row.millionsPerSecond(k);
      cell["ns_per_triangle"] = row.nsPerTriangle(k);
      cell["ns_per_pixel"] = c.times.frame.median * 1e6 / (double(width) * height);
      cell["frame_ms"] = c.times.frame.median;
      cell["frame_ms_p10"] = c.times.frame.p10;
      cell["frame_ms_p90"] = c.times.frame.p90;
      cell["setup_ms"] = c.times.setup.median;
      cell["tiles_ms"] = c.times.tiles.median;
      cell["frames"] = c.times.frames;
      cell["digest"] = c.digest;
      cell["equals_reference"] = row.reference;
      out["cells"].push_back(cell);
    }
  std::printf("%s\n", out.dump().c_str());
}

int RasterBenchmark::run() const {
  const std::vector<raster::Target> targets =
      target == "all" ? raster::supportedTargets() : std::vector<raster::Target>{*raster::targetFromName(target)};
  std::vector<Row> rows;
  for (const int cell : cells) rows.push_back(measure(cell, targets));
  json ? printJson(targets, rows) : print(targets, rows);
  return 0;
}

}  // namespace obscura::apps
