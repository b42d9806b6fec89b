// Whole G-buffers: one set of bits, whatever computes them.
#include <catch2/catch.hpp>

#include <cfenv>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <glm/geometric.hpp>

#include "obscura/raster/parallel.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

GBuffer renderWith(const TestScene& s, const Settings& settings, const PlaneSet& planes = kAllPlanes) {
  Rasterizer rasterizer(settings);
  GBuffer g;
  rasterizer.render(s.list(), s.camera, s.width, s.height, planes, g);
  return g;
}

GBuffer reference(const TestScene& s) {
  GBuffer g;
  renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
  return g;
}

int covered(const GBuffer& g) {
  int n = 0;
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) n += g.triangle.at(x, y) != kNoTriangle;
  return n;
}

}  // namespace

TEST_CASE("frame: threads, targets, tile sizes and skipping do not change a bit") {
  raster::withThreads(8, [] {
    for (uint32_t seed : {2u, 4u, 7u, 15u, 25u}) {
      const TestScene s = soupScene(seed);
      const GBuffer expected = reference(s);
      CHECK(covered(expected) > 0);
      for (Target target : supportedTargets())
        for (int tile : {16, 32, 64})
          for (int count : {1, 2, 3, 8})
            for (bool skip : {true, false}) {
              INFO("seed " << seed << " target " << targetName(target) << " tile " << tile << " threads " << count << " skip " << skip);
              REQUIRE(firstDifference(renderWith(s, {count, target, tile, skip}), expected) == "");
            }
    }
  });
}

TEST_CASE("frame: every kernel equals its scalar twin on random scenes") {
  int pixels = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    const TestScene s = soupScene(seed);
    const GBuffer expected = reference(s);
    pixels += covered(expected);
    for (Target target : supportedTargets()) {
      INFO("seed " << seed << " target " << targetName(target) << " size " << s.width << "x" << s.height);
      REQUIRE(firstDifference(renderWith(s, {1, target, 64, true}), expected) == "");
    }
  }
  CHECK(pixels > 100000);
}

TEST_CASE("frame: a renderer that is used again forgets the frame before") {
  Rasterizer rasterizer;
  GBuffer g;
  for (uint32_t seed : {7u, 4u, 25u, 7u}) {
    const TestScene s = soupScene(seed);
    rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
    CHECK(firstDifference(g, reference(s)) == "");
  }
}

TEST_CASE("frame: the planes that are asked for do not depend on what else is asked for") {
  const TestScene s = soupScene(10);
  const GBuffer all = renderWith(s, {});
  PlaneSet only;
  only.normal = true;
  const GBuffer some = renderWith(s, {}, only);
  CHECK(some.depth.empty());
  CHECK(some.triangle.empty());
  for (int c = 0; c < 3; ++c) CHECK(firstDifference("normal", some.normal[c], all.normal[c]) == "");
}

TEST_CASE("frame: metallic and roughness are the factors times blue and green of their texture, and of what is unlit 0 and 1") {
  TestScene s;
  s.texels.push_back({0xFF3366CCu});  // blue 51, green 102, red 204
  TextureView t;
  t.texels = s.texels[0];
  t.width = t.height = 1;
  s.textures.push_back(t);
  s.materials.resize(3);
  for (Material& m : s.materials) m.metallic = 0.5f, m.roughness = 0.75f;
  s.materials[1].metallicRoughnessMap.texture = s.materials[2].metallicRoughnessMap.texture = 0;
  s.materials[2].unlit = true;
  for (int k = 0; k < 3; ++k) {  // one above the other
    TestMesh& m = s.addMesh();
    const float y = float(k - 1);
    TestScene::addQuad(m, {-1, y - 0.4f, 0}, {1, y - 0.4f, 0}, {1, y + 0.4f, 0}, {-1, y + 0.4f, 0});
    s.place(m, uint32_t(k));
  }
  s.camera = perspective(0.7, 4.0 / 3, 0.1);
  s.camera.viewFromWorld = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
  const GBuffer g = renderWith(s, {});
  const float metallic[] = {0.5f, 0.5f * (51 / 255.0f), 0}, roughness[] = {0.75f, 0.75f * (102 / 255.0f), 1};
  int seen[3] = {};
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      const uint32_t k = g.material.at(x, y);
      REQUIRE(g.metallic.at(x, y) == (k < 3 ? metallic[k] : 0));
      REQUIRE(g.roughness.at(x, y) == (k < 3 ? roughness[k] : 0));
      if (k < 3) ++seen[k];
    }
  for (int count : seen) CHECK(count > 100);

  PlaneSet only;
  only.roughness = true;
  const GBuffer some = renderWith(s, {}, only);
  CHECK((some.metallic.empty() && some.depth.empty()));
  CHECK(firstDifference("roughness", some.roughness, g.roughness) == "");
}

TEST_CASE("frame: a host's rounding mode and flush-to-zero do not reach the pixels, and are given back") {
  const TestScene s = soupScene(4);
  const GBuffer expected = renderWith(s, {});
  std::fesetround(FE_UPWARD);
#if defined(__SSE__)
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040);  // flush to zero, denormals are zero
#endif
  GBuffer g = renderWith(s, {2, Target::Auto, 64, true});
  const int mode = std::fegetround();
