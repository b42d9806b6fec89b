// Height maps: relief mapping below the triangles.
#include <catch2/catch.hpp>

#include <cmath>
#include <stdexcept>

#include <glm/gtc/matrix_transform.hpp>

#include "obscura/raster/relief.h"
#include "raster_checks.h"

using namespace obscura::raster;
using namespace obscura::tests;

namespace {

// A square of two triangles, 2 x 2 around the origin at y = 0, with everything on: textures, colours, smooth normals.
TestScene squareScene(std::vector<float> heights, int width, int height, float scale) {
  TestScene s;
  s.heights = std::move(heights);
  s.heightViews = {{s.heights, width, height, Wrap::Repeat, Wrap::MirroredRepeat}};
  s.texels.push_back({0xFF2040FFu, 0xFF80FF20u, 0xFFFF8040u, 0xFF404040u});
  TextureView t;
  t.texels = s.texels[0];
  t.width = t.height = 2;
  s.textures.push_back(t);
  s.materials.resize(1);
  Material& m = s.materials[0];
  m.baseColorMap.texture = m.emissiveMap.texture = m.metallicRoughnessMap.texture = 0;
  m.emissive = {1, 2, 3};
  m.heightMap.texture = 0;
  m.heightScale = scale;
  TestMesh& mesh = s.addMesh();
  TestScene::addQuad(mesh, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  s.place(mesh);
  s.width = 71, s.height = 49;
  s.camera = perspective(0.6, 71.0 / 49, 0.1);
  s.camera.viewFromWorld = lookAt({0.4, 1.7, 3}, {0, 0, 0}, {0, 1, 0});
  return s;
}

std::vector<float> noise(int count, uint32_t seed) {
  Random random(seed);
  std::vector<float> h;
  for (int i = 0; i < count; ++i) h.push_back(random.real(0, 1));
  return h;
}

constexpr PlaneSet kWithRelief{true, true, true, true, true, true, true, true, true, true, 0.01f, true, true, true};

std::string differenceOfRelief(const GBuffer& a, const GBuffer& b) {
  std::string d = firstDifference(a, b);
  if (d.empty()) d = firstDifference("heightMap", a.heightMap, b.heightMap);
  for (int k = 0; k < 12 && d.empty(); ++k) d = firstDifference("relief", a.relief[k], b.relief[k]);
  return d;
}

double yOf(const TestScene& s, const GBuffer& g, int x, int y) {
  const glm::dmat4 worldFromView = glm::inverse(s.camera.viewFromWorld);
  return (worldFromView * glm::dvec4(g.position[0].at(x, y), g.position[1].at(x, y), g.position[2].at(x, y), 1)).y;
}

}  // namespace

TEST_CASE("relief: displaced surfaces have the bits of their scalar twin on every target, tile and thread count") {
  for (uint32_t seed = 0; seed < 4; ++seed) {
    TestScene s = squareScene(noise(15 * 9, seed), 15, 9, 0.15f);
    if (seed == 1) s.camera = orthographic(1.6, 1.1, 0, 10), s.camera.viewFromWorld = lookAt({0.4, 1.7, 3}, {0, 0, 0}, {0, 1, 0});
    if (seed == 2) {
      s.materials[0].doubleSided = true;  // from below
      s.camera.viewFromWorld = lookAt({0.4, -1, 2}, {0, 0, 0}, {0, 1, 0});
      glm::dmat4 m = glm::rotate(glm::dmat4(1), 0.3, glm::dvec3(1, 2, 0));
      m[0] *= -1.3;
      s.instances[0].worldFromObject = m;
    }
    if (seed == 3) s.camera.viewFromWorld = lookAt({0.2, 0.02, 1.5}, {0, 0, 0}, {0, 1, 0});  // at a grazing angle
    ImplicitSurface ball;
    ball.radius = 0.3;
    s.implicits = {ball};
    INFO("seed " << seed);
    GBuffer expected;
    renderReference(s.list(), s.camera, s.width, s.height, kWithRelief, expected);
    REQUIRE(covered(expected) > 100);
    checkAgainstReference(s);
    for (Target target : supportedTargets())
      for (int tile : {16, 64}) {
        INFO(targetName(target) << ", tiles of " << tile);
        REQUIRE(differenceOfRelief(render(s, {tile == 16 ? 1 : 3, target, tile, tile == 64}, nullptr, kWithRelief), expected) == "");
      }
    Rasterizer rasterizer;
    GBuffer part, cut;
    rasterizer.render(s.list(), s.camera, s.width, s.height, kWithRelief, part, Window{19, 13, 33, 30});
    cutOut(expected, {19, 13, 33, 30}, cut);
    REQUIRE(differenceOfRelief(part, cut) == "");
  }
}

TEST_CASE("relief: a map of one height moves the plane down by what is missing to 1, and covers the same pixels") {
  for (const float h : {1.0f, 0.75f, 0.0f}) {
    const TestScene s = squareScene(std::vector<float>(12, h), 4, 3, 0.2f);
    TestScene flat = squareScene({1}, 1, 1, 0.2f);
    flat.materials[0].heightMap.texture = -1;
    const GBuffer g = render(s), f = render(flat);
    CHECK(firstDifference("triangle", g.triangle, f.triangle) == "");
    eachPixel(g, [&](int x, int y) {
      REQUIRE(yOf(s, g, x, y) == Approx(-0.2 * (1 - h)).margin(1e-3));
      REQUIRE(g.depth.at(x, y) >= f.depth.at(x, y));
      for (int c = 0; c < 3; ++c) REQUIRE(g.normal[c].at(x, y) == Approx(f.normal[c].at(x, y)).margin(1e-6));
    });
  }
}

TEST_CASE("relief: the point that is seen lies on the map, and what hides it does not") {
  std::vector<float> heights;
  for (int i = 0; i < 64; ++i) heights.push_back(0.5f + 0.5f * float(std::sin(i * 6.283185307 / 64)));
  const TestScene s = squareScene(heights, 64, 1, 0.3f);
  const GBuffer g = render(s, {}, nullptr, kWithRelief);
  int tilted = 0;
  eachPixel(g, [&](int x, int y) {
    const float u = g.relief[0].at(x, y), h = g.relief[2].at(x, y);
    REQUIRE(g.heightMap.at(x, y) == 0);
    REQUIRE(ref::heightAt(s.heightViews[0], u, g.relief[1].at(x, y)) == Approx(h).margin(2e-3));
    REQUIRE(yOf(s, g, x, y) == Approx(-0.3 * (1 - h)).margin(1e-4));
    const glm::dmat4 worldFromView = glm::inverse(s.camera.viewFromWorld);
    const glm::dvec4 n = worldFromView * glm::dvec4(g.normal[0].at(x, y), g.normal[1].at(x, y), g.normal[2].at(x, y), 0);
    // y = -0.3 (1 - h(u)), u = (x + 1) / 2: the slope is 0.3 h' / 2.
    const double slope = 0.3 * 0.5 * 0.5 * 6.283185307 * std::cos((u - 0.5 / 64) * 6.283185307);
    REQUIRE(-n.x / n.y == Approx(slope).margin(0.01));
    tilted += std::fabs(n.x) > 0.3;
  });
  CHECK(tilted > 100);
}

TEST_CASE("relief: what stands in a hollow is seen, what is below its ground is not, displaced or not, near clusters or far") {
  for (const float height : {0.0f, 0.25f, 0.5f, 1.0f}) {
    TestScene s = squareScene(std::vector<float>(4, height), 2, 2, 0.2f);
    TestMesh& plate = s.addMesh();
    TestScene::addQuad(plate, {-0.4f, -0.1f, 0.4f}, {0.4f, -0.1f, 0.4f}, {0.4f, -0.1f, -0.4f}, {-0.4f, -0.1f, -0.4f});
    s.materials.emplace_back();
    s.place(plate, 1);
    checkAgainstReference(s);
    const GBuffer g = render(s);
    int seen = 0;
    eachPixel(g, [&](int x, int y) { seen += g.material.at(x, y) == 1; });
    if (height < 0.5f) CHECK(seen > 100);
    if (height > 0.5f) CHECK(seen == 0);
  }
}

TEST_CASE("relief: depths alone, and a frame that asks for no relief, know the displaced surface as well") {
  const TestScene s = squareScene(noise(64, 9), 8, 8, 0.2f);
  const GBuffer all = render(s);
  PlaneSet only;
  only.depth = true;
  CHECK(firstDifference("depth", render(s, {}, nullptr, only).depth, all.depth) == "");
}

TEST_CASE("relief: what cannot be is refused, what has no texture coordinates or no area stays flat") {
  TestScene s = squareScene({0, 1}, 2, 1, 0.2f);
  Rasterizer rasterizer;
  GBuffer g;
  const auto refused = [&] {
    CHECK_THROWS_AS(rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g), std::invalid_argument);
  };
  for (float bad : {-1.0f, kNan, kInfinity, 1e20f}) s.materials[0].heightScale = bad, refused();
  s.materials[0].heightScale = 0.2f;
  s.materials[0].heightMap.texture = 1, refused();
  s.materials[0].heightMap.texture = 0;
  s.heightViews[0].width = 3, refused();
  s.heightViews[0].width = 0, refused();
  s.heightViews[0].width = 2;

