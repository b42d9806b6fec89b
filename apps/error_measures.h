// In:  an image and its truth.
// Out: how far they are apart.
#pragma once

#include <vector>

#include "obscura/engine/image.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/plane.h"

namespace obscura::apps {

struct ErrorMeasures {
  double rmse = 0, bias = 0;  // root of the mean square and mean of value - truth
  double p95 = 0, max = 0;    // of |value - truth|
  double ssim = 1;
};

using PlaneRefs = std::vector<const raster::Plane<float>*>;  // one per channel, all of one size

// A truth to be compared with again and again.
class ErrorMeter {
 public:
  // seen: 1 where a pixel counts. Channels count alike. The planes must outlive it.
  ErrorMeter(PlaneRefs truth, const raster::Plane<uint8_t>& seen, raster::Parallel& parallel);

  // SSIM: Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment" (2004): Gaussian window of 11 x 11, sigma 1.5,
  // K1 = 0.01, K2 = 0.03, range 1; windows go on with the nearest pixel beyond the border.
  ErrorMeasures measure(const PlaneRefs& value) const;

  // value - truth, mean of the channels, as U8 RGB: white where equal, red where too bright, blue where too dark, full at
  // `scale` and beyond; black where nothing is seen.
  engine::Image map(const PlaneRefs& value, double scale) const;

 private:
  double ssim(const PlaneRefs& value) const;

  PlaneRefs truth_;
  const raster::Plane<uint8_t>& seen_;
  raster::Parallel& parallel_;
  std::vector<std::vector<float>> mean_, square_;  // of the truth, blurred
};

}  // namespace obscura::apps
