// Depth alone, and the layers behind the first: known answers, and one set of bits, whatever computes them.
#include <catch2/catch.hpp>

#include <algorithm>

#include "obscura/raster/parallel.h"
#include "raster_checks.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

GBuffer referenceOf(const TestScene& s, const PlaneSet& planes) {
  GBuffer g;
  renderReference(s.list(), s.camera, s.width, s.height, planes, g);
  return g;
}

// By the rasterizer, after a look whether the reference says the same.
GBuffer layers(const TestScene& s, float separation) {
  PlaneSet planes = kAllLayers;
  planes.separation = separation;
  GBuffer g = render(s, {}, nullptr, planes);
  CHECK(firstDifference(g, referenceOf(s, planes)) == "");
  return g;
}

// Facing the eye, which is at the origin and looks along -z, at the distance z.
void addWall(TestScene& s, float half, float z, uint32_t material = 0) {
  TestMesh& m = s.addMesh();
  TestScene::addQuad(m, {-half, -half, -z}, {half, -half, -z}, {half, half, -z}, {-half, half, -z});
  m.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  s.place(m, material);
}

TestScene emptyScene() {
  TestScene s;
  s.materials.resize(1);
  s.width = 41, s.height = 41;  // the middle pixel looks along the axis
  s.camera = perspective(1.0, 1.0, 0.01);
  return s;
}

// Closed, its outside out.
void addBox(TestScene& s, glm::vec3 center, float half, bool mirrored = false) {
  TestMesh& m = s.addMesh();
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-half, half}) {
      glm::vec3 n(0), u(0), v(0);
      n[axis] = side;
      u[(axis + 1) % 3] = side;  // u x v points along n, whichever its sign
      v[(axis + 2) % 3] = half;
      TestScene::addQuad(m, n - u - v, n + u - v, n + u + v, n - u + v);
    }
  glm::dmat4 place(1);
  if (mirrored) place[0][0] = -1;
  place[3] = glm::dvec4(glm::dvec3(center), 1);
  s.place(m, 0, place);
}

// A texture of `size` x `size` cells, every other one a hole, and material 1 that shows it.
void addLeafMaterial(TestScene& s, int size) {
  s.texels.emplace_back();
  for (int i = 0; i < size * size; ++i) s.texels[0].push_back((i % size + i / size) % 2 ? 0xFFFFFFFFu : 0x00FFFFFFu);
  TextureView t;
  t.texels = s.texels[0];
  t.width = t.height = size;
  t.magFilter = t.minFilter = Filter::Nearest;
  t.mip = MipFilter::None;
  s.textures.push_back(t);
  s.materials.resize(2);
  s.materials[1].alphaMode = AlphaMode::Mask;
  s.materials[1].baseColorMap.texture = 0;
}

}  // namespace

TEST_CASE("layers: behind the first of parallel walls comes the next that is at least the separation behind it") {
  TestScene s = emptyScene();
  addWall(s, 1, 4);
  addWall(s, 0.5f, 2);
  addWall(s, 0.6f, 2.5f);
  addWall(s, 4, 8);
  const auto second = [&](float separation, int x, int y) { return layers(s, separation).depth2.at(x, y); };
  CHECK(second(0.25f, 20, 20) == 2.5f);
  CHECK(second(0.75f, 20, 20) == 4);
  CHECK(second(2, 20, 20) == 4);  // just as far
  CHECK(second(2.0001f, 20, 20) == 8);
  CHECK(second(6, 20, 20) == 8);
  CHECK(second(6.001f, 20, 20) == kInfinity);
  CHECK(second(3e38f, 20, 20) == kInfinity);
  const GBuffer g = layers(s, 0.75f);
  CHECK(g.depth.at(2, 20) == 8);  // nothing in front there, and nothing behind
  CHECK(g.depth2.at(2, 20) == kInfinity);
}

TEST_CASE("layers: walls in an orthographic view, from distance 0 on") {
  TestScene s = emptyScene();
  s.camera = orthographic(1, 1, 0, 100);
  addWall(s, 0.5f, 0);
  addWall(s, 0.5f, 3);
  CHECK(layers(s, 1).depth.at(20, 20) == 0);
  CHECK(layers(s, 1).depth2.at(20, 20) == 3);
  CHECK(layers(s, 1e-40f).depth2.at(20, 20) == 3);
  CHECK(layers(s, 3.5f).depth2.at(20, 20) == kInfinity);
}

