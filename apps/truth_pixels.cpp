#include "obscura/apps/truth_pixels.h"

#include <algorithm>
#include <cmath>

#include "obscura/raster/parallel.h"

namespace obscura::apps {
namespace {

void tracePixel(PixelTracer& tracer, const TruthStart& start, uint32_t pixelSeed, const TruthSettings& s, int x, int y, Truth& out) {
  const int perScramble = s.rays / kTruthScrambles;
  const size_t quantities = out.value.size();
  std::vector<double> mean(quantities), square(quantities), sums(quantities);
  for (int k = 0; k < kTruthScrambles; ++k) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (int i = 0; i < perScramble; i += RayBatch::kSize)
      tracer.add(start, uint32_t(i), std::min(RayBatch::kSize, perScramble - i), pixelSeed, k, sums.data());
    for (size_t q = 0; q < quantities; ++q) {
      const double v = sums[q] / perScramble;
      mean[q] += v / kTruthScrambles;
      square[q] += v * v / kTruthScrambles;
    }
  }
  for (size_t q = 0; q < quantities; ++q) {
    out.value[q].at(x, y) = float(mean[q]);
    out.error[q].at(x, y) = float(std::sqrt(std::max(0.0, square[q] - mean[q] * mean[q]) / (kTruthScrambles - 1)));
  }
}

}  // namespace

Truth tracePixels(const TruthStarts& starts, int width, int height, const TruthSettings& settings, const std::vector<float>& empty,
                  const std::function<std::unique_ptr<PixelTracer>()>& makeTracer, const std::function<void(int)>& done) {
  Truth out(width, height, int(empty.size()));
  raster::Parallel(settings.threads).forRanges(size_t(height), 1, [&](size_t begin, size_t end, int) {
    const std::unique_ptr<PixelTracer> tracer = makeTracer();
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < width; ++x)
        if (starts.seen(x, y)) tracePixel(*tracer, starts.at(x, y), starts.seed(x, y), settings, x, y, out);
        else
          for (size_t q = 0; q < empty.size(); ++q) out.value[q].at(x, y) = empty[q], out.error[q].at(x, y) = 0;
    done(int(end - begin));
  });
  return out;
}

}  // namespace obscura::apps
