// Ties, orders, distances and sizes that nobody draws on purpose.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raster_checks.h"
#include "raster_oracle.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

TEST_CASE("ties: zero-area, duplicate and opposite coincident triangles show the smallest id that covers") {
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  TestMesh& m = s.addMesh();
  TestScene::addQuad(m, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  // Ids 0 ... 9: without area (0, 1, 2), then each half of the square thrice, once from behind.
  m.indices = {0, 0, 0, 0, 1, 0, 0, 2, 2, 2, 1, 0, 0, 1, 2, 1, 2, 0, 0, 2, 3, 3, 2, 0, 2, 3, 0, 0, 1, 3};
  s.place(m);
  s.camera = perspective(0.7, 4.0 / 3, 0.1);
  s.camera.viewFromWorld = lookAt({0.1, 0.2, 4}, {0, 0, 0}, {0, 1, 0});
  checkAgainstReference(s);
  const GBuffer g = render(s);
  CHECK(covered(g) > 500);
  // Coincident triangles have the same three vertices; which is vertex 0 may change the key by rounding, so that
  // only the two that start alike tie everywhere. Hence: the winner is one of the coincident ones, and never empty.
  eachPixel(g, [&](int x, int y) { REQUIRE(g.triangle.at(x, y) >= 3); });

  // Exactly alike: all three orders of drawing leave the smaller id.
  m.indices = {0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3, 0, 1, 2};
  m.clusters = {};
  s.instances.clear();
  s.place(m);
  const GBuffer alike = render(s);
  CHECK(covered(alike) == covered(g));
  eachPixel(alike, [&](int x, int y) { REQUIRE(alike.triangle.at(x, y) <= 1); });
}

TEST_CASE("order: shuffling a mesh's triangles and keeping their ids changes no byte") {
  int scenes = 0;
  for (uint32_t seed = 0; seed < (kFastBuild ? 30 : 18); ++seed) {
    TestScene s = soupScene(seed);
    TestMesh& m = s.meshes[0];
    // Every second triangle is a copy of the one before: ties all over the image.
    for (size_t i = 0; i + 5 < m.indices.size(); i += 6)
      for (size_t k = 0; k < 3; ++k) m.indices[i + 3 + k] = m.indices[i + k];
    m.view.clusters = nullptr;
    const GBuffer expected = render(s);
    if (covered(expected) < 500) continue;
    ++scenes;
    Random random(seed);
    std::vector<uint32_t> order(m.view.triangleCount());
    std::iota(order.begin(), order.end(), 0);
    for (int round = 0; round < 4; ++round) {
      for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[size_t(random.integer(0, int(i) - 1))]);
      std::vector<uint32_t> counts;
      for (size_t i = 0; i < order.size(); i += counts.back()) counts.push_back(uint32_t(random.integer(1, 128)));
      m.clusters = buildClusters(m.positions, m.indices, order, counts);
      m.view.clusters = &m.clusters;
      INFO("seed " << seed << " round " << round);
      REQUIRE(firstDifference(render(s, {1 + round % 2, Target::Auto, 16 << (round % 3), round != 3}), expected) == "");
    }
  }
  CHECK(scenes > 5);
}

TEST_CASE("order: instances in another order are the same image with their ids mapped") {
  int scenes = 0, ties = 0;
  for (uint32_t seed = 0; seed < (kFastBuild ? 30 : 18); ++seed) {
    TestScene s = soupScene(seed);
    const uint32_t each = s.meshes[0].view.triangleCount();
    const GBuffer expected = render(s);
    if (covered(expected) < 500) continue;
    ++scenes;
    std::vector<uint32_t> order{0, 1, 2};
    const std::vector<Instance> original = s.instances;
    while (std::next_permutation(order.begin(), order.end())) {
      for (size_t i = 0; i < 3; ++i) s.instances[i] = original[order[i]];
      GBuffer g = render(s);
      int tied = 0;
      eachPixel(g, [&](int x, int y) {
        uint32_t &instance = g.instance.at(x, y), &triangle = g.triangle.at(x, y);
        triangle = order[instance] * each + triangle % each;
        instance = order[instance];
        // On equal depth the smaller id is seen, which the order of the instances decides.
        tied += triangle != expected.triangle.at(x, y) && g.depth.at(x, y) == expected.depth.at(x, y);
      });
      INFO("seed " << seed);
      REQUIRE(firstDifference("depth", g.depth, expected.depth) == "");
      if (tied == 0) REQUIRE(firstDifference(g, expected) == "");
      ties += tied;
    }
  }
  CHECK(scenes > 5);
  CHECK(ties < 20);
}

