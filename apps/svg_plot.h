// In: measured points.  Out: a picture of them, as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace obscura::apps {

struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  // x, y; those that the axes cannot show are left out
  bool dashed = false;
};

struct PlotPanel {
  std::string title, xLabel, yLabel;
  std::vector<PlotSeries> series;
  bool logarithmic = true;  // both axes, for finite numbers above 0; else from 0 on, for finite ones from 0 to 100
};

// One panel beside another, `columns` in a row.
std::string svgOf(const std::string& title, const std::vector<PlotPanel>& panels, int columns);

}  // namespace obscura::apps
