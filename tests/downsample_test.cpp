// From sub-pixels to pixels: against the scalar twins, and against what a mean and a nearest sub-pixel must be.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "obscura/post/display.h"
#include "obscura/post/downsample.h"
#include "obscura/raster/parallel.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

using Values = raster::Plane<float>;
using Ids = raster::Plane<uint32_t>;
constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

template <class Value>
Values planeOf(int width, int height, const Value& value) {
  Values p(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) p.at(x, y) = value(x, y);
  return p;
}

Values mean(const Values& in, int s) {
  Values out(in.width() / s, in.height() / s);
  post::meanOfSubpixels(in, s, 0, out.height(), out, raster::chooseTarget(raster::Target::Auto));
  return out;
}

Ids nearestOf(const Values& depth, int s) {
  Ids out(depth.width() / s, depth.height() / s);
  post::nearestSubpixel(depth, s, 0, out.height(), out, raster::chooseTarget(raster::Target::Auto));
  return out;
}

int displayed(float linear) {
  static const post::DisplayTable table;
  post::LinearColor color = post::makeLinearColor(1, 1);
  for (Values& plane : color.rgb) plane.at(0, 0) = linear;
  post::DisplayImage image = post::makeDisplayImage(1, 1);
  post::displayRef(color, table, 0, 1, image);
  return int(image.rgba.at(0, 0) & 255);
}

}  // namespace

TEST_CASE("downsample: every size, target and number of threads gives the bits of the scalar twin") {
  Random random(7);
  const float odd[] = {0, -0.f, kInfinity, 3e38f, 1e-45f, 1, 1e30f};
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 9}, {15, 3}, {16, 2}, {17, 5}, {31, 20}, {70, 33}})
    for (int s : {2, 4}) {
      const Values in = planeOf(width * s, height * s, [&](int, int) {
        return random.integer(0, 9) ? random.real(0, 3) : odd[random.integer(0, 6)];
      });
      const Values depth = planeOf(width * s, height * s, [&](int, int) {
        return random.integer(0, 2) ? float(random.integer(1, 5)) : random.integer(0, 3) ? kInfinity : kNan;
      });
      Values bits(width * s, height * s);  // any pattern at all, NaN of every payload too
      Ids ids(width * s, height * s);
      for (int y = 0; y < height * s; ++y)
        for (int x = 0; x < width * s; ++x) {
          const uint32_t v = random.bits();
          std::memcpy(&bits.at(x, y), &v, 4);
          ids.at(x, y) = random.bits();
        }
      Values meanRef(width, height), takenRef(width, height);
      Ids nearestRef(width, height), idsRef(width, height);
      post::meanOfSubpixelsRef(in, s, 0, height, meanRef);
      post::nearestSubpixelRef(depth, s, 0, height, nearestRef);
      post::takeSubpixelRef(bits, nearestRef, s, 0, height, takenRef);
      post::takeSubpixelRef(ids, nearestRef, s, 0, height, idsRef);
      for (raster::Target target : raster::supportedTargets())
        for (int threads : {1, 3}) {
          INFO(width << "x" << height << ", s " << s << ", " << raster::targetName(target) << ", " << threads << " threads");
          Values meanFound(width, height), takenFound(width, height);
          Ids nearestFound(width, height), idsFound(width, height);
          raster::Parallel(threads).forRanges(size_t(height), 2, [&](size_t begin, size_t end, int) {
            const int y0 = int(begin), y1 = int(end);
            post::meanOfSubpixels(in, s, y0, y1, meanFound, target);
            post::nearestSubpixel(depth, s, y0, y1, nearestFound, target);
            post::takeSubpixel(bits, nearestFound, s, y0, y1, takenFound, target);
            post::takeSubpixel(ids, nearestFound, s, y0, y1, idsFound, target);
          });
          REQUIRE(firstDifference("mean", meanFound, meanRef) == "");
          REQUIRE(firstDifference("nearest", nearestFound, nearestRef) == "");
          REQUIRE(firstDifference("values", takenFound, takenRef) == "");
          REQUIRE(firstDifference("ids", idsFound, idsRef) == "");
        }
    }
}

