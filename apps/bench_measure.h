// What the benchmarks share: frames of a draw list are measured, and are the same each time.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "obscura/engine/result.h"
#include "obscura/raster/rasterizer.h"

namespace obscura::apps {

constexpr int kWarmUp = 2;  // frames that are drawn and not counted

// q in [0, 1]; values not empty.
double quantile(std::vector<double> values, double q);

struct Spread {
  double p10 = 0, median = 0, p90 = 0;
};
Spread spreadOf(const std::vector<double>& values);  // not empty

// Pixels that must be the same are not.
struct Differs : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// One line on standard error; the exit code: 2 (usage), 3 (bad input) or 4 (cannot write).
int fail(const engine::Error& error);

// The exit code that `body` returns. If it throws: one line on standard error, and 1 (Differs) or 3.
int guarded(const std::function<int()>& body);

// XXH3-128 over the planes of `planes` that the buffer has, one after another, without padding.
std::string digestOf(const raster::GBuffer& g, const raster::PlaneSet& planes);

struct FrameTimes {
  Spread frame, setup, tiles;  // ms; frame is what a caller waits, for the others see raster::Timings
  int frames = 0;              // measured
};

struct FrameCost {
  FrameTimes times;
  std::string digest;  // of every frame
  raster::Statistics statistics;
};

// When to stop: after mostFrames, or from leastFrames on when mostSeconds are over.
struct FrameBudget {
  int warmUp = kWarmUp, leastFrames = 3, mostFrames = 20;
  double mostSeconds = 1.5;
};

// Draws frames into `g`, hashing each outside of the time. Throws Differs, and what Rasterizer::render throws.
FrameCost measureFrames(raster::Rasterizer& rasterizer, const raster::DrawList& list, const raster::Camera& camera,
                        int width, int height, const raster::PlaneSet& planes, const FrameBudget& budget,
                        raster::GBuffer& g);

}  // namespace obscura::apps
