// What is hidden is skipped, and nothing that is seen.
#include <catch2/catch.hpp>

#include <cmath>

#include "raster_checks.h"

#include "obscura/raster/cull.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/view.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

// A bumpy ball of 2 n^2 triangles.
TestMesh& addBall(TestScene& s, int n, Random& random) {
  TestMesh& m = s.addMesh();
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      // Around the axis by a rational circle, so that no libm is needed.
      const float t = 4 * float(i % n) / float(n), u = t - std::floor(t), c = (1 - u * u) / (1 + u * u), d = 2 * u / (1 + u * u);
      const int quarter = int(t);
      const float x = quarter == 0 ? c : quarter == 1 ? -d : quarter == 2 ? -c : d, z = quarter == 0 ? d : quarter == 1 ? c : quarter == 2 ? -d : -c;
      const float h = 2 * float(j) / float(n) - 1, r = std::sqrt(1 - h * h) * random.real(0.95f, 1.05f);
      m.positions.push_back({x * r, h, z * r});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const uint32_t a = uint32_t(j * (n + 1) + i), b = a + 1, e = a + uint32_t(n) + 1, f = e + 1;
      m.indices.insert(m.indices.end(), {a, e, f, a, f, b});
    }
  return m;
}

// A crowd: balls in rows one behind the other, some twice in the same place, some around the eye, a wall in front of a
// part of them, one with holes and two that are displaced.
TestScene crowd(bool perspectiveView) {
  TestScene s;
  Random random(11);
  s.materials.resize(4);
  s.materials[1].doubleSided = true;
  s.materials[2].alphaMode = AlphaMode::Mask;
  s.materials[2].alphaCutoff = 0.5f;
  s.heights = {0.1f, 0.7f, 0.4f, 1};
  s.heightViews = {{s.heights, 2, 2}};
  s.materials[3].heightMap.texture = 0;
  s.materials[3].heightScale = 0.4f;
  s.width = 157, s.height = 93;
  s.camera = perspectiveView ? perspective(0.9, 157.0 / 93, 0.1) : orthographic(8, 5, 0.1, 100);
  TestMesh& ball = addBall(s, 24, random);
  s.place(ball);
  TestMesh& wall = s.addMesh();
  TestScene::addQuad(wall, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  for (glm::vec3 p : wall.positions) wall.colors.push_back({1, 1, 1, p.x * p.y > 0 ? 1.0f : 0.0f});
  for (glm::vec3 p : wall.positions) wall.uvs.push_back({2 * p.x, 2 * p.y});
  s.place(wall);
  const auto put = [&](TestMesh& mesh, uint32_t material, glm::dvec3 at, double scale) {
    glm::dmat4 m(scale);
    m[3] = glm::dvec4(at, 1);
    s.instances.push_back({&mesh.view, material, m});
  };
  s.instances.clear();
  for (int row = 0; row < 9; ++row)
    for (int k = 0; k < 9; ++k) put(ball, uint32_t(k % 2), {(k - 4) * 1.7 + random.real(-0.3f, 0.3f), random.real(-1, 1), -6 - 2.5 * row}, 1.2);
  for (int k = 0; k < 3; ++k) s.instances.push_back(s.instances[size_t(k) * 20 + 5]);
  put(ball, 0, {0.1, 0, 0.05}, 1.0);
  put(wall, 1, {-3, 0, -5}, 1.8);
  put(wall, 2, {2, 0, -4.5}, 1.5);
  put(wall, 3, {-1, 0.5, -5.5}, 2);  // displaced, among the balls, partly hidden and hiding
  put(wall, 3, {3, -0.5, -9}, 2.5);
  for (int k = 0; k < 110; ++k) put(wall, 1, {0, 0, -40 - 0.1 * k}, 40);  // so deep that it is drawn in rounds
  return s;
}

}  // namespace

TEST_CASE("occlusion: a crowd drawn front to back has the bits of the reference, whatever threads, target, tile and skipping") {
  raster::withThreads(8, [] {
    for (bool perspectiveView : {true, false}) {
      const TestScene s = crowd(perspectiveView);
      GBuffer expected;
      renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, expected);
      std::string counts;
      for (Target target : supportedTargets())
        for (int tile : {16, 32, 64})
          for (int count : {1, 3})
            for (bool skip : {true, false}) {
              if (!skip && (tile != 32 || count != 3)) continue;  // drawn whole, it takes the longest and is no other crowd
              INFO(targetName(target) << " tile " << tile << " threads " << count << " skip " << skip);
              Statistics q;
              REQUIRE(firstDifference(render(s, {count, target, tile, skip}, &q), expected) == "");
              CHECK(q.trianglesCulled + q.facingAway + q.outside + q.hidden + q.invalid + q.drawn == q.triangles);
              if (!skip) {
                CHECK(q.clustersHidden + q.instancesHidden + q.hidden == 0);
                continue;
              }
              CHECK(q.clustersHidden > 100);
              CHECK(q.hidden > 30);
              // What was skipped is the same for all, too.
              const std::string found = std::to_string(q.clustersHidden) + " " + std::to_string(q.instancesHidden) + " " + std::to_string(q.hidden) + " " +
                                        std::to_string(q.drawn);
              if (counts.empty()) counts = found;
              CHECK(found == counts);
            }
    }
  });
}

