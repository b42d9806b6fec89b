#include <nlohmann/json.hpp>

#include "obscura/apps/bench_measure.h"
#include "obscura/apps/error_output.h"
#include "obscura/apps/pareto_report.h"

namespace obscura::apps {
std::string tableOf(const ParetoScene& s) {
  std::string out = s.file + formatted(", %dx%d, R = %g, %s, threads: %s; medians of %d frames\n", s.width, s.height, s.radius,
                                       s.target.c_str(), s.threads.c_str(), s.frames);
  out += formatted("truth: %d rays a pixel, standard error %.5f of O, %.5f of W; Embree's tree, in no row: %.1f ms\n\n", s.rays,
                   s.truthError[0], s.truthError[1], s.buildMs);
  out += formatted("%4s %-7s %-11s %3s %5s %6s %-5s %-5s %-6s %-14s %8s %8s %8s %8s %8s %8s %8s %8s\n", "row", "method", "quantity", "n",
                   "steps", "layers", "bound", "inter", "filter", "truth", "transfer", "filter", "ms", "rmse", "bias", "p95", "max", "ssim");
  for (size_t k = 0; k < s.rows.size(); ++k) {
    const ParetoRow& r = s.rows[k];
    out += formatted("%4zu %-7s %-11s %3d %5d %6d %-5s %-5s %-6s %-14s %8.3f %8.3f %8.3f %8.5f %+8.5f %8.5f %8.5f %8.5f%s\n", k + 1,
                     r.method.c_str(), nameOf(kParetoQuantityNames, r.quantity).c_str(), r.settings.samples, r.steps(),
                     r.settings.layers, r.settings.silhouetteBound ? "on" : "off", r.settings.interleave ? "on" : "off",
                     r.filter().c_str(), r.truth().c_str(), quantile(r.transferMs, 0.5), quantile(r.filterMs, 0.5), r.ms(), r.error.rmse, r.error.bias, r.error.p95, r.error.max, r.error.ssim,
                     r.front ? " *" : "");
  }
  return out + "* on the Pareto front of its truth: no row is both faster and nearer\n";
}

std::string csvOf(const std::vector<ParetoScene>& scenes) {
  std::string out =
      "scene,row,method,quantity,samples,steps,layers,silhouette_bound,interleave,filter,truth,transfer_ms,filter_ms,ms,rmse,bias,p95,max,ssim,front,digest\n";
  for (const ParetoScene& s : scenes)
    for (size_t k = 0; k < s.rows.size(); ++k) {
      const ParetoRow& r = s.rows[k];
      out += quoted(s.file) + formatted(",%zu,%s,%s,%d,%d,%d,%s,%s,%s,%s,%.4f,%.4f,%.4f,%.6f,%.6f,%.6f,%.6f,%.6f,%d,%s\n", k + 1,
                                        r.method.c_str(), nameOf(kParetoQuantityNames, r.quantity).c_str(), r.settings.samples,
                                        r.steps(), r.settings.layers, r.settings.silhouetteBound ? "on" : "off",
                                        r.settings.interleave ? "on" : "off", r.filter().c_str(),
                                        r.truth().c_str(), quantile(r.transferMs, 0.5), quantile(r.filterMs, 0.5), r.ms(),
                                        r.error.rmse, r.error.bias, r.error.p95, r.error.max, r.error.ssim, int(r.front),
                                        r.digest.c_str());
    }
  return out;
}

std::string jsonOf(const std::vector<ParetoScene>& scenes) {
  nlohmann::ordered_json out;
  out["renderer"] = "obscura";
  for (const ParetoScene& s : scenes) {
    nlohmann::ordered_json scene;
    scene["scene"] = s.file;
    scene["size"] = {s.width, s.height};
    scene["radius"] = s.radius;
    scene["target"] = s.target;
    scene["threads"] = s.threads;
    scene["frames"] = s.frames;
    scene["truth_rays"] = s.rays;
    scene["truth_key"] = s.truthKey;
    scene["truth_standard_error"] = {{"O", s.truthError[0]}, {"W", s.truthError[1]}};
    scene["embree_build_ms"] = s.buildMs;
    for (size_t k = 0; k < s.rows.size(); ++k) {
      const ParetoRow& r = s.rows[k];
      scene["rows"].push_back({{"row", k + 1},
                               {"method", r.method},
                               {"quantity", nameOf(kParetoQuantityNames, r.quantity)},
                               {"samples", r.settings.samples},
                               {"steps", r.steps()},
                               {"layers", r.settings.layers},
                               {"silhouette_bound", r.settings.silhouetteBound},
                               {"interleave", r.settings.interleave},
                               {"filter", r.filter()},
                               {"truth", r.truth()},
                               {"transfer_ms", quantile(r.transferMs, 0.5)},
                               {"filter_ms", quantile(r.filterMs, 0.5)},
                               {"ms", r.ms()},
                               {"rmse", r.error.rmse},
                               {"bias", r.error.bias},
                               {"p95", r.error.p95},
                               {"max", r.error.max},
                               {"ssim", r.error.ssim},
                               {"front", r.front},
                               {"digest", r.digest}});
    }
    out["scenes"].push_back(scene);
  }
  return out.dump() + "\n";
}

}  // namespace obscura::apps
