// Geometry, numbers, sizes and orders that nobody draws on purpose.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "obscura/raster/clip.h"
#include "raster_oracle.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

GBuffer render(const TestScene& s, const Settings& settings = {}, Statistics* statistics = nullptr) {
  Rasterizer rasterizer(settings);
  GBuffer g;
  rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
  if (statistics) *statistics = rasterizer.statistics();
  return g;
}

// Equal to the scalar twins with and without skipping, with the best target and the plainest.
void checkAgainstReference(const TestScene& s) {
  GBuffer expected;
  renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, expected);
  for (Target target : {supportedTargets().front(), supportedTargets().back()})
    for (bool skip : {true, false}) {
      INFO(targetName(target) << (skip ? "" : ", no skip"));
      REQUIRE(firstDifference(render(s, {1, target, 16, skip}), expected) == "");
    }
}

void eachPixel(const GBuffer& g, const std::function<void(int, int)>& body) {
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if (g.triangle.at(x, y) != kNoTriangle) body(x, y);
}

// Every number of a covered pixel is one that the next stage can use.
void checkUsable(const GBuffer& g, float zNear, float zFar) {
  eachPixel(g, [&](int x, int y) {
    const float z = g.depth.at(x, y);
    bool good = z >= zNear && z <= zFar && std::isfinite(z);
    float length = 0;
    for (int c = 0; c < 3; ++c) {
      good &= g.albedo[c].at(x, y) >= 0 && g.albedo[c].at(x, y) <= 1 && g.emissive[c].at(x, y) >= 0;
      length += g.normal[c].at(x, y) * g.normal[c].at(x, y);
    }
    good &= std::fabs(length - 1) < 1e-5f;
    if (!good)
      FAIL("pixel (" << x << ", " << y << "), triangle " << g.triangle.at(x, y) << ": depth " << z << " in [" << zNear << ", "
                     << zFar << "], |normal|^2 " << length << ", albedo " << g.albedo[0].at(x, y) << " "
                     << g.albedo[1].at(x, y) << " " << g.albedo[2].at(x, y) << ", emissive " << g.emissive[0].at(x, y));
  });
}

int covered(const GBuffer& g) {
  int n = 0;
  eachPixel(g, [&](int, int) { ++n; });
  return n;
}

// Triangles of one mesh with the given vertices, three each, seen along -z from the origin.
TestScene sceneOf(const std::vector<glm::vec3>& positions, double zNear = 0.01, double zFar = 0) {
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  TestMesh& m = s.addMesh();
  m.positions = positions;
  for (uint32_t i = 0; i < positions.size(); ++i) m.indices.push_back(i);
  s.place(m);
  s.width = 61, s.height = 43;
  s.camera = perspective(1.2, 61.0 / 43, zNear, zFar);
  return s;
}

}  // namespace

TEST_CASE("clip: nothing is drawn of what lies behind the eye, and statistics still add up") {
  Random random(2);
  std::vector<glm::vec3> p;
  for (int i = 0; i < 900; ++i) p.push_back(random.vector(-5, 5) + glm::vec3(0, 0, 5.02f));
  for (int i = 0; i < 900; ++i) p.push_back({random.real(-1, 1), random.real(-1, 1), 0});  // in the eye's plane: w = 0
  TestScene s = sceneOf(p);
  for (bool skip : {true, false}) {
    Statistics q;
    CHECK(covered(render(s, {1, Target::Auto, 64, skip}, &q)) == 0);
    CHECK(q.trianglesCulled + q.facingAway + q.outside + q.invalid + q.drawn == q.triangles);
    CHECK(q.drawn == 0);
  }
}

TEST_CASE("clip: edges through the eye and planes that hold it are cut to something finite") {
  Random random(3);
  std::vector<glm::vec3> p;
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 a = random.vector(-2, 2);
    p.insert(p.end(), {a, a * -random.real(0.1f, 3), random.vector(-2, 2)});          // an edge through the eye
    p.insert(p.end(), {glm::vec3(0), random.vector(-2, 2), random.vector(-2, 2)});    // a vertex in the eye
    const glm::vec3 b = random.vector(-2, 2);
    p.insert(p.end(), {a, b, a * random.real(-2, 2) + b * random.real(-2, 2)});       // the plane holds the eye
  }
  for (double zNear : {1e-6, 0.01, 1.0}) {
    const TestScene s = sceneOf(p, zNear);
    checkAgainstReference(s);
    const GBuffer g = render(s);
    if (zNear > 0.001) CHECK(covered(g) < 100);  // all are seen from the edge, but for the rounding of their vertices
    checkUsable(g, float(zNear), kInfinity);
  }
}

