#include "obscura/apps/bench_error.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "obscura/apps/bench_frame.h"
#include "obscura/apps/bench_measure.h"
#include "obscura/apps/gnuplot.h"
#include "obscura/apps/setting_names.h"
#include "obscura/apps/signals.h"

namespace obscura::apps {

ErrorBenchmark::ErrorBenchmark() { asPeersCompute(options); }

void ErrorBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("error", "Where the error of O comes from: one exact ingredient given up after another");
  command->add_option("scene", scene, "a .gltf or .glb file")->required();
  command->add_option("--directions", directions, "a pixel, on the way from the truth to the estimator")
      ->check(CLI::Range(1, 65536))->capture_default_str();
  command->add_option("--plot", plot, "bars of each step, by gnuplot: .svg, .png, or .gp for its script")
      ->check(wrongPlotFile)->type_name("FILE");
  command->add_flag("--json", json, "one JSON object instead of a table");
  command->add_flag("--quiet", quiet, "no progress bar");
  options.addTo(*command);
  removeEstimatorOptions(*command, options,
                         {"--radius", "--membership", "--bias", "--silhouette-bound", "--filter-threshold", "--samples", "--steps",
                          "--estimator", "--layers", "--interleave", "--filter", "--filter-guide"});
  command->remove_option(command->get_option("--crop"));  // the way goes through a whole image
  truth.addTo(*command);
  command->callback([this, &status] { status = guarded([this] { return run(); }); });
}

int ErrorBenchmark::run() {
  endCleanlyOnSignals();
  Progress progress(4, quiet);
  auto traced = renderTraced(scene, options, {engine::Aov::Obscurance}, progress);
  if (!traced) return fail(traced.error());
  auto& [loaded, resolved, frame, environment] = *traced;
  const auto found = truthOfFrame(loaded, resolved, frame, truth, progress);
  if (!found) return fail(found.error());
  progress.step("taking it apart");
  const auto steps = errorSteps(loaded, resolved, frame, found->truth.value[size_t(resolved.frame.transfer.membership)],
                                std::move(frame.transfer.obscurance), directions, [&](double part) { progress.at(part); });
  progress.finish();
  if (!plot.empty())
    if (const auto done = writeGnuplot(plot, [&](const std::string& terminal) { return plotScript(terminal, steps); }); !done)
      return fail(done.error());
  print(resolved, frame, steps);
  return 0;
}

std::string ErrorBenchmark::plotScript(const std::string& terminal, const std::vector<ErrorStep>& steps) const {
  std::string script = "set terminal " + terminal + " size 900,420 background rgb \"white\"\n$steps << EOD\n";
  for (const ErrorStep& s : steps) script += gnuplotText(s.name) + " " + std::to_string(s.change) + " " + std::to_string(s.error.rmse) + "\n";
  script += "EOD\nset style data histograms\nset style fill solid 0.7\nset boxwidth 0.9\nset grid ytics lc rgb \"#dddddd\"\n"
            "set yrange [0:*]\nset key top left\nset ylabel \"O\"\nset title " +
            gnuplotText(scene.substr(scene.find_last_of('/') + 1) + ": where the error of O comes from") + " noenhanced\n";
  return script + "plot $steps using 2:xtic(1) title \"rms change by this step\", '' using 3 title \"RMSE to the truth after it\"\n";
}

void ErrorBenchmark::print(const ResolvedFrame& resolved, const engine::Frame& frame, const std::vector<ErrorStep>& steps) const {
  const post::AmbientSettings& t = resolved.frame.transfer;
  if (json) {
    nlohmann::ordered_json out = {{"scene", scene}, {"size", {frame.width, frame.height}}, {"radius", t.radius},
                                  {"membership", nameOf(kMembershipNames, t.membership)}, {"estimator", nameOf(kEstimatorNames, t.estimator)},
                                  {"samples", t.samples}, {"rays", truth.rays}, {"directions", directions}};
    for (const ErrorStep& s : steps)
      out["steps"].push_back({{"name", s.name}, {"change", s.change}, {"rmse", s.error.rmse}, {"bias", s.error.bias},
                              {"p95", s.error.p95}, {"max", s.error.max}, {"ssim", s.error.ssim}});
    std::printf("%s\n", out.dump().c_str());
    return;
  }
  std::printf("%s, %dx%d, R = %g, %s membership, estimator %s with %d samples, truth of %d rays\n\n", scene.c_str(), frame.width, frame.height,
              double(t.radius), nameOf(kMembershipNames, t.membership).c_str(), nameOf(kEstimatorNames, t.estimator).c_str(), t.samples,
              truth.rays);
  std::printf("%-12s %8s %8s %8s %8s %8s  %s\n", "step", "change", "RMSE", "bias", "p95", "SSIM", "what is given up");
  for (const ErrorStep& s : steps)
    std::printf("%-12s %8.4f %8.4f %+8.4f %8.4f %8.4f  %s\n", s.name.c_str(), s.change, s.error.rmse, s.error.bias, s.error.p95,
                s.error.ssim, s.what.c_str());
}

}  // namespace obscura::apps