TEST_CASE("far away: a world moved by a million units with its camera keeps its millimetres") {
  // A relief of millimetre triangles, seen from half a metre.
  const auto make = [](glm::dvec3 offset) {
    TestScene s;
    s.materials.resize(1);
    TestMesh& m = s.addMesh();
    const int n = 160;
    Random random(6);
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        m.positions.push_back({float(i - n / 2) * 0.001f, float(j - n / 2) * 0.001f, random.real(-0.001f, 0.001f)});
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const uint32_t a = uint32_t(j * (n + 1) + i), b = a + 1, d = a + n + 1, c = d + 1;
        for (uint32_t k : {a, b, c, a, c, d}) m.indices.push_back(k);
      }
    glm::dmat4 world(1);
    world[3] = glm::dvec4(offset, 1);
    s.place(m, 0, world);
    s.width = 320, s.height = 240;
    s.camera = perspective(0.3, 4.0 / 3, 0.01);
    s.camera.viewFromWorld = lookAt(offset + glm::dvec3(0.11, 0.07, 0.48), offset, {0, 1, 0});
    return s;
  };
  const GBuffer home = render(make(glm::dvec3(0)));
  REQUIRE(covered(home) > 50000);
  for (glm::dvec3 offset :
       {glm::dvec3(1e6, 1e6, 1e6), glm::dvec3(-1e6, 1e6 + 1.0 / 3, 1e6 - 0.7), glm::dvec3(1e6 + 0.1, 0, 0)}) {
    const GBuffer away = render(make(offset));
    int changed = 0;
    double worst = 0;
    for (int y = 0; y < home.height; ++y)
      for (int x = 0; x < home.width; ++x) {
        changed += home.triangle.at(x, y) != away.triangle.at(x, y);
        if (home.triangle.at(x, y) == away.triangle.at(x, y) && home.triangle.at(x, y) != kNoTriangle)
          worst = std::max(worst, double(std::fabs(home.depth.at(x, y) - away.depth.at(x, y))));
      }
    // A double at 10^6 resolves 10^-10, 10^-7 of a pixel here: only a vertex that is just about to snap the other way
    // moves.
    INFO(changed << " pixels of " << covered(home) << " changed, depth by up to " << worst);
    CHECK(changed <= covered(home) / 2000);
    CHECK(worst < 1e-5);
  }
}

TEST_CASE(
    "depth range: with far / near of 10^7 the nearer of two planes wins by a part in a million, at any distance") {
  for (double z = 0.0011; z < 1e4; z *= 1.37) {
    const float near = float(z), far = near * (1 + 1.0f / (1 << 20));
    const float size = near * 2;
    std::vector<glm::vec3> p;
    for (float d : {far, near}) {
      const float dx = near * 0.3f;
      for (glm::vec3 v : {glm::vec3(-size - dx, -size, -d), glm::vec3(size, -size + dx, -d), glm::vec3(size, size, -d),
                          glm::vec3(-size - dx, -size, -d), glm::vec3(size, size, -d), glm::vec3(-size, size + dx, -d)})
        p.push_back(v);
    }
    const TestScene s = sceneOf(p, 0.001, 1e4);
    const GBuffer g = render(s);
    CHECK(covered(g) == s.width * s.height);
    eachPixel(g, [&](int x, int y) { REQUIRE(g.triangle.at(x, y) >= 2); });
  }
}

TEST_CASE("sizes: one pixel to the largest, and one off every tile, are the middle of a larger picture") {
  // A plane tilted in depth, so that each pixel's id and depth are known from its place alone.
  const TestScene base = sceneOf({{-40000, -30000, -9}, {40000, -30000, -9}, {0, 60000, -9}});
  const int sizes[] = {1, 2, 15, 16, 17, 31, 32, 33, 63, 64, 65, 127, 128, 129, 1023, 1025, 16383, 16384};
  PlaneSet planes;
  planes.triangle = true;
  for (int tile : {16, 32, 64}) {
    Rasterizer rasterizer({2, Target::Auto, tile, true});
    GBuffer g;
    for (int w : sizes)
      for (int h : sizes) {
        if (int64_t(w) * h > (kFastBuild ? 1 << 20 : 1 << 15)) continue;
        rasterizer.render(base.list(), base.camera, w, h, planes, g);
        int64_t n = 0;
        for (int y = 0; y < h; ++y) n += std::count(g.triangle.row(y), g.triangle.row(y) + w, 0u);
        INFO(w << " x " << h << ", tile " << tile);
        REQUIRE(n == int64_t(w) * h);
      }
  }
}

