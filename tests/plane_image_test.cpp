#include <catch2/catch.hpp>

#include <cstring>
#include <limits>
#include <set>

#include "obscura/engine/digest.h"
#include "obscura/engine/plane_image.h"

using namespace obscura::engine;
using obscura::raster::Plane;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();

template <class T>
Plane<T> plane(int width, int height, const std::vector<T>& values, int padding) {
  Plane<T> p(width, height);
  for (int y = 0; y < height; ++y) {
    std::memset(p.row(y), padding, p.stride() * sizeof(T));
    for (int x = 0; x < width; ++x) p.at(x, y) = values[size_t(y * width + x)];
  }
  return p;
}

}  // namespace

TEST_CASE("plane image: planes are interleaved pixel by pixel, every bit kept") {
  const auto x = plane<float>(3, 2, {1, -0.0f, kInf, kNaN, 5, 6}, 0), y = plane<float>(3, 2, {7, 8, 9, 10, 11, 12}, 0);
  const Image image = interleave({&x, &y});
  REQUIRE(image.width == 3);
  REQUIRE(image.height == 2);
  REQUIRE(image.channels == 2);
  REQUIRE(image.format == Format::F32);
  const float expected[] = {1, 7, -0.0f, 8, kInf, 9, kNaN, 10, 5, 11, 6, 12};
  REQUIRE(image.bytes.size() == sizeof expected);
  REQUIRE(std::memcmp(image.bytes.data(), expected, sizeof expected) == 0);

  const auto ids = plane<uint32_t>(2, 1, {7, 0xFFFFFFFFu}, 0);
  const Image one = interleave({&ids});
  REQUIRE(one.format == Format::U32);
  REQUIRE(one.row<uint32_t>(0)[1] == 0xFFFFFFFFu);

  const auto other = plane<float>(2, 3, {1, 2, 3, 4, 5, 6}, 0);
  REQUIRE(interleave({&x, &other}).bytes.empty());
}

TEST_CASE("plane image: what the padding of a plane holds changes neither digest nor picture") {
  const std::vector<float> values = {1, 2, 3, 4, 5, kInf};
  const auto a = plane(3, 2, values, 0), b = plane(3, 2, values, 0xAB);
  REQUIRE(digest(interleave({&a, &a, &a})) == digest(interleave({&b, &b, &b})));
  REQUIRE(depthPicture(a).bytes == depthPicture(b).bytes);
}

TEST_CASE("plane image: ids get bright colours of their own, nothing is black") {
  std::vector<uint32_t> values(1000);
  for (uint32_t i = 0; i < 999; ++i) values[i] = i;
  values[999] = 0xFFFFFFFFu;
  const Image image = idPicture(plane(100, 10, values, 0));
  std::set<std::vector<uint8_t>> colors;
  int dark = 0, alike = 0;
  for (size_t i = 0; i < 999; ++i) {
    const uint8_t* p = &image.bytes[i * 3];
    dark += std::max({p[0], p[1], p[2]}) < 255;
    alike += i > 0 && std::abs(p[0] - p[-3]) + std::abs(p[1] - p[-2]) + std::abs(p[2] - p[-1]) < 12;
    colors.insert({p, p + 3});
  }
  REQUIRE(dark == 0);
  REQUIRE(alike < 20);
  REQUIRE(colors.size() > 950);
  REQUIRE(image.bytes[999 * 3] + image.bytes[999 * 3 + 1] + image.bytes[999 * 3 + 2] == 0);
  REQUIRE(digest(image) == "5a0617e24e440dad6ad9a2364917dbe6");  // an id has the same colour in every release
}

TEST_CASE("plane image: near is bright, far is dark, infinity and NaN are black") {
  const Image image = depthPicture(plane<float>(5, 1, {1, 2, 5, kInf, kNaN}, 0));
  const std::vector<uint8_t> expected = {255, 255, 255, 144, 144, 144, 32, 32, 32, 0, 0, 0, 0, 0, 0};
  REQUIRE(image.bytes == expected);  // t = 1/4: 32 + 223 / 2 = 143.5
  REQUIRE(depthPicture(plane<float>(2, 1, {3, 3}, 0)).bytes == std::vector<uint8_t>(6, 255));
  REQUIRE(depthPicture(plane<float>(1, 1, {kInf}, 0)).bytes == std::vector<uint8_t>(3, 0));
  REQUIRE(depthPicture(plane<float>(2, 1, {-3e38f, 3e38f}, 0)).bytes[3] == 32);
}

TEST_CASE("plane image: normals map from -1 ... 1 to 0 ... 255 and are clamped") {
  const auto x = plane<float>(3, 1, {-1, 0, kNaN}, 0), y = plane<float>(3, 1, {1, 0.5f, kInf}, 0);
  const Image image = normalPicture(x, y, x);
  REQUIRE(image.bytes == std::vector<uint8_t>{0, 255, 0, 128, 191, 128, 0, 255, 0});
  REQUIRE(normalPicture(x, y, plane<float>(1, 1, {0}, 0)).bytes.empty());
}

TEST_CASE("plane image: an empty plane gives an empty image") {
  REQUIRE(depthPicture(Plane<float>()).bytes.empty());
  REQUIRE(idPicture(Plane<uint32_t>()).bytes.empty());
}
