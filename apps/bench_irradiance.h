// obscura-bench irradiance: the diffuse light of an environment map, by nine coefficients times O or W, by the traced truth.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/frame_options.h"
#include "obscura/apps/irradiance_rows.h"

namespace obscura::apps {

struct IrradianceBenchmark {
  std::string scene, csv;
  std::vector<std::string> map;
  bool json = false, quiet = false;
  FrameOptions options;
  TruthOptions truth;

  IrradianceBenchmark();
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  int run();
  std::string headOf(const TracedFrame& traced, const SceneTruth& found) const;
};

}  // namespace obscura::apps
