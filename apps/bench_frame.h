// obscura-bench frame: the stages of a frame, in milliseconds.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "obscura/apps/frame_options.h"

namespace obscura::apps {

// Sets what the peers compute: neighbours' albedo, linear membership, R = 0.5, bias 0.005, threshold 0.1 scene units.
void asPeersCompute(FrameOptions& options);

struct FrameBenchmark {
  std::string scene;
  int frames = 20;
  bool json = false;
  FrameOptions options;

  FrameBenchmark() { asPeersCompute(options); }
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  int run();
};

}  // namespace obscura::apps
