// obscura-bench accuracy: errors of depth, weights, textures and normals against long double.
#pragma once

#include <CLI/CLI.hpp>

namespace obscura::apps {

struct AccuracyBenchmark {
  int scale = 1;
  bool json = false;

  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  int run() const;
};

}  // namespace obscura::apps