#if defined(__SSE__)
  CHECK((_mm_getcsr() & 0x8040) == 0x8040);
  _mm_setcsr(before);
#endif
  std::fesetround(FE_TONEAREST);
  CHECK(mode == FE_UPWARD);
  CHECK(firstDifference(g, expected) == "");
}

TEST_CASE("frame: clusters, or none, or another order of them, give the same bits") {
  TestScene with = soupScene(4);
  const GBuffer expected = renderWith(with, {});
  TestMesh& m = with.meshes[0];
  m.view.clusters = nullptr;
  CHECK(firstDifference(renderWith(with, {}), expected) == "");
  std::vector<uint32_t> order;
  for (uint32_t t = m.view.triangleCount(); t-- > 0;) order.push_back(t);
  std::vector<uint32_t> counts(order.size() / 7, 7);
  m.clusters = buildClusters(m.positions, m.indices, order, counts);
  m.view.clusters = &m.clusters;
  CHECK(firstDifference(renderWith(with, {}), expected) == "");
}

TEST_CASE("frame: on equal depth the smaller id is seen, in whatever order they are drawn") {
  TestScene s;
  s.materials.resize(2);
  TestMesh& m = s.addMesh();
  TestScene::addQuad(m, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  s.place(m, 1);
  s.place(m, 0);
  s.camera = perspective(0.7, 4.0 / 3, 0.1);
  s.camera.viewFromWorld = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
  const GBuffer g = renderWith(s, {});
  CHECK(covered(g) > 500);
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if (g.triangle.at(x, y) != kNoTriangle) REQUIRE(g.instance.at(x, y) == 0);
}

TEST_CASE("frame: the comparison notices one bit in one pixel, and says where") {
  const TestScene s = soupScene(5);
  const GBuffer a = renderWith(s, {});
  GBuffer b = renderWith(s, {});
  REQUIRE(firstDifference(a, b) == "");
  uint32_t bits;
  std::memcpy(&bits, &b.normal[1].at(s.width / 2, s.height / 2), 4);
  bits ^= 1;
  std::memcpy(&b.normal[1].at(s.width / 2, s.height / 2), &bits, 4);
  CHECK(firstDifference(a, b).find("normal differs at (" + std::to_string(s.width / 2)) == 0);
}

TEST_CASE("frame: statistics account for every triangle") {
  for (uint32_t seed = 0; seed < 24; ++seed) {
    const TestScene s = soupScene(seed);
    for (bool skip : {true, false}) {
      Rasterizer rasterizer({1, Target::Auto, 64, skip});
      GBuffer g;
      rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
      const Statistics& q = rasterizer.statistics();
      INFO("seed " << seed);
      CHECK(q.triangles == 3 * s.meshes[0].view.triangleCount());
      CHECK(q.trianglesCulled + q.facingAway + q.outside + q.hidden + q.invalid + q.drawn == q.triangles);
      if (!skip) CHECK(q.trianglesCulled == 0);
    }
  }
}

TEST_CASE("frame: misuse is refused and names the value") {
  TestScene s = soupScene(4);
  GBuffer g;
  Rasterizer rasterizer;
  auto render = [&](int w, int h) { rasterizer.render(s.list(), s.camera, w, h, kAllPlanes, g); };
  CHECK_THROWS_WITH(render(0, 5), Catch::Contains("0 x 5"));
  CHECK_THROWS_WITH(render(20000, 5), Catch::Contains("20000"));
  CHECK_THROWS_WITH(Rasterizer(Settings{1, Target::Auto, 48, true}), Catch::Contains("48"));
  s.instances[0].material = 77;
  CHECK_THROWS_WITH(render(8, 8), Catch::Contains("77"));
  s.instances[0].material = 0;
  TestMesh& mesh = s.meshes[0];
  mesh.view.clusters = nullptr;
  const uint32_t kept = std::exchange(mesh.indices[7], 123456789u);
  CHECK_THROWS_WITH(render(8, 8), Catch::Contains("123456789"));
  mesh.indices[7] = kept;
  s.camera.zNear = -1;
  CHECK_THROWS_WITH(render(8, 8), Catch::Contains("zNear"));
}

TEST_CASE("frame: facet is the normal of the triangle's plane, whatever normals its vertices have") {
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  TestMesh& mesh = s.addMesh();
  TestScene::addQuad(mesh, {-1, -1, 0.5f}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0.5f});
  mesh.normals = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}};
  s.place(mesh);
  s.camera = perspective(0.8, 1, 0.1);
  s.camera.viewFromWorld = lookAt({1, 2, 3}, {0, 0, 0}, {0, 1, 0});
  const GBuffer g = reference(s);
  const glm::dvec3 expected = glm::dmat3(s.camera.viewFromWorld) * glm::normalize(glm::dvec3(0.25, 0, 1));
  int seen = 0, wrong = 0;
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      if (g.triangle.at(x, y) == kNoTriangle) continue;
      ++seen;
      const glm::dvec3 found(g.facet[0].at(x, y), g.facet[1].at(x, y), g.facet[2].at(x, y));
      wrong += !(glm::dot(found, expected) > 1 - 1e-6);
    }
  CHECK(seen > 100);
  CHECK(wrong == 0);
}