TEST_CASE("clip: the near plane through a cluster cuts some of its triangles and leaves the bits of the others") {
  // A floor of small triangles from behind the eye to the horizon, in clusters that straddle the plane.
  TestScene s;
  s.materials.resize(1);
  TestMesh& m = s.addMesh();
  const int n = 24;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) m.positions.push_back({float(i - n / 2) * 0.05f, -0.2f, float(j - n / 2) * -0.05f});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const uint32_t a = uint32_t(j * (n + 1) + i), b = a + 1, d = a + n + 1, c = d + 1;
      for (uint32_t k : {a, b, c, a, c, d}) m.indices.push_back(k);
    }
  s.place(m);
  s.camera = perspective(1.8, 4.0 / 3, 0.1);
  checkAgainstReference(s);
  Statistics q;
  const GBuffer all = render(s, {}, &q);
  CHECK(q.clipped > 10);
  CHECK(q.drawn > 300);
  for (double zNear : {0.06, 0.13, 0.21}) {
    s.camera.zNear = float(zNear);
    const GBuffer other = render(s);
    // Whoever is whole in front of both planes is the same in both images.
    eachPixel(other, [&](int x, int y) {
      const uint32_t t = other.triangle.at(x, y);
      bool whole = true;
      for (uint32_t i = 0; i < 3; ++i) whole &= m.positions[m.indices[t * 3 + i]].z < -0.22f;
      if (whole) REQUIRE((all.triangle.at(x, y) == t && all.depth.at(x, y) == other.depth.at(x, y)));
    });
  }
}

TEST_CASE("clip: whatever the coordinates, a cut vertex lies between the near and far planes and projects to something finite") {
  Random random(7);
  for (int power = 0; power <= 38; ++power)
    for (double zNear : {1e-7, 0.01, 10.0})
      for (double zFar : {0.0, 1e3}) {
        const View view = makeView(perspective(1.2, 1.5, zNear, zFar), 60, 40);
        for (int round = 0; round < 50; ++round) {
          const float size = std::pow(10.0f, float(power)) * 0.9f;
          glm::vec3 triangle[3], polygon[kMaxClipped];
          for (glm::vec3& p : triangle) p = random.vector(-3, 3) * (random.integer(0, 1) ? size : 1.0f);
          const int corners = clipTriangle(view, triangle, polygon);
          for (int i = 0; i < corners; ++i) {
            const double zView = -double(polygon[i].z);
            const double x = double(polygon[i].x) / zView * view.xScaleSub, y = double(polygon[i].y) / zView * view.yScaleSub;
            bool good = zView >= zNear * (1 - 1e-6) && (zFar == 0 || zView <= zFar * (1 + 1e-6));
            good &= std::isfinite(x) && std::isfinite(y);
            // Up to a billion times the near distance, cuts are exact enough to end at the guard band.
            const double limit = double(size) < zNear * 1e9 ? kGuardSub : HUGE_VAL;
            good &= std::fabs(x) <= limit && std::fabs(y) <= limit;
            if (!good)
              FAIL("coordinates up to 3e" << power << ", near " << zNear << ", far " << zFar << ": zView " << zView << ", x "
                                          << x << " y " << y << " of (" << triangle[0].x << ", "
                                          << triangle[0].y << ", " << triangle[0].z << "), (" << triangle[1].x << ", "
                                          << triangle[1].y << ", " << triangle[1].z << "), (" << triangle[2].x << ", "
                                          << triangle[2].y << ", " << triangle[2].z << ")");
          }
        }
      }
}

TEST_CASE("clip: whatever the coordinates, what is drawn lies between the near and far planes") {
  Random random(5);
  for (int power = 0; power <= 38; power += 2)
    for (double zNear : {1e-7, 0.01, 10.0})
      for (double zFar : {0.0, 1e3}) {
        std::vector<glm::vec3> p;
        const float size = std::pow(10.0f, float(power)) * 0.9f;
        for (int i = 0; i < 120; ++i) {
          const float big = random.integer(0, 2) ? size : 1.0f;
          p.push_back(random.vector(-3, 3) * big);
        }
        const TestScene s = sceneOf(p, zNear, zFar);
        INFO("coordinates up to 3e" << power << ", near " << zNear << ", far " << zFar);
        checkAgainstReference(s);
        checkUsable(render(s), float(zNear), zFar > 0 ? float(zFar) : kInfinity);
      }
}

TEST_CASE("hostile: a vertex that becomes infinite on its way to the eye drops its triangle") {
  TestScene s = sceneOf({{0, 0, -3e38f}, {1e-3f, 0, -0.2f}, {0, 1e-3f, -0.2f}});
  glm::dmat4 scale(1);
  for (int i = 0; i < 3; ++i) scale[i][i] = 100;
  s.instances[0].worldFromObject = scale;
  Statistics q;
  const GBuffer g = render(s, {}, &q);
  CHECK(q.invalid == 1);
  CHECK(covered(g) == 0);
  checkAgainstReference(s);
}

