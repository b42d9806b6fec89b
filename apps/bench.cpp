// obscura-bench: what the engine costs. Every benchmark checks its digest before it prints a time.
#include <cstdio>

#include <CLI/CLI.hpp>

#include "obscura/apps/bench_accuracy.h"
#include "obscura/apps/bench_frame.h"

int main(int argc, char** argv) {
  CLI::App app{"Benchmarks of obscura. Times are medians; to compare, take ratios from one run."};
  app.require_subcommand(1);
  int status = 0;
  obscura::apps::FrameBenchmark frame;
  frame.addTo(app, status);
  obscura::apps::AccuracyBenchmark accuracy;
  accuracy.addTo(app, status);
  CLI11_PARSE(app, argc, argv);
  return status;
}