TEST_CASE("downsample: a pixel half black and half white is linear 0.5, which a screen shows as 188") {
  for (int s : {2, 4})
    for (bool upright : {true, false}) {
      const Values edge = planeOf(3 * s, 3 * s, [&](int x, int y) { return (upright ? x : y) >= s + s / 2 ? 1.f : 0.f; });
      const Values out = mean(edge, s);
      CHECK(out.at(1, 1) == 0.5f);
      CHECK(out.at(0, 0) == 0);
      CHECK(out.at(2, 2) == 1);
      CHECK(displayed(out.at(1, 1)) == 188);
    }
}

TEST_CASE("downsample: equal sub-pixels give their own bits again, whatever the value") {
  Random random(3);
  std::vector<float> values = {0, -0.f, 1e-45f, 3e-45f, 1.17549435e-38f, 2.1e37f, kInfinity, 1.f / 3, 16777215};
  for (int i = 0; i < 200; ++i) values.push_back(random.real(0, 2));
  for (int s : {2, 4}) {
    const Values out = mean(planeOf(int(values.size()) * s, s, [&](int x, int) { return values[size_t(x / s)]; }), s);
    for (size_t i = 0; i < values.size(); ++i) {
      INFO(values[i]);
      REQUIRE(std::memcmp(&out.at(int(i), 0), &values[i], 4) == 0);
    }
  }
}

TEST_CASE("downsample: the nearest sub-pixel is the first of the smallest depth, empty and NaN are never nearer") {
  const float z[2][10] = {{3, 2, 5, 5, kInfinity, kInfinity, kNan, 9, kInfinity, 7},
                          {2, 1, 5, 4, kInfinity, kInfinity, kNan, 8, 7, 7}};
  const Ids two = nearestOf(planeOf(10, 2, [&](int x, int y) { return z[y][x]; }), 2);
  const uint32_t expected[] = {3, 3, 0, 3, 1};
  for (int x = 0; x < 5; ++x) CHECK(two.at(x, 0) == expected[x]);
  for (uint32_t k = 0; k < 16; ++k) {  // each in turn, with an equal one behind it
    const Ids four = nearestOf(planeOf(4, 4, [&](int x, int y) { return uint32_t(4 * y + x) >= k ? 1.f : 2.f; }), 4);
    CHECK(four.at(0, 0) == k);
  }
}

TEST_CASE("downsample: a slanted edge covers as many sixteenths of each pixel as it has sub-pixel centres, near its area") {
  constexpr int kSize = 24, kSub = 4;
  TestScene scene;
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
  scene.width = scene.height = kSize * kSub;
  scene.camera = raster::orthographic(kSize / 2.0, kSize / 2.0, 0.1, 10);  // a pixel is a unit
  TestMesh& mesh = scene.addMesh();
  // Left of the line x = offset - y / 10 from the image's centre; corners snap to themselves, no centre is on the line.
  const float z = -1, offset = -2381 / 1024.f;
  TestScene::addQuad(mesh, {-40, -20, z}, {2 + offset, -20, z}, {-2 + offset, 20, z}, {-40, 20, z});
  scene.place(mesh);
  raster::Rasterizer rasterizer;
  raster::GBuffer g;
  rasterizer.render(scene.list(), scene.camera, scene.width, scene.height, kAllPlanes, g);
  const Values coverage = mean(planeOf(scene.width, scene.height, [&](int x, int y) {
    return g.triangle.at(x, y) == raster::kNoTriangle ? 0.f : 1.f;
  }), kSub);

  double worst = 0, sum = 0, areas = 0;
  int partial = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const auto edge = [&](double row) { return kSize / 2.0 + offset - (kSize / 2.0 - row) / 10; };  // its x there
      int centres = 0;
      for (int k = 0; k < 16; ++k) centres += x + (k % 4 + 0.5) / 4 < edge(y + (k / 4 + 0.5) / 4);
      double area = 0;
      for (int k = 0; k < 256; ++k) area += std::min(std::max(edge(y + (k + 0.5) / 256) - x, 0.0), 1.0) / 256;
      REQUIRE(coverage.at(x, y) == float(centres) / 16);
      worst = std::max(worst, std::fabs(area - double(coverage.at(x, y))));
      sum += double(coverage.at(x, y)), areas += area;
      partial += area > 0 && area < 1;
    }
  CHECK(partial >= kSize);
  CHECK(worst <= 2.0 / 16);  // half a sub-pixel in each of four rows
  CHECK(std::fabs(sum - areas) < 0.5);
}
