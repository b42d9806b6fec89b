#include "obscura/apps/albedo_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "obscura/apps/error_output.h"
#include "obscura/apps/gnuplot.h"

namespace obscura::apps {
namespace {

const char* sourceOf(const AlbedoRow& row) { return row.traced ? "rays" : "depth map"; }

double largestOf(const AlbedoScene& s) {
  double most = 1e-6;
  for (const AlbedoRow& r : s.rows) most = std::max(most, r.error.rmse);
  return most;
}

std::string panelOf(const AlbedoScene& s, bool traced, int number) {
  const std::string block = "$panel" + std::to_string(number);
  std::string out = block + " << EOD\n";
  for (size_t a = 0; a < s.truths.size(); ++a) {
    out += gnuplotText(s.truths[a].name);
    for (const AlbedoRow& r : s.rows)
      if (r.albedo == a && r.traced == traced) out += formatted(" %.6g", r.error.rmse);
    out += "\n";
  }
  out += "EOD\nset title " + gnuplotText(s.file.substr(s.file.find_last_of('/') + 1) + (traced ? ", by albedo: O and B by rays" : ", by albedo: O and B by the depth map")) +
         " noenhanced\n" + formatted("set yrange [0:%.6g]\nplot ", 1.05 * largestOf(s));
  for (size_t m = 0; m < kTransferModelNames.size(); ++m)
    out += (m ? ", '' using " : block + " using ") + std::to_string(m + 2) + (m ? "" : ":xtic(1)") + " title " +
           gnuplotText((m ? "W, " : "") + kTransferModelNames[m].first);
  return out + "\n";
}

std::string scriptOf(const std::string& terminal, const std::vector<AlbedoScene>& scenes) {
  std::string out = "set terminal " + terminal + " size 1200," + std::to_string(360 * scenes.size()) +
                    " background rgb \"white\"\nset style data histograms\nset style fill solid 0.7\nset boxwidth 0.9\n"
                    "set grid ytics lc rgb \"#dddddd\"\nset key outside bottom center horizontal\n"
                    "set ylabel \"RMSE to the recursive W\"\nset multiplot layout " + std::to_string(scenes.size()) + ",2\n";
  int number = 0;
  for (const AlbedoScene& s : scenes)
    for (const bool traced : {true, false}) out += panelOf(s, traced, number++);
  return out + "unset multiplot\n";
}

}  // namespace

std::string tableOf(const AlbedoScene& s) {
  std::string out = s.file + formatted(", %dx%d, R = %g, %s membership; depth map: %s, n = %d, m = %d\n", s.width, s.height, double(s.settings.radius),
                                       nameOf(kMembershipNames, s.settings.membership).c_str(),
                                       nameOf(kEstimatorNames, s.settings.estimator).c_str(), s.settings.samples, s.settings.steps);
  out += formatted("truth: recursive W, %d rays a pixel; its standard error by albedo:", s.rays);
  for (const auto& t : s.truths) out += " " + t.name + formatted(" %.5f", t.error);
  out += formatted("\n\n%4s %-7s %-10s %-10s %8s %8s %8s %8s %8s\n", "row", "albedo", "O, B by", "W", "rmse", "bias", "p95", "max", "ssim");
  for (size_t k = 0; k < s.rows.size(); ++k) {
    const AlbedoRow& r = s.rows[k];
    out += formatted("%4zu %-7s %-10s %-10s %8.5f %+8.5f %8.5f %8.5f %8.5f%s\n", k + 1, s.truths[r.albedo].name.c_str(), sourceOf(r),
                     nameOf(kTransferModelNames, r.model).c_str(), r.error.rmse, r.error.bias, r.error.p95, r.error.max, r.error.ssim,
                     r.nearest ? " *" : "");
  }
  return out + "* the nearest to the recursive W, of this albedo and these O and B\n";
}

std::string csvOf(const std::vector<AlbedoScene>& scenes) {
  std::string out = "scene,row,albedo,source,w,rmse,bias,p95,max,ssim,nearest\n";
  for (const AlbedoScene& s : scenes)
    for (size_t k = 0; k < s.rows.size(); ++k) {
      const AlbedoRow& r = s.rows[k];
      out += quoted(s.file) + formatted(",%zu,%s,%s,%s,%.6f,%.6f,%.6f,%.6f,%.6f,%d\n", k + 1, s.truths[r.albedo].name.c_str(), sourceOf(r),
                                        nameOf(kTransferModelNames, r.model).c_str(), r.error.rmse, r.error.bias, r.error.p95,
                                        r.error.max, r.error.ssim, int(r.nearest));
    }
  return out;
}

std::string jsonOf(const std::vector<AlbedoScene>& scenes) {
  nlohmann::ordered_json out;
  out["renderer"] = "obscura";
  for (const AlbedoScene& s : scenes) {
    nlohmann::ordered_json scene = {{"scene", s.file}, {"size", {s.width, s.height}}, {"radius", s.settings.radius},
                                    {"membership", nameOf(kMembershipNames, s.settings.membership)},
                                    {"estimator", nameOf(kEstimatorNames, s.settings.estimator)},
                                    {"samples", s.settings.samples}, {"steps", s.settings.steps}, {"truth_rays", s.rays}};
    for (const auto& t : s.truths) scene["truths"].push_back({{"albedo", t.name}, {"key", t.key}, {"standard_error", t.error}});
    for (size_t k = 0; k < s.rows.size(); ++k) {
      const AlbedoRow& r = s.rows[k];
      scene["rows"].push_back({{"row", k + 1}, {"albedo", s.truths[r.albedo].name}, {"source", sourceOf(r)},
                               {"w", nameOf(kTransferModelNames, r.model)}, {"rmse", r.error.rmse}, {"bias", r.error.bias},
                               {"p95", r.error.p95}, {"max", r.error.max}, {"ssim", r.error.ssim}, {"nearest", r.nearest}});
    }
    out["scenes"].push_back(scene);
  }
  return out.dump() + "\n";
}

engine::Result<engine::Done> writeAlbedoPlot(const std::string& path, const std::vector<AlbedoScene>& scenes) {
  return writeGnuplot(path, [&](const std::string& terminal) { return scriptOf(terminal, scenes); });
}

}  // namespace obscura::apps
