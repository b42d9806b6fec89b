// The sRGB transfer function (IEC 61966-2-1), without libm.
#pragma once

namespace obscura::raster {

double linearFromSrgb(double encoded);  // [0, 1] -> [0, 1]; outside it is clamped, NaN is 0
double srgbFromLinear(double linear);   // its inverse

// linear[b] = linearFromSrgb(b / 255), rounded to float: how 8-bit texels are decoded.
struct SrgbTable {
  SrgbTable();
  float linear[256];
};

}  // namespace obscura::raster