TEST_CASE("layers: no surface is its own second layer, however small the separation") {
  for (uint32_t seed = 0; seed < 24; ++seed) {
    const TestScene s = soupScene(seed);
    for (float separation : {1e-45f, 1e-7f}) {
      PlaneSet planes = kDepths;
      planes.separation = separation;
      const GBuffer g = render(s, {}, nullptr, planes);
      INFO("seed " << seed);
      for (int y = 0; y < g.height; ++y)
        for (int x = 0; x < g.width; ++x)
          if (g.depth.at(x, y) < kInfinity) REQUIRE(g.depth2.at(x, y) > g.depth.at(x, y));
          else REQUIRE(g.depth2.at(x, y) == kInfinity);
    }
  }
  TestScene s = emptyScene();  // at the end of what floats can tell apart
  s.camera = perspective(1.0, 1.0, 1e-30);
  addWall(s, 1e38f, 3e38f);
  CHECK(layers(s, 1e-45f).depth.at(20, 20) < kInfinity);
  CHECK(layers(s, 1e-45f).depth2.at(20, 20) == kInfinity);
}

TEST_CASE("layers: a closed box ends at its back wall, seen from outside and from inside") {
  for (bool mirrored : {false, true}) {
    TestScene s = emptyScene();
    addBox(s, {0, 0, -4}, 1, mirrored);
    GBuffer g = layers(s, 0.5f);
    CHECK(g.depth.at(20, 20) == 3);
    CHECK(g.depthBack.at(20, 20) == 5);
    CHECK(g.depth2.at(20, 20) == kInfinity);  // back faces do not compete for it
    int seen = 0;
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) {
        // Where the ray leaves the box: at the back, or earlier through a side. The silhouette itself is left out.
        const float across = float(std::max(std::abs(x - 20), std::abs(y - 20))) / 20.5f * std::tan(0.5f);
        if (std::fabs(across - 1 / 3.f) < 0.02f) continue;
        const float expected = across > 1 / 3.f ? kInfinity : across * 5 < 1 ? 5 : 1 / across;
        INFO(x << ", " << y);
        REQUIRE((g.depthBack.at(x, y) == expected || std::fabs(g.depthBack.at(x, y) - expected) < 0.02f));
        seen += expected < kInfinity;
      }
    CHECK(seen > 300);

    TestScene inside = emptyScene();
    addBox(inside, {0, 0, 0}, 2, mirrored);
    addBox(inside, {0, 0, -1}, 0.25f, mirrored);
    g = layers(inside, 0.5f);
    CHECK(g.depth.at(20, 20) == 0.75f);
    CHECK(g.depthBack.at(20, 20) == 1.25f);  // of what is seen
    CHECK(g.depth.at(2, 2) == kInfinity);
    CHECK(g.depthBack.at(2, 2) == 2);  // of what the eye is in
  }
}

TEST_CASE("layers: clusters that face the eye are skipped for back faces, and no others") {
  TestScene s = emptyScene();
  TestMesh& m = s.addMesh();
  constexpr int kCells = 16;  // a side of each of a cube's faces, blown up to a ball; four rows are a cluster with a cone
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-1.f, 1.f})
      for (int row = 0; row < kCells; ++row)
        for (int column = 0; column < kCells; ++column) {
          const auto corner = [&](int du, int dv) {
            glm::vec3 p(0);
            p[axis] = side;
            p[(axis + 1) % 3] = side * (2 * float(column + du) / kCells - 1);
            p[(axis + 2) % 3] = 2 * float(row + dv) / kCells - 1;
            return p / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
          };
          TestScene::addQuad(m, corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
        }
  glm::dmat4 place(1);
  place[3] = {0, 0, -3, 1};
  s.place(m, 0, place);
  int cones = 0;
  for (const Cluster& c : m.clusters.clusters) cones += c.coneCos > 0.3f;
  CHECK(cones > 10);
  for (int turn = 0; turn < 4; ++turn) {  // the eye in front of it, beside it and in its middle
    s.camera.viewFromWorld = lookAt({turn == 1 ? 2 : 0, turn == 2 ? 2 : 0, turn == 3 ? -3 : 0}, {0, 0, -3.5}, {0, 1, 0});
    checkAgainstReference(s);
  }
  s.camera.viewFromWorld = glm::dmat4(1);
  const GBuffer g = layers(s, 0.1f);
  CHECK(g.depth.at(20, 20) == Approx(2).margin(0.01));
  CHECK(g.depthBack.at(20, 20) == Approx(4).margin(0.01));
  for (int y = 0; y < g.height; ++y)  // no hole: a ball ends wherever it begins
    for (int x = 0; x < g.width; ++x) CHECK((g.depth.at(x, y) < kInfinity) == (g.depthBack.at(x, y) < kInfinity));
}