TEST_CASE("sizes: 16384 x 16384 pixels agree with exact arithmetic to the last corner") {
  if (!kFastBuild) return;  // a plane of a gibibyte
  const int size = kMaxImageSize;
  const OracleImage image{size, size};
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  s.camera = orthographic(size / 2.0, size / 2.0, 0.5, 100);
  TestMesh& m = s.addMesh();
  Random random(12);
  std::vector<OracleTriangle> triangles;
  const int64_t half = kGuardSub;
  const SubPoint corners[4] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  const SubPoint middle{12345, -54321};
  for (size_t i = 0; i < 4; ++i) triangles.push_back({{corners[i], corners[(i + 1) % 4], middle}, {}});
  for (const OracleTriangle& t : triangles)
    for (const SubPoint& v : t.at) {
      m.indices.push_back(uint32_t(m.positions.size()));
      m.positions.push_back({float(v.x) / kSub, -float(v.y) / kSub, -1});
    }
  s.place(m);
  PlaneSet planes;
  planes.triangle = true;
  GBuffer g;
  Rasterizer rasterizer;
  try {
    rasterizer.render(s.list(), s.camera, size, size, planes, g);
  } catch (const std::bad_alloc&) {
    WARN("no memory for a plane of 1 GiB");
    return;
  }
  for (int y = 0; y < size; ++y)
    for (uint32_t t = 0; t < 4; ++t) {
      const Columns c = coveredColumns(triangles[t], image, y);
      const uint32_t* row = g.triangle.row(y);
      if (std::find_if(row + c.begin, row + c.end, [&](uint32_t id) { return id != t; }) != row + c.end)
        FAIL("row " << y << ", triangle " << t << ", columns " << c.begin << " to " << c.end);
    }
}

TEST_CASE("attributes: no colour and no depth leaves the range of its triangle's vertices") {
  for (uint32_t seed = 0; seed < 30; ++seed) {
    TestScene s = soupScene(seed);
    TestMesh& m = s.meshes[0];
    Random random(seed + 40);
    m.colors.clear();
    for (size_t i = 0; i < m.positions.size(); ++i) m.colors.push_back(glm::vec4(random.vector(0, 1), 1));
    m.view.colors = m.colors;
    s.materials.resize(1);
    s.materials[0] = Material();
    s.materials[0].doubleSided = true;
    for (Instance& i : s.instances) i.material = 0;
    const std::vector<Draw> draws = makeDraws(s.list(), s.camera);
    const GBuffer g = render(s);
    eachPixel(g, [&](int x, int y) {
      const Draw& draw = draws[g.instance.at(x, y)];
      const uint32_t t = g.triangle.at(x, y) - draw.firstTriangle;
      float zMin = kInfinity, zMax = 0;
      glm::vec3 lo(1), hi(0);
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t v = m.indices[t * 3 + i];
        const glm::vec3 p = m.positions[v];
        const float* r = draw.viewFromObject[2];
        const float z = -(((r[0] * p.x + r[1] * p.y) + r[2] * p.z) + r[3]);
        zMin = std::min(zMin, z), zMax = std::max(zMax, z);
        for (int c = 0; c < 3; ++c) lo[c] = std::min(lo[c], m.colors[v][c]), hi[c] = std::max(hi[c], m.colors[v][c]);
      }
      // Three products and two sums of weights whose own sum is 1 but for rounding; 1 / (1 / z) errs by an ulp.
      bool good = g.depth.at(x, y) >= zMin * (1 - 2e-7f) && g.depth.at(x, y) <= zMax * (1 + 2e-7f);
      for (int c = 0; c < 3; ++c)
        good &= g.albedo[c].at(x, y) >= lo[c] - 2e-7f && g.albedo[c].at(x, y) <= hi[c] + 2e-7f;
      if (!good)
        FAIL("seed " << seed << " pixel (" << x << ", " << y << ") depth " << g.depth.at(x, y) << " in [" << zMin
                     << ", " << zMax << "]");
    });
  }
}
