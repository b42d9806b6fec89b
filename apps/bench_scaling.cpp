#include "obscura/apps/bench_scaling.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_scenes.h"
#include "obscura/apps/error_output.h"
#include "obscura/apps/gnuplot.h"
#include "obscura/apps/option_text.h"
#include "obscura/engine/image_file.h"
#include "obscura/raster/view.h"

namespace obscura::apps {
namespace {

constexpr double kMostUnique = 1e7;        // triangles that are really there
constexpr uint64_t kFixedScene = 1000000;  // triangles of the sweeps over pixels and threads, at most
constexpr unsigned kMostSeconds = 60;      // a cell's process

raster::PlaneSet depthNormalAlbedo() {
  raster::PlaneSet planes;
  planes.depth = planes.normal = planes.albedo = true;
  return planes;
}

// Generous: planes and their hash, meshes with clusters, draws, and the tiles' lists, which grow by doubling.
double estimatedMb(double unique, double submitted, double pixels) {
  return (32 * pixels + 150 * unique + 600 * submitted / kBallTriangles + 128 * std::min(submitted, 4 * pixels)) /
         (1 << 20);
}

unsigned coreCount() { return std::max(1u, std::thread::hardware_concurrency()); }

void addSize(CLI::App& app, const std::string& name, int& width, int& height, const std::string& what) {
  const auto set = [&width, &height, name](const std::string& text) {
    if (!readSize(text, width, height))
      throw CLI::ValidationError(name, "\"" + text + "\" is not WxH of 1 ... 16384 pixels");
  };
  app.add_option_function<std::string>(name, set, what)
      ->type_name("WxH")
      ->default_str(std::to_string(width) + "x" + std::to_string(height));
}

}  // namespace

// What a cell's process leaves behind: plain bytes.
struct ScalingBenchmark::Measured {
  FrameTimes times;
  uint64_t submitted = 0, drawn = 0;
  double sceneMb = 0, peakMb = 0;
  char digest[33] = {};
};

struct ScalingBenchmark::Cell {
  uint64_t triangles = 0;  // asked for
  bool unique = false;
  int width = 0, height = 0, threads = 0;
  std::string skipped;  // not empty: why there are no figures
  Measured m;

  double pixels() const { return double(width) * height; }
  double nsPer(double count) const { return count > 0 ? m.times.frame.median * 1e6 / count : 0; }
};

// The figures of a cell: a column of the table and a member in JSON.
struct ScalingBenchmark::Column {
  const char *head, *json;
  int width, precision;
  double (*value)(const Cell&);
};
constexpr ScalingBenchmark::Column ScalingBenchmark::kColumns[] = {
    {"drawn", "drawn", 10, 0, [](const Cell& c) { return double(c.m.drawn); }},
    {"frame ms", "frame_ms", 9, 3, [](const Cell& c) { return c.m.times.frame.median; }},
    {"p10", "frame_ms_p10", 9, 3, [](const Cell& c) { return c.m.times.frame.p10; }},
    {"p90", "frame_ms_p90", 9, 3, [](const Cell& c) { return c.m.times.frame.p90; }},
    {"setup ms", "setup_ms", 9, 3, [](const Cell& c) { return c.m.times.setup.median; }},
    {"tiles ms", "tiles_ms", 9, 3, [](const Cell& c) { return c.m.times.tiles.median; }},
    {"ns/subm", "ns_per_submitted", 8, 2, [](const Cell& c) { return c.nsPer(double(c.m.submitted)); }},
    {"ns/drawn", "ns_per_drawn", 8, 1, [](const Cell& c) { return c.nsPer(double(c.m.drawn)); }},
    {"ns/px", "ns_per_pixel", 7, 2, [](const Cell& c) { return c.nsPer(c.pixels()); }},
    {"scene MB", "scene_mb", 8, 1, [](const Cell& c) { return c.m.sceneMb; }},
    {"peak MB", "peak_mb", 8, 1, [](const Cell& c) { return c.m.peakMb; }},
};

struct ScalingBenchmark::Sweep {
  const char* name;
  std::vector<Cell> cells;
};

void ScalingBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "scaling", "How the cost of a G-buffer (depth, normal, albedo) grows with triangles, pixels and threads");
  command->add_option("--most-triangles", mostTriangles, "of the sweep from 1000 upwards; beyond 200,000 by instances")
      ->check(CLI::Range(1e3, 1e9))
      ->capture_default_str();
  addSize(*command, "--most-pixels", mostWidth, mostHeight, "of the sweep from 160x120 upwards");
  addSize(*command, "--size", width, height, "of the sweeps over triangles and threads");
  command->add_option("--threads", threads, "of the sweeps over triangles and pixels; 0: one per core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("--seconds", seconds, "measured for each cell, at least three frames")
      ->check(CLI::Range(0.001, 60.0))
      ->capture_default_str();
  command->add_option("--plot", plot, "all of it, by gnuplot: .svg, .png, or .gp for its script")
      ->check(wrongPlotFile)->type_name("FILE");
  command->add_flag("--json", json, "one JSON object instead of tables");
  command->callback([this, &status] { status = guarded([this] { return run(); }); });
}

