#include "obscura/engine/mipmap.h"

#include <algorithm>
#include <array>

#include "obscura/raster/exact_math.h"

namespace obscura::engine {
namespace {

// IEC 61966-2-1; code in [0, 255], the result in [0, 65535].
double linear16FromSrgb(double code) {
  const double v = code / 255;
  return 65535 * (v <= 0.04045 ? v / 12.92 : raster::exactPow((v + 0.055) / 1.055, 2.4));
}

struct SrgbTables {
  std::array<uint16_t, 256> linear;      // 16-bit linear light of a code
  std::array<uint8_t, 65536> encoded;    // the nearest code, in codes
  SrgbTables() {
    for (int c = 0; c < 256; ++c) linear[size_t(c)] = uint16_t(linear16FromSrgb(c) + 0.5);
    size_t k = 0;
    for (int c = 0; c < 256; ++c) {
      const double end = c == 255 ? 65536 : linear16FromSrgb(c + 0.5);
      for (; k < encoded.size() && double(k) < end; ++k) encoded[k] = uint8_t(c);
    }
  }
};

const SrgbTables& srgbTables() {
  static const SrgbTables tables;
  return tables;
}

// Source texels 2 i ... 2 i + count - 1 make texel i, by integer weights whose sum is `total`. A side of 2 d + 1
// texels becomes d: texel i covers [i (2 d + 1) / d, (i + 1) (2 d + 1) / d), that is (d - i) / d, 1 and (i + 1) / d
// of three texels.
struct Taps {
  int count;
  uint32_t weight[3], total;
};

Taps tapsOf(int size, int i) {
  const uint32_t d = uint32_t(size) / 2;
  if (size == 1) return {1, {1, 0, 0}, 1};
  if (size % 2 == 0) return {2, {1, 1, 0}, 2};
  return {3, {d - uint32_t(i), d, uint32_t(i) + 1}, uint32_t(size)};
}

using Row16 = std::vector<uint16_t>;  // four channels a texel

// In: `row(y)` gives a row of the w x h level above; it and the one before stay valid.
// Out: the next level, four 16-bit channels a texel.
template <class RowOf>
Row16 halveEven(RowOf row, int w, int h) {
  Row16 out(size_t(w) * size_t(h));
  uint16_t* texel = out.data();
  for (int y = 0; y < h; y += 2) {
    const uint16_t* a = row(y);
    const uint16_t* b = row(y + 1);
    for (int x = 0; x < w; x += 2, a += 8, b += 8, texel += 4)
      for (int c = 0; c < 4; ++c) texel[c] = uint16_t((uint32_t(a[c]) + a[c + 4] + b[c] + b[c + 4] + 2) >> 2);
  }
  return out;
}

// The same for any size. Vertical sums are < 32769 * 65536 and fit 32 bits, the whole < 2^47.
template <class RowOf>
Row16 halve(RowOf row, int w, int h) {
  if (w % 2 == 0 && h % 2 == 0) return halveEven(row, w, h);
  const int ow = std::max(1, w / 2), oh = std::max(1, h / 2);
  Row16 out(size_t(ow) * size_t(oh) * 4);
  std::vector<uint32_t> sums(size_t(w) * 4);
  for (int y = 0; y < oh; ++y) {
    const Taps ty = tapsOf(h, y);
    std::fill(sums.begin(), sums.end(), 0u);
    for (int k = 0; k < ty.count; ++k) {
      const uint16_t* in = row(2 * y + k);
      for (size_t i = 0; i < sums.size(); ++i) sums[i] += ty.weight[k] * in[i];
    }
    for (int x = 0; x < ow; ++x) {
      const Taps tx = tapsOf(w, x);
      const uint64_t total = uint64_t(tx.total) * ty.total;
      for (size_t c = 0; c < 4; ++c) {
        uint64_t sum = total / 2;
        for (int k = 0; k < tx.count; ++k) sum += uint64_t(tx.weight[k]) * sums[size_t(2 * x + k) * 4 + c];
        out[(size_t(y) * size_t(ow) + size_t(x)) * 4 + c] = uint16_t(sum / total);
      }
    }
  }
  return out;
}

}  // namespace

int mipLevels(int width, int height) {
  int levels = 1;
  for (int side = std::max(width, height); side > 1; side >>= 1) ++levels;
  return levels;
}

uint64_t mipTexels(int width, int height) {
  uint64_t texels = 0;
  for (int k = mipLevels(width, height); k-- > 0;)
    texels += uint64_t(std::max(1, width >> k)) * uint64_t(std::max(1, height >> k));
  return texels;
}

std::vector<uint32_t> mipChain(raster::Span<const uint32_t> level0, int width, int height, bool srgb) {
  std::vector<uint32_t> chain(size_t(mipTexels(width, height)));
  uint32_t* out = std::copy(level0.begin(), level0.end(), chain.data());
  const SrgbTables* tables = srgb ? &srgbTables() : nullptr;

  Row16 scratch(size_t(width) * 8), level;
  int w = width, h = height;
  for (int k = 1; k < mipLevels(width, height); ++k) {
    if (k == 1) {
      level = halve(
          [&](int y) {
            uint16_t* to = &scratch[y % 2 == 0 ? 0 : size_t(width) * 4];
            for (size_t x = 0; x < size_t(width); ++x) {
              const uint32_t texel = level0[size_t(y) * size_t(width) + x];
              for (unsigned c = 0; c < 4; ++c) {
                const uint32_t value = texel >> (8 * c) & 255;
                to[x * 4 + c] = c < 3 && tables ? tables->linear[value] : uint16_t(value * 257);
              }
            }
            return static_cast<const uint16_t*>(to);
          },
          w, h);
    } else {
      level = halve([&](int y) { return level.data() + size_t(y) * size_t(w) * 4; }, w, h);
    }
    w = std::max(1, w / 2);
    h = std::max(1, h / 2);
    for (size_t i = 0; i < level.size(); i += 4) {
      uint32_t texel = 0;
      for (unsigned c = 0; c < 4; ++c) {
        const uint32_t value = level[i + c];
        texel |= uint32_t(c < 3 && tables ? tables->encoded[value] : (value + 128) / 257) << (8 * c);
      }
      *out++ = texel;
    }
  }
  return chain;
}

}  // namespace obscura::engine
