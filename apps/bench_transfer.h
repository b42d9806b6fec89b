// obscura-bench transfer: what the ambient transfer and its filter cost, by samples and with or without interleaving,
// as figure 5 of the long paper tabulates.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/frame_options.h"

namespace obscura::apps {

struct TransferBenchmark {
  std::string scene;  // empty: the benchmark's own open ground
  std::vector<int> samples = {1, 4, 8, 16};
  int frames = 20;
  bool json = false;
  FrameOptions options;

  TransferBenchmark();
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  struct Cell;

  int run();
  void print(const std::vector<Cell>& cells) const;
  void printJson(const std::vector<Cell>& cells) const;
};

}  // namespace obscura::apps
