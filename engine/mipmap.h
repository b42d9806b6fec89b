// In: an image.  Out: the image with all its smaller levels.
#pragma once

#include <cstdint>
#include <vector>

#include "obscura/raster/span.h"

namespace obscura::engine {

// Levels down to 1 x 1, each max(1, width >> k) x max(1, height >> k); width and height in 1 ... 32768.
int mipLevels(int width, int height);
uint64_t mipTexels(int width, int height);  // of all levels together

// Appends levels 1 ... mipLevels - 1 to level 0: width x height RGBA texels, R in the lowest byte. Each texel is the
// mean over exactly the area of level 0 it covers (with odd sizes texels at the border of two areas count in both,
// by their share). With srgb, RGB are averaged in linear light; alpha never is encoded. Intermediate levels keep
// 16 bits, so rounding does not pile up. Integers only after two tables made of + - * /: the same on every machine.
std::vector<uint32_t> mipChain(raster::Span<const uint32_t> level0, int width, int height, bool srgb);

}  // namespace obscura::engine