  for (int k = 0; k < 2; ++k) {
    TestScene odd = squareScene({0}, 1, 1, k == 0 ? 0 : 0.2f);
    odd.meshes[0].uvs.clear();
    odd.instances.clear();
    odd.place(odd.meshes[0]);
    const GBuffer flat = render(odd);
    eachPixel(flat, [&](int x, int y) { REQUIRE(yOf(odd, flat, x, y) == Approx(0).margin(1e-4)); });
    checkAgainstReference(odd);
  }
}

TEST_CASE("relief: whatever coordinates, heights and scales are, depths are finite, no nearer than the triangle, and the twin's") {
  const float kHuge = 3e38f;
  for (int k = 0; k < 12; ++k) {
    INFO("case " << k);
    TestScene s = squareScene(noise(6, 5), 3, 2, 0.2f);
    std::vector<glm::vec2>& uvs = s.meshes[0].uvs;
    Material& m = s.materials[0];
    if (k == 0) for (glm::vec2& uv : uvs) uv = {0.3f, 0.3f};
    if (k == 1) uvs[1] = {kNan, kInfinity};
    if (k == 2) uvs[2] = {kHuge, -kHuge};
    if (k == 3) for (glm::vec2& uv : uvs) uv *= 1e30f;
    if (k == 4) m.heightMap.uvFromUv = {kNan, 0, 0, 0, kInfinity, 0};
    if (k == 5) m.heightScale = 1e15f;
    if (k == 6) m.heightScale = 1e15f, s.instances[0].worldFromObject = glm::scale(glm::dmat4(1), glm::dvec3(1, 1e14, 1));
    if (k == 7) m.heightScale = 1e-42f;
    if (k == 8) s.meshes[0].positions[2] = s.meshes[0].positions[1], s.meshes[0].clusters = {}, s.instances.clear(), s.place(s.meshes[0]);
    if (k == 9) s.instances[0].worldFromObject = glm::scale(glm::dmat4(1), glm::dvec3(1, 0, 1));
    if (k == 10) s.camera.viewFromWorld = lookAt({0, 1e-5, 1.5}, {0, 0, 0}, {0, 1, 0});  // nearly along the plane
    if (k == 11) s.heights = {1e-40f, 1, 0, 0, 1, 0.5f}, s.heightViews[0].heights = s.heights;
    checkAgainstReference(s);
    const GBuffer g = render(s);
    m.heightMap.texture = -1;
    const GBuffer f = render(s);
    eachPixel(g, [&](int x, int y) {
      REQUIRE(std::isfinite(g.depth.at(x, y)));
      REQUIRE(g.depth.at(x, y) >= f.depth.at(x, y));
      for (int c = 0; c < 3; ++c) REQUIRE(std::isfinite(g.normal[c].at(x, y)));
    });
  }
}
