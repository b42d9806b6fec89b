// In:  what one ray, or path, of a pixel tells.
// Out: the mean over all rays of each pixel, and its standard error.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "obscura/apps/truth.h"

namespace obscura::apps {

// Of one thread.
class PixelTracer {
 public:
  virtual ~PixelTracer() = default;
  // Adds to sums[quantity] what points first ... first + count - 1 (at most RayBatch::kSize) of this scramble tell.
  virtual void add(const TruthStart& start, uint32_t first, int count, uint32_t pixelSeed, int scramble, double* sums) = 0;
};

// empty: for each quantity what pixels hold in which nothing is seen. The same bits for any number of threads. done(rows) is told
// of finished rows, from any thread. Throws std::bad_alloc.
Truth tracePixels(const TruthStarts& starts, int width, int height, const TruthSettings& settings, const std::vector<float>& empty,
                  const std::function<std::unique_ptr<PixelTracer>()>& makeTracer, const std::function<void(int)>& done);

}  // namespace obscura::apps
