// obscura-bench: what the engine costs. Every benchmark checks its digest before it prints a time.
#include <cstdio>

#include <CLI/CLI.hpp>

#include "obscura/apps/bench_accuracy.h"
#include "obscura/apps/bench_albedo.h"
#include "obscura/apps/bench_error.h"
#include "obscura/apps/bench_frame.h"
#include "obscura/apps/bench_irradiance.h"
#include "obscura/apps/bench_pareto.h"
#include "obscura/apps/bench_peers.h"
#include "obscura/apps/bench_raster.h"
#include "obscura/apps/bench_scaling.h"
#include "obscura/apps/bench_transfer.h"
#include "obscura/apps/bench_truth.h"

int main(int argc, char** argv) {
  CLI::App app{"Benchmarks of obscura. Times are medians; to compare, take ratios from one run."};
  app.require_subcommand(1);
  int status = 0;
  obscura::apps::FrameBenchmark frame;
  frame.addTo(app, status);
  obscura::apps::TransferBenchmark transfer;
  transfer.addTo(app, status);
  obscura::apps::RasterBenchmark raster;
  raster.addTo(app, status);
  obscura::apps::ScalingBenchmark scaling;
  scaling.addTo(app, status);
  obscura::apps::AccuracyBenchmark accuracy;
  accuracy.addTo(app, status);
  obscura::apps::TruthBenchmark truth;
  truth.addTo(app, status);
  obscura::apps::ParetoBenchmark pareto;
  pareto.addTo(app, status);
  obscura::apps::AlbedoBenchmark albedo;
  albedo.addTo(app, status);
  obscura::apps::IrradianceBenchmark irradiance;
  irradiance.addTo(app, status);
  obscura::apps::ErrorBenchmark error;
  error.addTo(app, status);
  obscura::apps::PeersBenchmark peers;
  peers.addTo(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;  // 0: --help
  }
  return status;
}
