// In:  measured rows.
// Out: a table, CSV, JSON, a plot.
#pragma once

#include <string>
#include <vector>

#include "obscura/apps/pareto_rows.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

struct ParetoScene {
  std::string file;
  int width = 0, height = 0, frames = 0, rays = 0;
  std::string target, threads, truthKey;
  double radius = 0;
  double truthError[2] = {};  // standard error of the truth, rms: of O, of W
  double buildMs = 0;         // of Embree's tree, which no row holds
  std::vector<ParetoRow> rows;
};

std::string tableOf(const ParetoScene& scene);
std::string csvOf(const std::vector<ParetoScene>& scenes);
std::string jsonOf(const std::vector<ParetoScene>& scenes);

// By gnuplot: RMSE over milliseconds, both logarithmic, a panel for each truth of each scene, a series for each method
// and filter, the front drawn through. The ending of `path` decides: .svg, .png, or .gp for gnuplot's script itself.
// CannotWrite: also where gnuplot is not there.
engine::Result<engine::Done> writeParetoPlot(const std::string& path, const std::vector<ParetoScene>& scenes);

}  // namespace obscura::apps
