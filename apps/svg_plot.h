// In: measured points.  Out: a picture of them, as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace obscura::apps {

struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  // x, y; those that are not positive and finite are left out
  bool dashed = false;
};

// Both axes are logarithmic.
struct PlotPanel {
  std::string title, xLabel, yLabel;
  std::vector<PlotSeries> series;
};

// One panel beside another, `columns` in a row.
std::string svgOf(const std::string& title, const std::vector<PlotPanel>& panels, int columns);

}  // namespace obscura::apps