std::vector<ScalingBenchmark::Sweep> ScalingBenchmark::plan() const {
  const int t = threads > 0 ? threads : int(coreCount());
  const uint64_t fixed = std::min(kFixedScene, uint64_t(mostTriangles));
  Sweep triangles{"triangles", {}}, pixels{"pixels", {}}, cores{"threads", {}};
  std::vector<double> counts;
  for (double n = 1e3; n < mostTriangles; n *= 10) counts.push_back(n);
  counts.push_back(mostTriangles);
  for (const bool unique : {false, true})
    for (const double n : counts)
      if (!unique || (n > kBallTriangles && n <= kMostUnique))
        triangles.cells.push_back({uint64_t(n), unique, width, height, t, {}, {}});
  for (int w = 160, h = 120; w < mostWidth && h < mostHeight; w *= 2, h *= 2)
    pixels.cells.push_back({fixed, false, w, h, t, {}, {}});
  pixels.cells.push_back({fixed, false, mostWidth, mostHeight, t, {}, {}});
  for (int k = 1; k <= int(coreCount()); ++k) cores.cells.push_back({fixed, false, width, height, k, {}, {}});
  return {triangles, pixels, cores};
}

// Fills in the figures, in a process of its own; throws Differs.
void ScalingBenchmark::measure(Cell& cell) {
  const double unique = cell.unique ? double(cell.triangles) : std::min(double(cell.triangles), double(kBallTriangles));
  const double needed = estimatedMb(unique, double(cell.triangles), cell.pixels()), there = availableMemoryMb();
  if (needed > 0.85 * there) {
    cell.skipped = "needs " + std::to_string(int(needed)) + " MB of " + std::to_string(int(there));
    return;
  }
  const auto body = [&] {
    const double before = processMemory().residentMb;
    const BenchScene scene = makeField(cell.triangles, cell.unique, double(cell.width) / cell.height);
    cell.m.sceneMb = processMemory().residentMb - before;
    raster::Settings settings;
    settings.threads = cell.threads;
    raster::Rasterizer rasterizer(settings);
    raster::GBuffer g;
    FrameBudget budget;
    budget.warmUp = 1;
    budget.mostSeconds = seconds;
    const FrameCost cost =
        measureFrames(rasterizer, scene.list(), scene.camera, cell.width, cell.height, depthNormalAlbedo(), budget, g);
    cell.m.times = cost.times;
    cell.m.submitted = cost.statistics.triangles;
    cell.m.drawn = cost.statistics.drawn;
    cell.m.peakMb = processMemory().peakMb;
    std::memcpy(cell.m.digest, cost.digest.c_str(), sizeof cell.m.digest);
    return 0;
  };
  const ChildEnd end = runInChild([&] { return guarded(body); }, &cell.m, sizeof cell.m, kMostSeconds);
  if (end.timedOut) {
    cell.skipped = "took more than " + std::to_string(kMostSeconds) + " s";
    return;
  }
  if (end.exitCode == 1) throw Differs("the frames of a scene differ");
  if (end.exitCode != 0) throw std::runtime_error("a measurement ended with code " + std::to_string(end.exitCode));
  const auto [known, fresh] = digests_.try_emplace({cell.triangles, cell.width, cell.height}, cell.m.digest);
  if (!fresh && known->second != cell.m.digest)
    throw Differs("the same scene by other threads or by copies instead of instances: " + known->second + ", " +
                  cell.m.digest);
}

void ScalingBenchmark::printHead(const Sweep& sweep) const {
  std::printf("%s\n%9s %-9s %11s %3s", sweep.name, "triangles", "", "size", "thr");
  for (const Column& column : kColumns) std::printf(" %*s", column.width, column.head);
  std::printf("\n");
}

void ScalingBenchmark::print(const Cell& c) const {
  const bool done = c.skipped.empty();
  const std::string size = std::to_string(c.width) + "x" + std::to_string(c.height);
  const char* kind = c.triangles <= kBallTriangles ? "one mesh" : c.unique ? "copies" : "instances";
  std::printf("%9llu %-9s %11s %3d", static_cast<unsigned long long>(done ? c.m.submitted : c.triangles), kind,
              size.c_str(), c.threads);
  if (!done) std::printf(" skipped: %s", c.skipped.c_str());
  for (const Column& column : kColumns)
    if (done) std::printf(" %*.*f", column.width, column.precision, column.value(c));
  std::printf("\n");
  std::fflush(stdout);
}

void ScalingBenchmark::printJson(const std::vector<Sweep>& sweeps) const {
  nlohmann::ordered_json out;
  out["renderer"] = "obscura";
  out["target"] = raster::targetName(raster::chooseTarget(raster::Target::Auto));
  out["cores"] = coreCount();
  out["planes"] = {"depth", "normal", "albedo"};
  for (const Sweep& sweep : sweeps)
    for (const Cell& c : sweep.cells) {
      nlohmann::ordered_json cell;
      cell["triangles"] = c.skipped.empty() ? c.m.submitted : c.triangles;
      cell["unique"] = c.unique;
      cell["size"] = {c.width, c.height};
      cell["threads"] = c.threads;
      if (c.skipped.empty()) {
        for (const Column& column : kColumns) cell[column.json] = column.value(c);
        cell["frames"] = c.m.times.frames;
        cell["digest"] = c.m.digest;
      } else {
        cell["skipped"] = c.skipped;
      }
      out[sweep.name].push_back(cell);
    }
  std::printf("%s\n", out.dump().c_str());
}

