// Linear colour, one plane per channel: what light makes, and the radiance that the ambient transfer can read.
#pragma once

#include "obscura/raster/plane.h"

namespace obscura::post {

struct LinearColor {
  raster::Plane<float> rgb[3];
};

LinearColor makeLinearColor(int width, int height, LinearColor used = {});

}  // namespace obscura::post
