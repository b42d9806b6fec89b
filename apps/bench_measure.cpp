#include "obscura/apps/bench_measure.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <new>

#include "obscura/engine/digest.h"

namespace obscura::apps {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

Spread spreadOf(const std::vector<double>& values) {
  return {quantile(values, 0.1), quantile(values, 0.5), quantile(values, 0.9)};
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, size_t(q * double(values.size())))];
}

int fail(const engine::Error& error) {
  std::fprintf(stderr, "obscura-bench: error: %s\n", error.text().c_str());
  return error.code == engine::ErrorCode::Usage ? 2 : error.code == engine::ErrorCode::BadInput ? 3 : 4;
}

int guarded(const std::function<int()>& body) try { return body(); } catch (const Differs& e) {
  std::fprintf(stderr, "obscura-bench: error: %s\n", e.what());
  return 1;
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "obscura-bench: error: not enough memory\n");
  return 3;
} catch (const std::exception& e) {  // threads that cannot be started, for instance
  std::fprintf(stderr, "obscura-bench: error: %s\n", e.what());
  return 3;
}

std::string digestOf(const raster::GBuffer& g, const raster::PlaneSet& planes) {
  std::vector<const raster::Plane<float>*> floats;
  std::vector<const raster::Plane<uint32_t>*> ids;
  if (planes.depth) floats.push_back(&g.depth);
  for (int c = 0; c < 3; ++c) {
    if (planes.normal) floats.push_back(&g.normal[c]);
    if (planes.albedo) floats.push_back(&g.albedo[c]);
  }
  if (planes.triangle) ids.push_back(&g.triangle);
  // As one tall image of 4-byte values: plane below plane.
  const auto row = [&](int y) -> const void* {
    const size_t plane = size_t(y / g.height);
    if (plane < floats.size()) return floats[plane]->row(y % g.height);
    return ids[plane - floats.size()]->row(y % g.height);
  };
  return engine::digest({g.width, g.height * int(floats.size() + ids.size()), 1, engine::Format::U32, row});
}

FrameCost measureFrames(raster::Rasterizer& rasterizer, const raster::DrawList& list, const raster::Camera& camera,
                        int width, int height, const raster::PlaneSet& planes, const FrameBudget& budget,
                        raster::GBuffer& g) {
  FrameCost cost;
  std::vector<double> frame, setup, tiles;
  double seconds = 0;
  for (int k = -budget.warmUp; k < budget.mostFrames; ++k) {
    if (k >= budget.leastFrames && seconds >= budget.mostSeconds) break;
    const Clock::time_point start = Clock::now();
    rasterizer.render(list, camera, width, height, planes, g);
    const double ms = millisecondsSince(start);
    const std::string found = digestOf(g, planes);
    if (!cost.digest.empty() && found != cost.digest)
      throw Differs("frame " + std::to_string(k) + " differs from the one before: " + found + ", " + cost.digest);
    cost.digest = found;
    if (k < 0) continue;
    seconds += ms * 1e-3;
    frame.push_back(ms);
    setup.push_back(rasterizer.timings().setupMs);
    tiles.push_back(rasterizer.timings().tilesMs);
  }
  cost.times = {spreadOf(frame), spreadOf(setup), spreadOf(tiles), int(frame.size())};
  cost.statistics = rasterizer.statistics();
  return cost;
}

}  // namespace obscura::apps
