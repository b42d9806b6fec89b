// obscura figures: every figure of the papers, as pictures, numbers and one page.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/figure.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

class FiguresCommand {
 public:
  void addTo(CLI::App& program);  // the subcommand and its options
  int run();                      // after parsing; returns the exit code

 private:
  int make();
  engine::Result<std::vector<const Figure*>> chosen() const;
  engine::Result<engine::Done> prepareFolder();

  std::string folder_, size_;
  std::vector<std::string> only_;
  FigureSettings settings_;
  bool list_ = false, quiet_ = false;
};

}  // namespace obscura::apps
