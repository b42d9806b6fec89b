// obscura-bench scaling: how the cost of a G-buffer grows with triangles, pixels and threads.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/bench_measure.h"
#include "obscura/apps/bench_process.h"

namespace obscura::apps {

struct ScalingBenchmark {
  double mostTriangles = 1e8, seconds = 1;
  int mostWidth = 16384, mostHeight = 16384;  // of the sweep over pixels
  int width = 800, height = 600;              // of the others
  int threads = 0;
  std::string plot;
  bool json = false;

  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  struct Measured;
  struct Cell;
  struct Column;
  struct Sweep;
  static const Column kColumns[11];
  using Image = std::tuple<uint64_t, int, int>;  // triangles, width, height: what decides about the pixels

  std::vector<Sweep> plan() const;
  void measure(Cell& cell);
  void printHead(const Sweep& sweep) const;
  void print(const Cell& cell) const;
  void printJson(const std::vector<Sweep>& sweeps) const;
  int writePlot(const std::vector<Sweep>& sweeps) const;
  int run();

  std::map<Image, std::string> digests_;
};

}  // namespace obscura::apps