TEST_CASE("hostile: no unit of length changes whether the kernels agree with their twins") {
  for (uint32_t seed : {4u, 6u, 16u, 2u})
    for (int power = -38; power <= 34; power += 3) {
      TestScene s = soupScene(seed);
      TestMesh& m = s.meshes[0];
      const float unit = std::pow(10.0f, float(power));
      for (glm::vec3& p : m.positions) p *= unit;
      m.clusters = {};
      if (m.view.clusters) m.clusters = buildClusters(m.positions, m.indices);
      for (Instance& i : s.instances)
        for (int c = 0; c < 3; ++c) i.worldFromObject[c] *= 1 / double(unit);
      INFO("seed " << seed << ", vertices in units of 1e" << -power);
      checkAgainstReference(s);
      checkUsable(render(s), s.camera.zNear, s.camera.zFar > 0 ? s.camera.zFar : kInfinity);
    }
}

TEST_CASE("hostile: NaN, infinity and denormals in any attribute or factor leave numbers that can be used") {
  const float odd[] = {kNan, kInfinity, -kInfinity, 1e-42f, -1e-42f, 3e38f, -3e38f, 1e30f, 0, -0.f, 1e-30f};
  for (uint32_t seed = 0; seed < 40; ++seed) {
    TestScene s = soupScene(seed);
    Random random(seed + 900);
    const auto spoil = [&](float& v) { v = odd[size_t(random.integer(0, int(std::size(odd)) - 1))]; };
    TestMesh& m = s.meshes[0];
    for (size_t i = 0; i < m.positions.size(); i += 2) {
      const int which = random.integer(0, 4), c = random.integer(0, 2);
      if (which == 0 && !m.normals.empty()) spoil(m.normals[i][c]);
      if (which == 1) spoil(m.uvs[i][c % 2]);
      if (which == 2 && !m.colors.empty()) spoil(m.colors[i][c]);
      if (which == 3 && !m.tangents.empty()) spoil(m.tangents[i][c]);
      if (which == 4 && i % 8 == 0) spoil(m.positions[i][c]);
    }
    Material& mapped = s.materials[seed % 2];
    spoil(mapped.baseColor[int(seed) % 3]);
    spoil(mapped.normalScale);
    spoil(mapped.baseColorMap.uvFromUv[seed % 6]);
    if (seed % 3 == 0) spoil(mapped.emissive[0]);
    m.clusters = {};
    if (m.view.clusters) m.clusters = buildClusters(m.positions, m.indices);
    INFO("seed " << seed);
    checkAgainstReference(s);
    checkUsable(render(s), s.camera.zNear, s.camera.zFar > 0 ? s.camera.zFar : kInfinity);
  }
}

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
  for (uint32_t seed = 0; seed < 30; ++seed) {
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
  CHECK(scenes > 10);
}

TEST_CASE("order: instances in another order are the same image with their ids mapped") {
  int scenes = 0, ties = 0;
  for (uint32_t seed = 0; seed < 30; ++seed) {
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
  CHECK(scenes > 10);
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
  for (glm::dvec3 offset : {glm::dvec3(1e6, 1e6, 1e6), glm::dvec3(-1e6, 1e6 + 1.0 / 3, 1e6 - 0.7), glm::dvec3(1e6 + 0.1, 0, 0)}) {
    const GBuffer away = render(make(offset));
    int changed = 0;
    double worst = 0;
    for (int y = 0; y < home.height; ++y)
      for (int x = 0; x < home.width; ++x) {
        changed += home.triangle.at(x, y) != away.triangle.at(x, y);
        if (home.triangle.at(x, y) == away.triangle.at(x, y) && home.triangle.at(x, y) != kNoTriangle)
          worst = std::max(worst, double(std::fabs(home.depth.at(x, y) - away.depth.at(x, y))));
      }
    // A double at 10^6 resolves 10^-10, 10^-7 of a pixel here: only a vertex that is just about to snap the other way moves.
    INFO(changed << " pixels of " << covered(home) << " changed, depth by up to " << worst);
    CHECK(changed <= covered(home) / 2000);
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("depth range: with far / near of 10^7 the nearer of two planes wins by a part in a million, at any distance") {
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
      for (int c = 0; c < 3; ++c) good &= g.albedo[c].at(x, y) >= lo[c] - 2e-7f && g.albedo[c].at(x, y) <= hi[c] + 2e-7f;
      if (!good) FAIL("seed " << seed << " pixel (" << x << ", " << y << ") depth " << g.depth.at(x, y) << " in [" << zMin << ", " << zMax << "]");
    });
  }
}
