// Windows of a camera's image: any rectangle of it, border included, has the bits of the whole.
#include <catch2/catch.hpp>

#include "obscura/raster/view.h"
#include "raster_checks.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

template <class T>
Plane<T> cut(const Plane<T>& from, const Window& w) {
  Plane<T> to(w.width, w.height);
  for (int y = 0; y < w.height; ++y) std::memcpy(to.row(y), from.row(w.y + y) + w.x, size_t(w.width) * sizeof(T));
  return to;
}

// w is counted from the corner of g.
GBuffer cut(const GBuffer& g, const Window& w) {
  GBuffer out(w.width, w.height, {});
  out.depth = cut(g.depth, w);
  out.triangle = cut(g.triangle, w), out.instance = cut(g.instance, w), out.material = cut(g.material, w);
  out.metallic = cut(g.metallic, w), out.roughness = cut(g.roughness, w);
  for (int c = 0; c < 3; ++c) {
    out.normal[c] = cut(g.normal[c], w), out.facet[c] = cut(g.facet[c], w), out.albedo[c] = cut(g.albedo[c], w);
    out.emissive[c] = cut(g.emissive[c], w), out.position[c] = cut(g.position[c], w);
  }
  return out;
}

// All kinds of cameras, odd sizes; every third one looks past the image's centre.
TestScene sceneOfSeed(uint32_t seed) {
  TestScene s = soupScene(seed);
  if (seed % 3 == 1) s.camera.xShift = 0.7f, s.camera.yShift = -0.3f;
  return s;
}

constexpr int kBorder = 37;  // on every side of `wide`

GBuffer wide(const TestScene& s) {
  GBuffer g;
  renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, g,
                  Window{-kBorder, -kBorder, s.width + 2 * kBorder, s.height + 2 * kBorder});
  return g;
}

std::string text(const Window& w) {
  return std::to_string(w.x) + "," + std::to_string(w.y) + "," + std::to_string(w.width) + "x" + std::to_string(w.height);
}

// In pixels of the image: the whole, one pixel inside and outside of it, what crosses its edges and those of tiles.
std::vector<Window> oddWindows(const TestScene& s, uint32_t seed) {
  Random random(seed);
  const int w = s.width, h = s.height;
  std::vector<Window> all = {{0, 0, w, h}, {w / 2, h / 2, 1, 1}, {-1, -1, 1, 1}, {w, h / 2, 1, 1}, {-3, 0, w + 5, h},
                             {1, -kBorder, 17, h + 2 * kBorder}, {w / 3, h / 3, 65, 33}};
  for (int i = 0; i < 6; ++i) {
    const int x = random.integer(-kBorder, w + kBorder - 1), y = random.integer(-kBorder, h + kBorder - 1);
    all.push_back({x, y, random.integer(1, w + kBorder - x), random.integer(1, h + kBorder - y)});
  }
  for (Window& v : all) v.width = std::min(v.width, w + kBorder - v.x), v.height = std::min(v.height, h + kBorder - v.y);
  return all;
}

Window inWide(const Window& w) { return {w.x + kBorder, w.y + kBorder, w.width, w.height}; }

}  // namespace

TEST_CASE("window: every plane of a window has the bits of the same place in the whole image and its border") {
  int pixels = 0;
  for (uint32_t seed = 0; seed < 24; ++seed) {
    const TestScene s = sceneOfSeed(seed);
    const GBuffer expected = wide(s);
    REQUIRE(firstDifference(render(s), cut(expected, inWide({0, 0, s.width, s.height}))) == "");
    GBuffer g;
    Rasterizer rasterizer({1, Target::Auto, 16 << seed % 3, true});
    for (const Window& w : oddWindows(s, seed)) {
      INFO("seed " << seed << ", image " << s.width << "x" << s.height << ", window " << text(w));
      const GBuffer part = cut(expected, inWide(w));
      rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g, w);
      REQUIRE(firstDifference(g, part) == "");
      renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, g, w);
      REQUIRE(firstDifference(g, part) == "");
      pixels += covered(part);
    }
  }
  CHECK(pixels > 100000);
}

