// obscura-bench error: where an estimator's error comes from, by giving up one exact ingredient after another.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/error_sources.h"
#include "obscura/apps/scene_truth.h"

namespace obscura::apps {

struct ErrorBenchmark {
  std::string scene, plot;
  int directions = 64;
  bool json = false, quiet = false;
  FrameOptions options;
  TruthOptions truth;

  ErrorBenchmark();
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  int run();
  void print(const ResolvedFrame& resolved, const engine::Frame& frame, const std::vector<ErrorStep>& steps) const;
  std::string plotScript(const std::string& terminal, const std::vector<ErrorStep>& steps) const;
};

}  // namespace obscura::apps
