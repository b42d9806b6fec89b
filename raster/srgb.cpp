#include "obscura/raster/srgb.h"

#include "obscura/raster/exact_math.h"

namespace obscura::raster {

double linearFromSrgb(double encoded) {
  if (!(encoded > 0)) return 0;
  if (encoded >= 1) return 1;
  return encoded <= 0.04045 ? encoded / 12.92 : exactPow((encoded + 0.055) / 1.055, 2.4);
}

double srgbFromLinear(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * exactPow(linear, 1.0 / 2.4) - 0.055;
}

SrgbTable::SrgbTable() {
  for (int b = 0; b < 256; ++b) linear[b] = float(linearFromSrgb(b / 255.0));
}

}  // namespace obscura::raster
