#include <algorithm>
#include <cstdio>
#include <map>

#include "obscura/apps/gnuplot.h"
#include "obscura/apps/pareto_report.h"

namespace obscura::apps {
namespace {

using Points = std::vector<std::pair<double, double>>;

void addBlock(std::string& script, const std::string& name, const Points& points) {
  script += "$" + name + " << EOD\n";
  char line[64];
  for (const auto& [x, y] : points) {
    std::snprintf(line, sizeof line, "%.6g %.6g\n", x, std::max(y, 1e-9));
    script += line;
  }
  script += "EOD\n";
}

void addPanel(std::string& script, const ParetoScene& scene, const std::string& truth, int number) {
  std::map<std::string, Points> series;
  Points front;
  for (const ParetoRow& r : scene.rows) {
    if (r.truth() != truth) continue;
    std::string name = r.method;
    if (r.transfer()) name += " " + nameOf(kParetoQuantityNames, r.quantity);
    if (r.steps() > 1) name += ", m = " + std::to_string(r.steps());
    if (r.settings.layers > 1) name += ", " + std::to_string(r.settings.layers) + " layers";
    if (!r.settings.silhouetteBound) name += ", no bound";
    if (!r.settings.interleave) name += ", not interleaved";
    series[name + ", " + (r.settings.filter ? r.filter() + " filter" : "no filter")].emplace_back(r.ms(), r.error.rmse);
    if (r.front) front.emplace_back(r.ms(), r.error.rmse);
  }
  const std::string prefix = "panel" + std::to_string(number);
  int k = 0;
  std::string plots;
  for (const auto& [name, points] : series) {
    addBlock(script, prefix + "s" + std::to_string(k), points);
    plots += (k ? ", \\\n     " : "plot ") + ("$" + prefix + "s" + std::to_string(k)) + " using 1:2 with linespoints lw 1 pt " +
             std::to_string(4 + k % 11) + " ps 0.8 title " + gnuplotText(name);
    ++k;
  }
  std::sort(front.begin(), front.end());
  addBlock(script, prefix + "front", front);
  double least[2] = {1e9, 1e9}, most[2] = {0, 0};
  for (const auto& [name, points] : series)
    for (const auto& [x, y] : points) {
      least[0] = std::min(least[0], x), most[0] = std::max(most[0], x);
      least[1] = std::min(least[1], y), most[1] = std::max(most[1], y);
    }
  script += gnuplotLogAxis("x", least[0], most[0]) + gnuplotLogAxis("y", least[1], most[1]);
  const std::string base = scene.file.substr(scene.file.find_last_of('/') + 1);
  script += "set title " + gnuplotText(base + ": " + truth + " by ray tracing, " + std::to_string(scene.width) + "x" + std::to_string(scene.height)) +
            " noenhanced\n" + plots + ", \\\n     $" + prefix + "front using 1:2 with lines lw 5 lc rgb \"#60000000\" title \"Pareto front\"\n";
}

std::string scriptOf(const std::string& terminal, const std::vector<ParetoScene>& scenes) {
  std::vector<std::pair<const ParetoScene*, std::string>> panels;
  for (const ParetoScene& s : scenes)
    for (const ParetoRow& r : s.rows)
      if (std::find(panels.begin(), panels.end(), std::pair{&s, r.truth()}) == panels.end()) panels.emplace_back(&s, r.truth());
  const size_t columns = std::min<size_t>(2, panels.size()), rows = (panels.size() + columns - 1) / columns;
  std::string script = "set terminal " + terminal + " size " + std::to_string(900 * columns) + "," + std::to_string(640 * rows) +
                       " background rgb \"white\"\nset logscale xy\nset grid xtics ytics mxtics mytics lc rgb \"#dddddd\"\n"
                       "set xlabel \"transfer + filter, ms\"\nset ylabel \"RMSE\"\nset key outside right top noenhanced font \",9\"\n"
                       "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + "\n";
  int number = 0;
  for (const auto& [scene, truth] : panels) addPanel(script, *scene, truth, number++);
  return script + "unset multiplot\n";
}

}  // namespace

engine::Result<engine::Done> writeParetoPlot(const std::string& path, const std::vector<ParetoScene>& scenes) {
  return writeGnuplot(path, [&](const std::string& terminal) { return scriptOf(terminal, scenes); });
}

}  // namespace obscura::apps
