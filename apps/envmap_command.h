// obscura envmap: an environment map in; the same in another projection out, and what a round trip loses.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "obscura/engine/environment_projection.h"

namespace obscura::apps {

class EnvmapCommand {
 public:
  void addTo(CLI::App& program);  // the subcommand and its options
  int run();                      // after parsing; returns the exit code

 private:
  std::string input_, output_, size_;
  std::string from_ = "latlong", to_;
};

}  // namespace obscura::apps
