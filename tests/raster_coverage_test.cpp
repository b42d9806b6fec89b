// Coverage: every pixel of a mesh without holes exactly once.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "obscura/raster/clip.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

// Looks at the plane z = 0 straight from the front; 1 unit is `pixels` pixels, the origin is the image's centre.
Camera frontCamera(int width, int height, double pixels) {
  Camera c = orthographic(width / pixels / 2, height / pixels / 2, 0.1, 100);
  c.viewFromWorld = lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  return c;
}

// How often each pixel is covered when every triangle is drawn on its own.
std::vector<int> coverage(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices, const Camera& camera,
                          int width, int height, bool doubleSided = true) {
  std::vector<int> count(size_t(width) * size_t(height));
  Rasterizer rasterizer({1, Target::Auto, 64, true});
  for (size_t t = 0; t + 2 < indices.size(); t += 3) {
    TestScene s;
    s.materials.resize(1);
    s.materials[0].doubleSided = doubleSided;
    TestMesh& m = s.addMesh();
    m.positions = positions;
    m.indices = {indices[t], indices[t + 1], indices[t + 2]};
    s.place(m);
    GBuffer g;
    PlaneSet planes;
    planes.triangle = true;
    rasterizer.render(s.list(), camera, width, height, planes, g);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) count[size_t(y) * size_t(width) + size_t(x)] += g.triangle.at(x, y) == 0;
  }
  return count;
}

}  // namespace

TEST_CASE("coverage: a fan around any point covers every pixel of its square exactly once") {
  Random random(3);
  for (int round = 0; round < 12; ++round) {
    // On pixel centres, on pixel corners, and anywhere.
    const float snap = round % 3 == 0 ? 0.5f : round % 3 == 1 ? 1.f : 1.f / 256;
    auto snapped = [&](float v) { return std::floor(v / snap) * snap; };
    std::vector<glm::vec3> p{{snapped(random.real(-8, 8)), snapped(random.real(-8, 8)), 0}};
    std::vector<uint32_t> indices;
    const int spokes = random.integer(4, 9);
    for (int i = 0; i < 4 * spokes; ++i) {
      const float t = snapped(-16 + 32.f * float(i % spokes) / float(spokes));
      const glm::vec2 side[4] = {{t, -16}, {16, t}, {-t, 16}, {-16, -t}};
      p.push_back({side[i / spokes], 0});
    }
    for (uint32_t i = 1; i < p.size(); ++i) {
      indices.push_back(0);
      indices.push_back(i);
      indices.push_back(i + 1 < p.size() ? i + 1 : 1);
    }
    const int size = 40;
    const std::vector<int> count = coverage(p, indices, frontCamera(size, size, 1), size, size);
    INFO("round " << round);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const bool inside = x >= 4 && x < 36 && y >= 4 && y < 36;
        INFO("pixel " << x << ", " << y);
        REQUIRE(count[size_t(y * size + x)] == int(inside));
      }
  }
}

TEST_CASE("coverage: top and left edges belong to a triangle, bottom and right ones do not") {
  // Edges run exactly through pixel centres: (1.5, 1.5) to (4.5, 4.5) from the image's corner, 8 x 8 pixels.
  const std::vector<glm::vec3> p{{-2.5f, 2.5f, 0}, {0.5f, 2.5f, 0}, {0.5f, -0.5f, 0}, {-2.5f, -0.5f, 0}};
  const std::vector<int> count = coverage(p, {0, 1, 2, 0, 2, 3}, frontCamera(8, 8, 1), 8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      INFO("pixel " << x << ", " << y);
      CHECK(count[size_t(y * 8 + x)] == int(x >= 1 && x < 4 && y >= 1 && y < 4));
    }
}

TEST_CASE("coverage: a tessellated square with random w, cut by near and far planes and the guard band, has no hole or overlap") {
  Random random(11);
  for (int round = 0; round < 8; ++round) {
    const int n = 4, size = 48;
    std::vector<glm::vec3> p;
    std::vector<uint32_t> indices;
    const float spread = round < 4 ? 1.2f : 4000.f;  // the larger ones reach far out of the guard band
    // A height field over the view plane, partly before the near plane (z > -1): z is a function of the ray, so the
    // pieces meet exactly along their edges and cover each ray once.
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const float z = random.real(0.1f, 4);
        const float x = (float(i) / n * 2 - 1) * spread, y = (float(j) / n * 2 - 1) * spread;
        p.push_back({x * z, y * z, -z});
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const uint32_t a = uint32_t(j * (n + 1) + i), b = a + 1, c = b + n + 1, d = a + n + 1;
        for (uint32_t k : {a, b, c, a, c, d}) indices.push_back(k);
      }
    Camera camera = perspective(1.5, 1, round % 2 ? 1.0 : 0.05, round % 4 == 2 ? 3.0 : 0);
    const std::vector<int> count = coverage(p, indices, camera, size, size);
    const bool uncut = round % 2 == 0 && round % 4 != 2;
    for (size_t i = 0; i < count.size(); ++i) {
      INFO("round " << round << " pixel " << i % size << ", " << i / size);
      if (uncut) REQUIRE(count[i] == 1);
      else REQUIRE(count[i] <= 1);
    }
  }
}

