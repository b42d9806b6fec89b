// In:  linear colour.
// Out: sRGB bytes, what a screen shows and a PNG holds.
#pragma once

#include <cstdint>

#include "obscura/post/light.h"

namespace obscura::post {

// Byte k stands for the linear values in [threshold[k], threshold[k + 1]): those whose sRGB encoding, times 255, rounds
// to k. Exact by definition, so nothing depends on how a power is approximated.
class DisplayTable {
 public:
  DisplayTable();

  // The float's upper 16 bits (sign, exponent, 7 of the mantissa) narrow it down to two neighbouring bytes.
  static constexpr uint32_t kFirst = 0x3900, kLast = 0x3F80;  // upper halves of 2^-13 and 1
  int32_t guess[kLast - kFirst + 1];  // byte of the smallest float with that upper half
  float threshold[257];               // [0] = 0, [256] = infinity
};

struct DisplayImage {
  raster::Plane<uint32_t> rgba;  // R in the lowest byte, A = 255
};

DisplayImage makeDisplayImage(int width, int height, DisplayImage used = {});

// Values are clamped to [0, 1]; NaN becomes 0.
void display(const LinearColor& in, const DisplayTable& table, int y0, int y1, DisplayImage& out, raster::Target target);
void displayRef(const LinearColor& in, const DisplayTable& table, int y0, int y1, DisplayImage& out);  // the scalar twin

}  // namespace obscura::post
