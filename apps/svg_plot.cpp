#include "obscura/apps/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "obscura/apps/option_text.h"

namespace obscura::apps {
namespace {

constexpr double kPanelWidth = 460, kPanelHeight = 330, kTitleHeight = 40;
constexpr double kLeft = 64, kRight = 16, kTop = 34, kBottom = 50;  // around a panel's axes
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73",
                                   "#cc79a7"};  // Okabe and Ito: for the colour-blind, too

bool usable(const std::pair<double, double>& p, bool logarithmic) {
  const auto fits = [&](double v) { return logarithmic ? v > 0 && std::isfinite(v) : v >= 0 && v <= 100; };
  return fits(p.first) && fits(p.second);
}

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", v);
  return text;
}

// 0.001, 20, 5k, 100M: three digits at most.
std::string tickLabel(double v) {
  const char* suffix = v >= 1e9 ? "G" : v >= 1e6 ? "M" : v >= 1e3 ? "k" : "";
  char text[32];
  std::snprintf(text, sizeof text, "%g%s", v / (v >= 1e9 ? 1e9 : v >= 1e6 ? 1e6 : v >= 1e3 ? 1e3 : 1), suffix);
  return text;
}

std::string label(double x, double y, const std::string& text, const char* more) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + more + ">" + escapedXml(text) + "</text>\n";
}

// Logarithmic: ticks at powers of ten; between them at 2 and 5, too, where the range is short. Else quarters of the power of
// ten below the largest value, or that itself where there would be many.
struct Axis {
  std::vector<double> ticks;
  bool logarithmic;

  Axis(double least, double most, bool isLogarithmic) : logarithmic(isLogarithmic) {
    if (!logarithmic) {
      const double ten = std::pow(10.0, std::floor(std::log10(most))), step = most < 3 * ten ? ten / 4 : ten;
      for (int k = 0; ticks.empty() || ticks.back() < most; ++k) ticks.push_back(k * step);
      return;
    }
    const int first = int(std::floor(std::log10(least))), last = int(std::ceil(std::log10(most)));
    const bool fine = most < 100 * least;
    for (int k = first; k <= last; ++k)
      for (const double m : {1.0, 2.0, 5.0})
        if (m == 1 || fine) ticks.push_back(m * std::pow(10.0, k));
    // The nearest ticks around the range are the axis' ends; a point may lie a little outside.
    while (ticks.size() > 2 && ticks[1] <= least * 1.05) ticks.erase(ticks.begin());
    while (ticks.size() > 2 && ticks[ticks.size() - 2] >= most * 0.95) ticks.pop_back();
  }
  double at(double v) const {
    return logarithmic ? std::log(v / ticks.front()) / std::log(ticks.back() / ticks.front()) : v / ticks.back();
  }
};

std::string panelOf(const PlotPanel& panel) {
  double lo[2] = {1e300, 1e300}, hi[2] = {0, 0};
  for (const PlotSeries& s : panel.series)
    for (const auto& p : s.points) {
      if (!usable(p, panel.logarithmic)) continue;
      lo[0] = std::min(lo[0], p.first), hi[0] = std::max(hi[0], p.first);
      lo[1] = std::min(lo[1], p.second), hi[1] = std::max(hi[1], p.second);
    }
  std::string out = label(kPanelWidth / 2, 20, panel.title, "text-anchor=\"middle\" font-weight=\"bold\"");
  if (hi[0] == 0)
    return out + label(kPanelWidth / 2, kPanelHeight / 2, "nothing was measured", "text-anchor=\"middle\"");
  const Axis xAxis(lo[0], hi[0], panel.logarithmic), yAxis(lo[1], hi[1], panel.logarithmic);
  const double width = kPanelWidth - kLeft - kRight, height = kPanelHeight - kTop - kBottom;
  const auto xOf = [&](double v) { return kLeft + width * xAxis.at(v); };
  const auto yOf = [&](double v) { return kTop + height * (1 - yAxis.at(v)); };
  const auto line = [](double x0, double y0, double x1, double y1) {
    return "<path d=\"M" + number(x0) + " " + number(y0) + "L" + number(x1) + " " + number(y1) +
           "\" stroke=\"#ddd\"/>\n";
  };

  for (const double t : xAxis.ticks)
    out += line(xOf(t), kTop, xOf(t), kTop + height) +
           label(xOf(t), kTop + height + 16, tickLabel(t), "text-anchor=\"middle\"");
  for (const double t : yAxis.ticks)
    out +=
        line(kLeft, yOf(t), kLeft + width, yOf(t)) + label(kLeft - 6, yOf(t) + 4, tickLabel(t), "text-anchor=\"end\"");
  out += label(kLeft + width / 2, kPanelHeight - 14, panel.xLabel, "text-anchor=\"middle\"");
  out += "<g transform=\"translate(14 " + number(kTop + height / 2) + ") rotate(-90)\">" +
         label(0, 0, panel.yLabel, "text-anchor=\"middle\"") + "</g>\n";

  // In the upper corner that the first curve does not come near.
  const auto& curve = panel.series[0].points;
  const bool falls = !curve.empty() && curve.back().second < curve.front().second;
  const double legend = falls ? kLeft + width - 120 : kLeft + 8;
  for (size_t k = 0; k < panel.series.size(); ++k) {
    const PlotSeries& s = panel.series[k];
    const std::string color = kColors[k % std::size(kColors)];
    std::string path, dots;
    for (const auto& p : s.points) {
      if (!usable(p, panel.logarithmic)) continue;
      const std::string x = number(xOf(p.first)), y = number(yOf(p.second));
      path += (path.empty() ? "M" : "L") + x + " " + y;
      if (!s.dashed && panel.logarithmic) dots += "<circle cx=\"" + x + "\" cy=\"" + y + "\" r=\"3\" fill=\"" + color + "\"/>";
    }
    const std::string stroke =
        "fill=\"none\" stroke-width=\"2\" stroke=\"" + color + "\"" + (s.dashed ? " stroke-dasharray=\"5 4\"" : "");
    if (!path.empty()) out += "<path d=\"" + path + "\" " + stroke + "/>" + dots + "\n";
    const double y = kTop + 14 + 16 * double(k);
    out += "<path d=\"M" + number(legend) + " " + number(y - 4) + "h18\" " + stroke + "/>" +
           label(legend + 24, y, s.name, "");
  }
  return out;
}

}  // namespace

std::string svgOf(const std::string& title, const std::vector<PlotPanel>& panels, int columns) {
  const int rows = (int(panels.size()) + columns - 1) / columns;
  const std::string width = number(kPanelWidth * columns), height = number(kTitleHeight + kPanelHeight * rows);
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height + "\" viewBox=\"0 0 " +
      width + " " + height +
      "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  out += label(kPanelWidth * columns / 2, 26, title, "text-anchor=\"middle\" font-size=\"16\"");
  for (int k = 0; k < int(panels.size()); ++k)
    out += "<g transform=\"translate(" + number(kPanelWidth * (k % columns)) + " " +
           number(kTitleHeight + kPanelHeight * (k / columns)) + ")\">\n" + panelOf(panels[size_t(k)]) + "</g>\n";
  return out + "</svg>\n";
}

}  // namespace obscura::apps