TEST_CASE("occlusion: a renderer that drew a crowd forgets it") {
  const TestScene full = crowd(true);
  TestScene empty = crowd(true);
  for (Instance& i : empty.instances) i.worldFromObject[3].z = 1000;
  Rasterizer rasterizer(Settings{2, Target::Auto, 32, true});
  GBuffer g, expected;
  rasterizer.render(full.list(), full.camera, full.width, full.height, kAllPlanes, g);
  CHECK(covered(g) > 1000);
  rasterizer.render(empty.list(), empty.camera, empty.width, empty.height, kAllPlanes, g);
  renderReference(empty.list(), empty.camera, empty.width, empty.height, kAllPlanes, expected);
  CHECK(firstDifference(g, expected) == "");
}

TEST_CASE("occlusion: a map hides what lies behind all of its box, and nothing else") {
  for (Target target : supportedTargets()) {
    TileMemory memory;
    memory.reserve(1, 6);
    const TileGrid grid(61, 50, 6);
    TileBuffers tile = placeTile(grid, 0, memory, 0);
    clearTile(Keep::Key, tile, target);
    for (int y = 0; y < 52; ++y)  // whole blocks, as triangles across the image's border fill them
      for (int x = 0; x < 64; ++x) tile.key[tile.at(x, y)] = 2;
    tile.key[tile.at(37, 41)] = 1;
    OcclusionMap map;
    map.reset(61, 50);
    CHECK_FALSE(map.hides({0, 0, 60, 49, -1e30f}));
    map.update(tile, target);
    CHECK(map.hides({0, 0, 31, 49, 1.5f}));
    CHECK(map.hides({40, 0, 55, 49, 1.5f}));
    CHECK_FALSE(map.hides({0, 0, 31, 49, 2}));  // as near: the smaller id may win
    CHECK_FALSE(map.hides({30, 40, 36, 41, 1.5f}));  // the block with the hole
    CHECK(map.hides({30, 40, 35, 41, 1.5f}));
    CHECK(map.hides({0, 0, 40, 49, 0.5f}));
  }
}

TEST_CASE("occlusion: no vertex in a sphere is seen outside of its bound") {
  Random random(3);
  for (int k = 0; k < 20000; ++k) {
    const bool perspectiveView = k % 3 != 0;
    Camera camera = perspectiveView ? perspective(random.real(0.1f, 2.5f), 1.3, 0.01) : orthographic(random.real(0.1f, 20), random.real(0.1f, 20), 0.01, 1e6);
    camera.xShift = random.real(-1, 1);
    const View view = makeView(camera, 640, 480);
    TestScene s;
    s.materials.resize(1);
    s.place(addBall(s, 1, random));
    glm::dmat4& m = s.instances[0].worldFromObject;
    for (int c = 0; c < 3; ++c) m[c] = glm::dvec4(random.vector(-2, 2), 0);
    m[3] = glm::dvec4(random.vector(-20, 20), 1);
    const std::vector<Draw> draws = makeDraws(s.list(), camera);
    const glm::vec3 center = random.vector(-5, 5);
    const float radius = random.real(0, 2);
    const ScreenBound bound = screenBound(view, viewSphere(draws[0], center, radius));
    for (int i = 0; i < 8; ++i) {
      glm::vec3 p = random.vector(-1, 1);
      p = center + p * (radius / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) * (i < 4 ? 1.0f : random.real(0, 1)));
      TransformedVertices v;
      const float x[16] = {p.x}, y[16] = {p.y}, z[16] = {p.z};
      transformVerticesRef(view, draws[0], x, y, z, 1, v);
      if (v.code[0] & kNeedsClip) continue;
      INFO("case " << k << " vertex " << i);
      REQUIRE(v.key[0] <= bound.nearestKey);
      const int px = (v.xSub[0] - view.xFirstSub) >> kSubBits, py = (v.ySub[0] - view.yFirstSub) >> kSubBits;
      if (px < 0 || py < 0 || px >= 640 || py >= 480) continue;
      REQUIRE((px >= bound.x0 && px <= bound.x1 && py >= bound.y0 && py <= bound.y1));
    }
  }
}
