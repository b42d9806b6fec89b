// obscura-bench raster: triangles a second, by their size and by instruction set.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/bench_measure.h"
#include "obscura/raster/target.h"

namespace obscura::apps {

struct RasterBenchmark {
  int width = 1920, height = 1080, threads = 1;
  std::vector<int> cells = {1, 2, 3, 4, 8, 16, 64};  // pixels
  std::string target = "all", projection = "perspective";
  FrameBudget budget;
  bool json = false;

  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  struct Row;
  Row measure(int cell, const std::vector<raster::Target>& targets) const;
  void print(const std::vector<raster::Target>& targets, const std::vector<Row>& rows) const;
  void printJson(const std::vector<raster::Target>& targets, const std::vector<Row>& rows) const;
  int run() const;
};

}  // namespace obscura::apps
