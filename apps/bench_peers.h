// obscura-bench peers: the same frame by Mesa's llvmpipe, OpenGL on the processor, in the same process and in turns.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "obscura/apps/bench_frame.h"

namespace obscura::apps {

struct PeersBenchmark {
  std::string scene;
  int frames = 20;
  bool json = false;
  FrameOptions options;

  PeersBenchmark() { asPeersCompute(options); }
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then. 3 where there is
  // no llvmpipe.
  void addTo(CLI::App& app, int& status);

 private:
  int run();
};

}  // namespace obscura::apps
