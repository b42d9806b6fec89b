#include "obscura/apps/bench_transfer.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_frame.h"
#include "obscura/apps/bench_measure.h"
#include "obscura/apps/bench_scenes.h"
#include "obscura/engine/digest.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/plane_image.h"

namespace obscura::apps {
namespace {

constexpr int kBoxes = 2;

engine::Result<engine::Scene> sceneOf(const std::string& file, const engine::LoadOptions& load) {
  if (file.empty()) return makeGround(kBoxes);
  return engine::sceneFromGltf(file, load);
}

}  // namespace

struct TransferBenchmark::Cell {
  int samples = 0;
  bool interleave = false;
  std::string digest;  // of O and W, of every frame and of one in which nothing was skipped
  std::vector<double> transfer, filter;  // ms
  post::TransferStatistics pixels;
};

TransferBenchmark::TransferBenchmark() { asPeersCompute(options); }

void TransferBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("transfer", "Ambient transfer and depth filter by samples, interleaved or not");
  command->add_option("scene", scene, "a .gltf or .glb file [open ground with a few boxes]");
  command->add_option("--frames", frames, "measured for each line, in turns, after two that are not")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_flag("--json", json, "one JSON object instead of a table");
  options.addTo(*command);
  for (const char* swept : {"--samples", "--interleave"}) command->remove_option(command->get_option(swept));
  command->add_option("--samples", samples, "n, rays per pixel")
      ->delimiter(',')
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->callback([this, &status] { status = guarded([this] { return run(); }); });
}

int TransferBenchmark::run() {
  const auto loaded = sceneOf(scene, options.load());
  if (!loaded) return fail(loaded.error());
  auto resolved = options.resolve(*loaded);
  if (!resolved) return fail(resolved.error());
  resolved->frame.aovs = {engine::Aov::Obscurance, engine::Aov::Transfer};

  std::vector<Cell> cells;
  for (const int n : samples)
    for (const bool interleave : {false, true}) {
      cells.emplace_back();
      cells.back().samples = n;
      cells.back().interleave = interleave;
    }

  raster::Settings everything = resolved->raster;
  everything.skip = false;
  engine::Renderer renderer(resolved->raster, resolved->reference), unskipped(everything, resolved->reference);
  engine::Frame frame;
  for (int k = -kWarmUp; k < frames; ++k)
    for (Cell& cell : cells) {
      resolved->frame.transfer.samples = cell.samples;
      resolved->frame.transfer.interleave = cell.interleave;
      engine::Renderer& by = k == -kWarmUp ? unskipped : renderer;
      if (const auto done = by.render(*loaded, resolved->frame, frame); !done) return fail(done.error());
      const post::Transfer& t = frame.transfer;
      const std::string found = engine::digest(engine::interleave({&t.obscurance, &t.w[0], &t.w[1], &t.w[2]}));
      if (!cell.digest.empty() && found != cell.digest)
        throw Differs(std::to_string(cell.samples) + " samples, frame " + std::to_string(k) + ": " + found + ", not " +
                      cell.digest);
      cell.digest = found;
      if (k < 0) continue;
      cell.transfer.push_back(frame.timings.transfer);
      cell.filter.push_back(frame.timings.filter);
      cell.pixels = frame.transferStatistics;
    }
  json ? printJson(cells) : print(cells);
  return 0;
}

void TransferBenchmark::print(const std::vector<Cell>& cells) const {
  std::printf("%s, %dx%d, %s, threads: %s; medians (10th, 90th percentile) of %d frames, ms\n\n",
              scene.empty() ? "open ground" : scene.c_str(), options.width, options.height,
              raster::targetName(raster::chooseTarget(options.raster.target)),
              options.raster.threads > 0 ? std::to_string(options.raster.threads).c_str() : "one per core", frames);
  std::printf("%3s %-11s %-27s %-27s %6s %6s  %s\n", "n", "interleaved", "transfer", "filter", "empty", "open",
              "digest of O and W");
  for (const Cell& c : cells) {
    const Spread t = spreadOf(c.transfer), f = spreadOf(c.filter);
    const double percent = 100.0 / (double(options.width) * options.height);
    std::printf("%3d %-11s %8.3f (%7.3f %7.3f) %8.3f (%7.3f %7.3f) %5.1f%% %5.1f%%  %s\n", c.samples,
                c.interleave ? "yes" : "no", t.median, t.p10, t.p90, f.median, f.p10, f.p90,
                double(c.pixels.empty) * percent, double(c.pixels.open) * percent, c.digest.c_str());
  }
}

void TransferBenchmark::printJson(const std::vector<Cell>& cells) const {
  nlohmann::ordered_json out;
  out["renderer"] = "obscura";
  out["target"] = raster::targetName(raster::chooseTarget(options.raster.target));
  out["threads"] = options.raster.threads;
  out["size"] = {options.width, options.height};
  out["frames"] = frames;
  for (const Cell& c : cells) {
    nlohmann::ordered_json cell;
    cell["samples"] = c.samples;
    cell["interleave"] = c.interleave;
    const auto put = [&](const std::string& name, const std::vector<double>& times) {
      const Spread s = spreadOf(times);
      cell[name] = s.median;
      cell[name + "_p10"] = s.p10;
      cell[name + "_p90"] = s.p90;
    };
    put("transfer_ms", c.transfer);
    put("filter_ms", c.filter);
    cell["pixels_empty"] = c.pixels.empty;
    cell["pixels_open"] = c.pixels.open;
    cell["pixels_sampled"] = c.pixels.sampled;
    cell["digest"] = c.digest;
    out["cells"].push_back(cell);
  }
  std::printf("%s\n", out.dump().c_str());
}

}  // namespace obscura::apps
