// obscura-bench pareto: run time against error, of all estimators and settings and of Embree, by the traced truth.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/frame_options.h"
#include "obscura/apps/pareto_report.h"
#include "obscura/apps/scene_truth.h"

namespace obscura::apps {

struct ParetoBenchmark {
  std::vector<std::string> scenes, map;
  ParetoSweep sweep;
  int frames = 7;
  bool json = false, quiet = false;
  std::string csv, plot;
  FrameOptions options;
  TruthOptions truth;

  ParetoBenchmark();
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  int run();
  engine::Result<ParetoScene> measure(const std::string& file, Progress& progress) const;
};

}  // namespace obscura::apps