namespace {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

struct Panel {
  std::string title, x, y;
  std::vector<Curve> curves;
};

// Both axes logarithmic.
std::string scriptOf(const std::string& terminal, const std::vector<Panel>& panels) {
  std::string script = "set terminal " + terminal + " size 1000,700 background rgb \"white\"\nset logscale xy\nset format x \"%.0s%c\"\n"
                       "set grid lc rgb \"#dddddd\"\nset key left top\nset rmargin 4\nset multiplot layout 2,2\n";
  for (size_t p = 0; p < panels.size(); ++p) {
    std::string plots;
    double least[2] = {1e300, 1e300}, most[2] = {0, 0};
    for (size_t c = 0; c < panels[p].curves.size(); ++c) {
      const Curve& curve = panels[p].curves[c];
      if (curve.points.empty()) continue;
      const std::string block = "$panel" + std::to_string(p) + "curve" + std::to_string(c);
      script += block + " << EOD\n";
      for (const auto& [x, y] : curve.points) {
        script += formatted("%.6g %.6g\n", x, y);
        least[0] = std::min(least[0], x), most[0] = std::max(most[0], x);
        least[1] = std::min(least[1], y), most[1] = std::max(most[1], y);
      }
      script += "EOD\n";
      plots += (plots.empty() ? "plot " : ", ") + block + " with linespoints title " + gnuplotText(curve.name);
    }
    if (plots.empty()) continue;  // nothing fitted into memory
    script += gnuplotLogAxis("x", least[0], most[0]) + gnuplotLogAxis("y", least[1], most[1]);
    script += "set title " + gnuplotText(panels[p].title) + "\nset xlabel " + gnuplotText(panels[p].x) + "\nset ylabel " +
              gnuplotText(panels[p].y) + "\n" + plots + "\n";
  }
  return script + "unset multiplot\n";
}

}  // namespace

int ScalingBenchmark::writePlot(const std::vector<Sweep>& sweeps) const {
  using Figure = double (*)(const Cell&);
  const auto series = [&](const char* name, size_t sweep, bool unique, Figure x, Figure y) {
    Curve s{name, {}};
    for (const Cell& c : sweeps[sweep].cells)
      if (c.skipped.empty() && c.unique == unique) s.points.emplace_back(x(c), y(c));
    return s;
  };
  const Figure triangles = [](const Cell& c) { return double(c.m.submitted); };
  const Figure pixels = [](const Cell& c) { return c.pixels(); };
  const Figure threadCount = [](const Cell& c) { return double(c.threads); };
  const Figure frame = [](const Cell& c) { return c.m.times.frame.median; };
  const Figure setup = [](const Cell& c) { return c.m.times.setup.median; };
  const Figure tiles = [](const Cell& c) { return c.m.times.tiles.median; };
  const Figure peak = [](const Cell& c) { return c.m.peakMb; };
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::vector<Panel> panels = {
      {"Time by triangles, " + size,
       "triangles",
       "ms",
       {series("frame, instances", 0, false, triangles, frame), series("frame, copies", 0, true, triangles, frame),
        series("setup", 0, false, triangles, setup), series("tiles", 0, false, triangles, tiles)}},
      {"Memory by triangles, " + size,
       "triangles",
       "peak MB",
       {series("instances", 0, false, triangles, peak), series("copies", 0, true, triangles, peak)}},
      {"Time by pixels",
       "pixels",
       "ms",
       {series("frame", 1, false, pixels, frame), series("setup", 1, false, pixels, setup),
        series("tiles", 1, false, pixels, tiles)}},
      {"Time by threads, " + size, "threads", "ms", {series("frame", 2, false, threadCount, frame)}}};
  Curve ideal{"in proportion", {}};
  const auto& measured = panels[3].curves[0].points;
  for (const auto& [x, y] : measured) ideal.points.emplace_back(x, measured[0].second * measured[0].first / x);
  panels[3].curves.push_back(ideal);
  const auto written = writeGnuplot(plot, [&](const std::string& terminal) { return scriptOf(terminal, panels); });
  return written ? 0 : fail(written.error());
}

int ScalingBenchmark::run() {
  std::vector<Sweep> sweeps = plan();
  for (Sweep& sweep : sweeps) {
    if (!json) printHead(sweep);
    for (Cell& cell : sweep.cells) {
      measure(cell);
      if (!json) print(cell);
    }
    if (!json) std::printf("\n");
  }
  if (json) printJson(sweeps);
  return plot.empty() ? 0 : writePlot(sweeps);
}

}  // namespace obscura::apps
