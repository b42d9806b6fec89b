#include <catch2/catch.hpp>

#include <cmath>

#include "obscura/engine/mipmap.h"

using namespace obscura::engine;

namespace {

uint32_t texel(uint32_t r, uint32_t g, uint32_t b, uint32_t a) { return r | g << 8 | b << 16 | a << 24; }

uint32_t channel(uint32_t t, int c) { return t >> (8 * c) & 255; }

double linearOf(double code) {
  const double v = code / 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double codeOf(double linear) {
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

// Area of [a, b) x [c, d) in texels, by brute force over the source texels.
double meanOver(const std::vector<uint32_t>& texels, int w, int h, int c, double x0, double x1, double y0, double y1) {
  double sum = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double dx = std::min(x1, x + 1.0) - std::max(x0, double(x));
      const double dy = std::min(y1, y + 1.0) - std::max(y0, double(y));
      if (dx > 0 && dy > 0) sum += dx * dy * linearOf(channel(texels[size_t(y * w + x)], c));
    }
  return sum / ((x1 - x0) * (y1 - y0));
}

}  // namespace

TEST_CASE("mipmap: the chain has every level down to one texel") {
  CHECK(mipLevels(1, 1) == 1);
  CHECK(mipLevels(2, 1) == 2);
  CHECK(mipLevels(5, 3) == 3);
  CHECK(mipLevels(32768, 1) == 16);
  CHECK(mipTexels(5, 3) == 15 + 2 + 1);
  CHECK(mipTexels(16384, 16384) == 357913941);
  CHECK(mipTexels(4, 1) == 7);
}

TEST_CASE("mipmap: every grey of a uniform image comes back unchanged at every level") {
  for (const bool srgb : {false, true})
    for (uint32_t grey = 0; grey < 256; ++grey) {
      const uint32_t t = texel(grey, 255 - grey, grey, grey);
      const std::vector<uint32_t> level0(7 * 6, t), chain = mipChain(level0, 7, 6, srgb);
      REQUIRE(chain.size() == mipTexels(7, 6));
      for (uint32_t found : chain) REQUIRE(found == t);
    }
}

TEST_CASE("mipmap: sRGB colours are averaged in linear light, alpha and other colours as they are") {
  const std::vector<uint32_t> level0 = {texel(0, 0, 0, 0), texel(255, 255, 255, 255)};
  CHECK(mipChain(level0, 2, 1, true)[2] == texel(188, 188, 188, 128));
  CHECK(mipChain(level0, 2, 1, false)[2] == texel(128, 128, 128, 128));
}

TEST_CASE("mipmap: every texel is the mean over its area, odd sizes and even ones") {
  const int sizes[][2] = {{7, 5}, {8, 4}, {7, 4}, {8, 5}, {6, 6}, {9, 3}};
  for (const auto& [w, h] : sizes) {
    std::vector<uint32_t> level0;
    for (uint32_t i = 0; i < uint32_t(w * h); ++i) level0.push_back(texel(i * 37 % 256, i * 101 % 256, i * 3, 255));
    const std::vector<uint32_t> chain = mipChain(level0, w, h, true);
    REQUIRE(chain.size() == mipTexels(w, h));
    const uint32_t* found = &chain[size_t(w * h)];
    for (int level = 1; level < mipLevels(w, h); ++level) {
      const int lw = std::max(1, w >> level), lh = std::max(1, h >> level);
      const double sx = double(w) / lw, sy = double(h) / lh;
      for (int y = 0; y < lh; ++y)
        for (int x = 0; x < lw; ++x, ++found)
          for (int c = 0; c < 3; ++c) {
            const double mean = meanOver(level0, w, h, c, x * sx, (x + 1) * sx, y * sy, (y + 1) * sy);
            REQUIRE(std::abs(channel(*found, c) - codeOf(mean)) < 0.6);
          }
    }
  }
}

TEST_CASE("mipmap: a row or a column is halved along its length only") {
  const std::vector<uint32_t> level0 = {texel(0, 0, 0, 0), texel(2, 4, 6, 8), texel(10, 20, 30, 40),
                                        texel(30, 40, 50, 60)};
  for (const bool isRow : {true, false}) {
    const std::vector<uint32_t> chain = mipChain(level0, isRow ? 4 : 1, isRow ? 1 : 4, false);
    REQUIRE(chain.size() == 7);
    CHECK(chain[4] == texel(1, 2, 3, 4));
    CHECK(chain[5] == texel(20, 30, 40, 50));
    CHECK(chain[6] == texel(11, 16, 22, 27));  // 10.5 and 21.5 round up
  }
}
