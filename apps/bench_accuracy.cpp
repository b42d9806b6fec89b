#include "obscura/apps/bench_accuracy.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "obscura/apps/accuracy.h"

namespace obscura::apps {

void AccuracyBenchmark::addTo(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("accuracy", "Errors of depth, weights, textures and normals against long double");
  command->add_option("--scale", scale, "times as many triangles")->check(CLI::Range(1, 100))->capture_default_str();
  command->add_flag("--json", json, "one JSON object instead of a table");
  command->callback([this, &status] { status = run(); });
}

int AccuracyBenchmark::run() const {
  const std::vector<AccuracyRow> rows = measureAccuracy(scale);
  if (json) {
    nlohmann::ordered_json out;
    out["renderer"] = "obscura";
    for (const AccuracyRow& r : rows)
      out["accuracy"].push_back({{"workload", r.workload},
                                 {"quantity", r.quantity},
                                 {"pixels", r.pixels},
                                 {"max_ulp", r.maxUlp},
                                 {"rms_ulp", r.rmsUlp},
                                 {"max", r.max},
                                 {"rms", r.rms},
                                 {"unit", r.unit}});
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  std::printf("%-16s %-9s %8s %12s %10s %10s %10s  %s\n", "workload", "quantity", "pixels", "max ulp", "rms ulp", "max",
              "rms", "unit");
  for (const AccuracyRow& r : rows)
    std::printf("%-16s %-9s %8llu %12.2f %10.3f %10.2e %10.2e  %s\n", r.workload.c_str(), r.quantity.c_str(),
                static_cast<unsigned long long>(r.pixels), r.maxUlp, r.rmsUlp, r.max, r.rms, r.unit.c_str());
  return 0;
}

}  // namespace obscura::apps
