// Clipping and numbers that nobody stores on purpose: always something finite, always the same as the scalar twins.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <iterator>

#include "obscura/raster/clip.h"
#include "raster_checks.h"
#include "raster_oracle.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

TEST_CASE("clip: nothing is drawn of what lies behind the eye, and statistics still add up") {
  Random random(2);
  std::vector<glm::vec3> p;
  for (int i = 0; i < 900; ++i) p.push_back(random.vector(-5, 5) + glm::vec3(0, 0, 5.02f));
  for (int i = 0; i < 900; ++i) p.push_back({random.real(-1, 1), random.real(-1, 1), 0});  // in the eye's plane: w = 0
  TestScene s = sceneOf(p);
  for (bool skip : {true, false}) {
    Statistics q;
    CHECK(covered(render(s, {1, Target::Auto, 64, skip}, &q)) == 0);
    CHECK(q.trianglesCulled + q.facingAway + q.outside + q.hidden + q.invalid + q.drawn == q.triangles);
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

TEST_CASE("clip: neighbours cut their edge at the same bits, where the cut loses most of them") {
  // From a vertex in view to one a million times the near distance away, the cut's last bits are rounding alone.
  int compared = 0;
  for (int plane = 0; plane < 3; ++plane) {  // near, far, guard band
    const View view = makeView(perspective(1.2, 1.5, 0.01, plane == 1 ? 50.0 : 0.0), 60, 40);
    Random random(70 + uint32_t(plane));
    for (int round = 0; round < 4000; ++round) {
      glm::vec3 seen[3];  // a, c, d: inside the image
      for (glm::vec3& p : seen) {
        // Close to the plane, so that the cut is short and the other end's magnitude shows.
        const float z = plane == 0   ? random.real(0.0101f, 0.02f)
                        : plane == 1 ? random.real(49.9f, 50.f)
                                     : random.real(0.02f, 2.f);
        p = {random.real(-0.3f, 0.3f) * z, random.real(-0.3f, 0.3f) * z, -z};
      }
      glm::vec3 b = random.vector(-1, 1) * std::pow(10.0f, random.real(1, 6));
      b.z = plane == 0 ? std::fabs(b.z) : plane == 1 ? -51 - std::fabs(b.z) : -0.02f;
      const glm::vec3 one[3] = {seen[0], b, seen[1]}, other[3] = {b, seen[0], seen[2]};
      glm::vec3 first[kMaxClipped], second[kMaxClipped];
      if (clipTriangle(view, one, first) < 4 || clipTriangle(view, other, second) < 4) continue;
      // The polygon keeps its order: a, the end of a -> b, ... and the end of b -> a, a, ...
      REQUIRE(std::memcmp(&first[0], &seen[0], sizeof(glm::vec3)) == 0);
      INFO("plane " << plane << " round " << round << ": " << first[1].x << " " << first[1].y << " " << first[1].z
                    << " and " << second[0].x << " " << second[0].y << " " << second[0].z);
      REQUIRE(std::memcmp(&first[1], &second[0], sizeof(glm::vec3)) == 0);
      ++compared;
    }
  }
  CHECK(compared > 9000);
}

TEST_CASE("clip: whatever the coordinates, a cut vertex lies between near and far and projects to something finite") {
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
            const double x = double(polygon[i].x) / zView * view.xScaleSub,
                         y = double(polygon[i].y) / zView * view.yScaleSub;
            bool good = zView >= zNear * (1 - 1e-6) && (zFar == 0 || zView <= zFar * (1 + 1e-6));
            good &= std::isfinite(x) && std::isfinite(y);
            // Up to a billion times the near distance, cuts are exact enough to end at the guard band.
            const double limit = double(size) < zNear * 1e9 ? kGuardSub : HUGE_VAL;
            good &= std::fabs(x) <= limit && std::fabs(y) <= limit;
            if (!good)
              FAIL("coordinates up to 3e" << power << ", near " << zNear << ", far " << zFar << ": zView " << zView
                                          << ", x " << x << " y " << y << " of (" << triangle[0].x << ", "
                                          << triangle[0].y << ", " << triangle[0].z << "), (" << triangle[1].x << ", "
                                          << triangle[1].y << ", " << triangle[1].z << "), (" << triangle[2].x << ", "
                                          << triangle[2].y << ", " << triangle[2].z << ")");
          }
        }
      }
}

TEST_CASE("clip: whatever the coordinates, what is drawn lies between the near and far planes") {
  Random random(5);
  for (int power = 0; power <= 38; power += kFastBuild ? 2 : 6)
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
    for (int power = -38; power <= 34; power += kFastBuild ? 3 : 12) {
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
  for (uint32_t seed = 0; seed < (kFastBuild ? 40 : 12); ++seed) {
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
    spoil(seed % 2 ? mapped.metallic : mapped.roughness);
    spoil(mapped.baseColorMap.uvFromUv[seed % 6]);
    if (seed % 3 == 0) spoil(mapped.emissive[0]);
    m.clusters = {};
    if (m.view.clusters) m.clusters = buildClusters(m.positions, m.indices);
    INFO("seed " << seed);
    checkAgainstReference(s);
    checkUsable(render(s), s.camera.zNear, s.camera.zFar > 0 ? s.camera.zFar : kInfinity);
  }
}
