// obscura-bench truth: what the estimators aim at, by tracing rays from the pixels of the same G-buffer.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/frame_options.h"
#include "obscura/apps/scene_truth.h"

namespace obscura::apps {

struct TruthBenchmark {
  std::string scene;
  std::vector<std::string> outputs, planes = {"all"};
  bool json = false, quiet = false;
  FrameOptions options;
  TruthOptions truth;

  TruthBenchmark();
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  int run();
  void print(const ResolvedFrame& resolved, const engine::Frame& frame, const SceneTruth& found) const;
};

}  // namespace obscura::apps
