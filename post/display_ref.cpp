// Scalar twin of display.cpp: counts the thresholds that the value has reached.
#include <algorithm>

#include "obscura/post/display.h"

namespace obscura::post {

void displayRef(const LinearColor& in, const DisplayTable& table, int y0, int y1, DisplayImage& out) {
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.rgba.width(); ++x) {
      uint32_t rgba = 0xFF000000u;
      for (int c = 0; c < 3; ++c) {
        const float v = in.rgb[c].at(x, y);
        const auto reached = v > 0 ? std::upper_bound(table.threshold, table.threshold + 256, v) - table.threshold : 1;
        rgba |= uint32_t(reached - 1) << (8 * c);
      }
      out.rgba.at(x, y) = rgba;
    }
}

}  // namespace obscura::post