TEST_CASE("layers: where a cluster is too wide for its planes to tell, back faces are found exactly") {
  TestScene s = emptyScene();
  addBox(s, {0, 0, -4}, 1);
  TestMesh& m = s.meshes[0];
  for (const glm::vec3& p : {glm::vec3(4e6f, 0, 0), glm::vec3(4e6f, 1, 0), glm::vec3(4e6f, 0, 1)}) {
    m.indices.push_back(uint32_t(m.positions.size()));
    m.positions.push_back(p);
  }
  const glm::dmat4 place = s.instances[0].worldFromObject;
  m.clusters = {};
  s.instances.clear();
  s.place(m, 0, place);
  CHECK(m.clusters.clusters[0].radius > 1e6f);
  const GBuffer g = layers(s, 0.5f);
  CHECK(g.depth.at(20, 20) == 3);
  CHECK(g.depthBack.at(20, 20) == 5);
}

TEST_CASE("layers: double-sided surfaces have no back, but a far side that is the second layer") {
  TestScene s = emptyScene();
  s.materials[0].doubleSided = true;
  addBox(s, {0, 0, -4}, 1);
  const GBuffer g = layers(s, 0.5f);
  CHECK(g.depth2.at(20, 20) == 5);
  CHECK(g.depthBack.at(20, 20) == kInfinity);
  s.materials.resize(2);
  addBox(s, {0, 0, -8}, 1);
  s.instances[1].material = 1;
  CHECK(layers(s, 0.5f).depthBack.at(20, 20) == 9);  // of a box behind it
}

TEST_CASE("layers: a leaf hides only where its texture covers, in front, behind and from behind") {
  TestScene s = emptyScene();
  addLeafMaterial(s, 2);
  addWall(s, 2, 4);
  addWall(s, 0.4f, 2, 1);
  GBuffer g = layers(s, 0.5f);
  const int leaf[2] = {23, 17}, hole[2] = {17, 17};
  CHECK(g.depth.at(leaf[0], leaf[1]) == 2);
  CHECK(g.depth2.at(leaf[0], leaf[1]) == 4);
  CHECK(g.depth.at(hole[0], hole[1]) == 4);
  CHECK(g.depth2.at(hole[0], hole[1]) == kInfinity);
  addWall(s, 1, 1);  // now the leaf is the second layer
  g = layers(s, 0.5f);
  CHECK(g.depth2.at(leaf[0], leaf[1]) == 2);
  CHECK(g.depth2.at(hole[0], hole[1]) == 4);
  s.instances[1].worldFromObject[0][0] = -1;  // mirrored in the mesh's plane and turned round: seen from behind
  s.instances[1].worldFromObject[2][2] = -1;
  s.instances[1].worldFromObject[3][2] = -4;
  g = layers(s, 0.5f);
  CHECK(g.depth2.at(leaf[0], leaf[1]) == 4);
  CHECK(g.depth2.at(hole[0], hole[1]) == 4);
  CHECK(g.depthBack.at(leaf[0], leaf[1]) == kInfinity);  // its columns have changed places
  CHECK(g.depthBack.at(hole[0], hole[1]) == 2);
}

TEST_CASE("layers: threads, targets, tile sizes and skipping do not change a bit") {
  raster::withThreads(8, [] {
    for (uint32_t seed : {2u, 4u, 7u, 15u, 21u}) {
      const TestScene s = soupScene(seed);
      const GBuffer all = referenceOf(s, kAllLayers), depths = referenceOf(s, kDepths);
      CHECK(firstDifference("depth2", all.depth2, depths.depth2) == "");
      for (Target target : supportedTargets())
        for (int tile : {16, 32, 64})
          for (int count : {1, 3})
            for (bool skip : {true, false}) {
              const Settings settings{count, target, tile, skip};
              INFO("seed " << seed << " target " << targetName(target) << " tile " << tile << " threads " << count << " skip " << skip);
              REQUIRE(firstDifference(render(s, settings, nullptr, kAllLayers), all) == "");
              REQUIRE(firstDifference(render(s, settings, nullptr, kDepths), depths) == "");
            }
    }
  });
}

TEST_CASE("layers: every kernel equals its scalar twin on random scenes") {
  int second = 0, back = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    const TestScene s = soupScene(seed);
    const GBuffer expected = referenceOf(s, kDepths);
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        second += expected.depth2.at(x, y) < kInfinity;
        back += expected.depthBack.at(x, y) < kInfinity;
      }
    for (Target target : supportedTargets())
      for (bool skip : {true, false}) {
        INFO("seed " << seed << " target " << targetName(target) << " skip " << skip);
        REQUIRE(firstDifference(render(s, {1, target, 64, skip}, nullptr, kDepths), expected) == "");
      }
  }
  CHECK(second > 50000);
  CHECK(back > 50000);
}