TEST_CASE("clip: a shared edge is cut at the same bits from both sides") {
  Camera camera = perspective(1, 1, 0.5);
  const View view = makeView(camera, 100, 100);
  Random random(5);
  for (int round = 0; round < 200; ++round) {
    const glm::vec3 a = random.vector(-3, 3), b = random.vector(-3, 3);
    const glm::vec3 left[3] = {a, b, random.vector(-3, 3)}, right[3] = {b, a, random.vector(-3, 3)};
    glm::vec3 out[2][kMaxClipped];
    const int n[2] = {clipTriangle(view, left, out[0]), clipTriangle(view, right, out[1])};
    const bool crosses = (-a.z >= 0.5f) != (-b.z >= 0.5f);
    if (!crosses || n[0] == 0 || n[1] == 0) continue;
    // The cut point on a-b must occur, bit for bit, in both polygons.
    int common = 0;
    for (int i = 0; i < n[0]; ++i)
      for (int j = 0; j < n[1]; ++j)
        common += std::memcmp(&out[0][i], &out[1][j], sizeof(glm::vec3)) == 0 && out[0][i].z == -0.5f;
    CHECK(common >= 1);
  }
}

TEST_CASE("coverage: a closed sphere of tiny triangles shows no hole from inside or outside") {
  TestScene s;
  s.materials.resize(1);
  TestMesh& m = s.addMesh();
  const int rings = 90, segments = 180;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < segments; ++i) {
      const double theta = 3.14159265358979 * j / rings, phi = 6.28318530717959 * i / segments;
      m.positions.push_back({float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)), float(std::sin(theta) * std::sin(phi))});
    }
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < segments; ++i) {
      const uint32_t a = uint32_t(j * segments + i), b = uint32_t(j * segments + (i + 1) % segments), c = b + segments, d = a + segments;
      for (uint32_t k : {a, b, c, a, c, d}) m.indices.push_back(k);
    }
  s.place(m);
  s.width = s.height = 61;  // most triangles are smaller than a pixel
  s.camera = perspective(0.8, 1, 0.1);
  s.camera.viewFromWorld = lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0});
  Rasterizer rasterizer;
  GBuffer g;
  rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
  for (int y = 0; y < 61; ++y) {
    int runs = 0;
    for (int x = 1; x < 61; ++x) runs += (g.triangle.at(x, y) != kNoTriangle) != (g.triangle.at(x - 1, y) != kNoTriangle);
    INFO("row " << y);
    CHECK(runs <= 2);  // convex: one run of covered pixels a row
  }
  CHECK(g.triangle.at(30, 30) != kNoTriangle);
}

TEST_CASE("hostile: NaN, infinite, denormal, huge and degenerate vertices are dropped and counted, never undefined") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const float odd[] = {nan, inf, -inf, 1e-42f, 3e38f, -3e38f, 1e18f, 0.f, -0.f, 1e-30f};
  Random random(8);
  for (Target target : supportedTargets()) {
    TestScene s;
    s.materials.resize(1);
    s.materials[0].doubleSided = true;
    TestMesh& m = s.addMesh();
    for (int i = 0; i < 600; ++i) {
      glm::vec3 v = random.vector(-2, 2);
      if (i % 3 == 0) v[random.integer(0, 2)] = odd[size_t(i / 3) % std::size(odd)];
      m.indices.push_back(uint32_t(i));
      m.positions.push_back(v);
      m.normals.push_back(i % 7 ? random.vector(-1, 1) : glm::vec3(nan, inf, 0));
      m.uvs.push_back({i % 5 ? 0.5f : nan, inf});
    }
    for (uint32_t k : {5, 5, 5, 7, 8, 7}) m.indices.push_back(k);
    s.place(m);
    s.camera = perspective(1, 1.5, 0.01);
    s.camera.viewFromWorld = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
    s.width = 60, s.height = 40;
    Rasterizer rasterizer({1, target, 16, true});
    GBuffer g, expected;
    rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
    renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, expected);
    INFO(targetName(target));
    CHECK(firstDifference(g, expected) == "");
    CHECK(rasterizer.statistics().invalid > 0);
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x)
        for (int c = 0; c < 3; ++c) REQUIRE(std::isfinite(g.normal[c].at(x, y)));
  }
}

TEST_CASE("sizes: images of one pixel, and one off every tile size, are drawn like any other") {
  const TestScene base = soupScene(4);
  for (int size : {1, 2, 15, 16, 17, 31, 33, 63, 64, 65, 129}) {
    GBuffer expected;
    renderReference(base.list(), base.camera, size, 66 - size / 2, kAllPlanes, expected);
    for (int tile : {16, 32, 64}) {
      Rasterizer rasterizer({2, Target::Auto, tile, true});
      GBuffer g;
      rasterizer.render(base.list(), base.camera, size, 66 - size / 2, kAllPlanes, g);
      INFO("size " << size << " tile " << tile);
      CHECK(firstDifference(g, expected) == "");
    }
  }
}