TEST_CASE("window: threads, targets, tile sizes and skipping do not change a bit of it") {
  for (uint32_t seed : {2u, 4u, 7u, 25u}) {
    const TestScene s = sceneOfSeed(seed);
    const Window w{-5, s.height / 3, s.width / 2 + 5, s.height / 3 + kBorder};
    const GBuffer expected = cut(wide(s), inWide(w));
    CHECK(covered(expected) > 0);
    for (Target target : supportedTargets())
      for (int tile : {16, 32, 64})
        for (int threads : {1, 3})
          for (bool skip : {true, false}) {
            INFO("seed " << seed << ", " << targetName(target) << ", tile " << tile << ", " << threads << " threads, skip " << skip);
            GBuffer g;
            Rasterizer({threads, target, tile, skip}).render(s.list(), s.camera, s.width, s.height, kAllPlanes, g, w);
            REQUIRE(firstDifference(g, expected) == "");
          }
  }
}

TEST_CASE("window: what lies outside of it is culled, and what lies in it is not") {
  // A wall of 64 x 64 quads across the image, 8 x 8 after 8 x 8 so that clusters are compact; a window sees a sixteenth.
  TestScene s;
  s.materials.resize(1);
  TestMesh& m = s.addMesh();
  for (int i = 0; i < 64 * 64; ++i) {
    const int x = (i & 7) + 8 * (i >> 6 & 7), y = (i >> 3 & 7) + 8 * (i >> 9);
    const float l = float(x) / 32 - 1, b = float(y) / 32 - 1, d = 1.0f / 32;
    TestScene::addQuad(m, {l, b, 0}, {l + d, b, 0}, {l + d, b + d, 0}, {l, b + d, 0});
  }
  s.place(m);
  s.width = s.height = 256;
  for (bool perspectiveView : {true, false}) {
    s.camera = perspectiveView ? perspective(1, 1, 0.1) : orthographic(1, 1, 0.1, 10);
    if (perspectiveView) s.camera.xScale = s.camera.yScale = 4;
    s.camera.viewFromWorld = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
    for (const Window& w : {Window{0, 0, 64, 64}, Window{192, 0, 64, 64}, Window{64, 128, 64, 64}, Window{192, 192, 64, 64}}) {
      INFO(text(w) << (perspectiveView ? ", perspective" : ", orthographic"));
      Rasterizer rasterizer;
      GBuffer g;
      rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g, w);
      CHECK(covered(g) == 64 * 64);
      const Statistics& q = rasterizer.statistics();
      CHECK(q.trianglesCulled > q.triangles / 2);
      rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g, Window{-800, w.y, 64, 64});
      CHECK(rasterizer.statistics().instancesCulled == 1);
      CHECK(covered(g) == 0);
    }
  }
}

TEST_CASE("window: the guard band is its limit, and one beyond is refused by name") {
  TestScene s = sceneOf({{-20, -20, -1}, {20, -20, -1}, {0, 20, -1}});
  GBuffer g;
  Rasterizer rasterizer;
  PlaneSet depth;
  depth.depth = true;
  const auto render = [&](int width, int height, const Window& w) {
    rasterizer.render(s.list(), s.camera, width, height, depth, g, w);
  };
  render(kMaxImageSize, 40, {0, -8172, 1, kMaxImageSize});
  CHECK(g.height == kMaxImageSize);
  CHECK_THROWS_WITH(render(kMaxImageSize, 40, {-1, 0, 1, 1}), Catch::Contains("at -1, 0 of an image of 16384 x 40"));
  CHECK_THROWS_WITH(render(kMaxImageSize, 40, {0, 0, 16385, 1}), Catch::Contains("8192 pixels from the image's centre"));
  CHECK_THROWS_WITH(render(40, 40, {0, -8173, 1, 1}), Catch::Contains("at 0, -8173"));
  CHECK_THROWS_WITH(render(40, 40, {0, 8211, 1, 2}), Catch::Contains("at 0, 8211"));
  CHECK_THROWS_WITH(render(40, 40, {0, 0, 0, 4}), Catch::Contains("0 x 4"));
  CHECK_THROWS_WITH(render(40, 40, {0, 0, 4, -4}), Catch::Contains("4 x -4"));
  CHECK_THROWS_WITH(render(41, 40, {2147483647, 0, 2147483647, 1}), Catch::Contains("2147483647"));
  CHECK_THROWS_WITH(renderReference(s.list(), s.camera, 40, 40, depth, g, Window{9999, 0, 1, 1}), Catch::Contains("9999"));
}