TEST_CASE("layers: the order of triangles, clusters and instances does not matter") {
  for (uint32_t seed : {4u, 12u, 22u}) {
    TestScene s = soupScene(seed);
    const GBuffer expected = render(s, {}, nullptr, kDepths);
    TestMesh& m = s.meshes[0];
    std::vector<uint32_t> order(m.view.triangleCount());
    for (uint32_t t = 0; t < order.size(); ++t) order[t] = t;
    Random random(seed);
    for (size_t t = order.size(); t > 1; --t) std::swap(order[t - 1], order[size_t(random.integer(0, int(t) - 1))]);
    m.clusters = buildClusters(m.positions, m.indices, order, std::vector<uint32_t>(order.size() / 5, 5));
    m.view.clusters = &m.clusters;
    CHECK(firstDifference(render(s, {}, nullptr, kDepths), expected) == "");
    // Depths have no ids: the list itself can be in any order.
    std::reverse(s.instances.begin(), s.instances.end());
    CHECK(firstDifference(render(s, {}, nullptr, kDepths), expected) == "");
    m.view.clusters = nullptr;
    const std::vector<uint32_t> indices = m.indices;
    for (size_t t = 0; t < order.size(); ++t)
      for (size_t k = 0; k < 3; ++k) m.indices[t * 3 + k] = indices[order[t] * 3 + k];
    CHECK(firstDifference(render(s, {}, nullptr, kDepths), expected) == "");
  }
}

TEST_CASE("layers: statistics count what can be seen, whatever layers are asked for") {
  const TestScene s = soupScene(4);
  Statistics one, all;
  render(s, {}, &one);
  render(s, {}, &all, kAllLayers);
  CHECK(one.drawn > 0);
  CHECK(std::memcmp(&one, &all, sizeof one) == 0);
}

TEST_CASE("depth alone: the depth plane of the whole G-buffer, into the caller's memory") {
  Rasterizer rasterizer;
  Plane<float> depth;
  for (uint32_t seed = 0; seed < 24; ++seed) {
    const TestScene s = soupScene(seed);
    rasterizer.renderDepth(s.list(), s.camera, s.width, s.height, depth);
    INFO("seed " << seed);
    REQUIRE(firstDifference("depth", depth, render(s).depth) == "");
  }
  const TestScene s = soupScene(4);
  rasterizer.renderDepth(s.list(), s.camera, 50, 40, depth);
  const float* memory = depth.data();
  rasterizer.renderDepth(s.list(), s.camera, 50, 40, depth);
  CHECK(depth.data() == memory);
  CHECK_THROWS_WITH(rasterizer.renderDepth(s.list(), s.camera, 0, 40, depth), Catch::Contains("0 x 40"));
  CHECK((depth.data() == memory && depth.width() == 50));
}

TEST_CASE("depth alone: a G-buffer that is used again holds no planes of the frame before") {
  const TestScene s = soupScene(4);
  Rasterizer rasterizer;
  GBuffer g;
  rasterizer.render(s.list(), s.camera, s.width, s.height, kAllLayers, g);
  PlaneSet depth;
  depth.depth = true;
  rasterizer.render(s.list(), s.camera, s.width, s.height, depth, g);
  CHECK(firstDifference(g, render(s, {}, nullptr, depth)) == "");
  CHECK(g.triangle.empty());
}

TEST_CASE("gbuffer: it has the planes that it was made with, and no others") {
  for (bool PlaneSet::*plane : {&PlaneSet::depth, &PlaneSet::normal, &PlaneSet::albedo, &PlaneSet::emissive,
                                &PlaneSet::position, &PlaneSet::triangle, &PlaneSet::instance, &PlaneSet::material,
                                &PlaneSet::depth2, &PlaneSet::depthBack, &PlaneSet::metallic, &PlaneSet::roughness}) {
    PlaneSet one, others = kAllLayers;
    one.*plane = true;
    others.*plane = false;
    CHECK(GBuffer(4, 4, one).has(one));
    CHECK(!GBuffer(4, 4, one).has({}));
    CHECK(!GBuffer(4, 4, others).has(kAllLayers));
    CHECK(GBuffer(4, 4, others).has(others));
  }
}

TEST_CASE("layers: a separation that is none is refused and named") {
  const TestScene s = soupScene(4);
  GBuffer g;
  PlaneSet planes;
  planes.depth2 = true;
  for (float wrong : {0.f, -1.f, kNan, kInfinity}) {
    planes.separation = wrong;
    CHECK_THROWS_WITH(Rasterizer().render(s.list(), s.camera, 8, 8, planes, g), Catch::Contains("separation"));
    CHECK_THROWS_WITH(renderReference(s.list(), s.camera, 8, 8, planes, g), Catch::Contains("separation"));
  }
}
