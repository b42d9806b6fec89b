#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "obscura/engine/cluster_mesh.h"
#include "obscura/raster/clusters.h"

using namespace obscura;
using raster::Cluster;
using raster::Clusters;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

struct Soup {
  const char* name;
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
};

struct Random {
  uint64_t state;
  uint32_t next() {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return uint32_t(state >> 33);
  }
  uint32_t below(uint32_t n) { return next() % n; }
  float unit() { return float(next() & 0xFFFFFF) / float(1 << 23) - 1; }  // [-1, 1)
};

// A bumpy height field of n x n quads, triangles in rows.
Soup field(uint32_t n) {
  Soup s{"field", {}, {}};
  Random r{7};
  for (uint32_t y = 0; y <= n; ++y)
    for (uint32_t x = 0; x <= n; ++x) s.positions.push_back({float(x), 0.4f * r.unit(), float(y)});
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      for (const uint32_t v : {a, c, b, b, c, d}) s.indices.push_back(v);
    }
  return s;
}

Soup random(const char* name, uint64_t seed, uint32_t vertices, uint32_t triangles, float scale) {
  Soup s{name, {}, {}};
  Random r{seed};
  for (uint32_t i = 0; i < vertices; ++i) s.positions.push_back({r.unit() * scale, r.unit() * scale, r.unit() * scale});
  for (uint32_t i = 0; i < triangles * 3; ++i) s.indices.push_back(r.below(vertices));
  return s;
}

// One hub, a long rim: every triangle shares the hub, as in a disc or a hostile file.
Soup fan(uint32_t triangles) {
  Soup s{"fan", {{0, 0, 0}}, {}};
  for (uint32_t i = 0; i < triangles; ++i) {
    s.positions.push_back({float(i), 1, 0});
    for (const uint32_t v : {0u, i + 1, (i + 1) % triangles + 1}) s.indices.push_back(v);
  }
  return s;
}

std::vector<Soup> soups() {
  std::vector<Soup> all = {field(40), random("random", 1, 500, 3000, 1), random("tiny", 2, 200, 800, 1e-30f),
                           random("huge", 3, 200, 800, 3e38f), random("denormal", 4, 60, 300, 1e-42f), fan(2000)};
  Soup hostile = field(20);
  hostile.name = "hostile";
  Random r{5};
  for (int i = 0; i < 60; ++i) {
    const float bad[] = {kNaN, kInf, -kInf, 3e38f, -0.0f};
    hostile.positions[r.below(uint32_t(hostile.positions.size()))][int(r.below(3))] = bad[r.below(5)];
  }
  for (int i = 0; i < 60; ++i) {
    const uint32_t t = r.below(uint32_t(hostile.indices.size() / 3)) * 3;
    hostile.indices[t + 1] = hostile.indices[t];  // degenerate
  }
  all.push_back(hostile);
  Soup nowhere{"nowhere", std::vector<glm::vec3>(9, glm::vec3(kNaN)), {0, 1, 2, 3, 4, 5, 6, 7, 8}};
  all.push_back(nowhere);
  Soup apart = field(12);  // every triangle with vertices of its own
  apart.name = "apart";
  std::vector<glm::vec3> own;
  for (uint32_t& v : apart.indices) own.push_back(apart.positions[v]), v = uint32_t(own.size() - 1);
  apart.positions = own;
  all.push_back(apart);
  return all;
}

Clusters engineClusters(const Soup& s) {
  engine::Mesh mesh;
  mesh.positions = s.positions;
  mesh.indices = s.indices;
  engine::clusterMesh(mesh);
  return mesh.clusters;
}

bool finite(glm::vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
bool sameBits(float a, float b) { return std::memcmp(&a, &b, 4) == 0 || (std::isnan(a) && std::isnan(b)); }

// Everything that raster/clusters.h promises, except how good the clusters are. One REQUIRE per claim and mesh.
void requireSound(const Soup& s, const Clusters& c) {
  INFO(s.name);
  const size_t count = s.indices.size() / 3;
  std::vector<int> seen(count, 0);
  size_t vertexEnd = 0, triangleEnd = 0;
  int badLimits = 0, badCorners = 0, badPlanes = 0, badPadding = 0, outside = 0, badCones = 0;
  for (const Cluster& k : c.clusters) {
    badLimits += k.firstVertex != vertexEnd || k.firstTriangle != triangleEnd || k.triangleCount == 0 ||
                 k.vertexCount == 0 || k.vertexCount > Clusters::kMaxVertices ||
                 k.triangleCount > Clusters::kMaxTriangles;
    const glm::dvec3 offset = glm::dvec3(k.center) - glm::dvec3(c.center);
    outside += k.radius > 0 && !(glm::length(offset) + k.radius <= c.radius);
    vertexEnd += (k.vertexCount + 15) / 16 * 16;
    triangleEnd += (k.triangleCount + 15) / 16 * 16;
    REQUIRE(c.x.size() >= vertexEnd);
    REQUIRE(c.triangle.size() >= triangleEnd);
    const auto vertex = [&](size_t i) {
      i += k.firstVertex;
      return glm::vec3(c.x[i], c.y[i], c.z[i]);
    };
    bool allFinite = true;
    for (size_t i = 0; i < k.vertexCount; ++i) {
      const glm::vec3 p = vertex(i);
      allFinite = allFinite && finite(p);
      long double square = 0;
      for (int a = 0; a < 3; ++a) square += ((long double)p[a] - k.center[a]) * ((long double)p[a] - k.center[a]);
      outside += finite(p) && !(square <= (long double)k.radius * k.radius);
    }
    for (size_t i = k.vertexCount; k.firstVertex + i < vertexEnd; ++i)
      for (int a = 0; a < 3; ++a) badPadding += !sameBits(vertex(i)[a], vertex(0)[a]);
    badCones += !(k.coneCos == -1 || (k.coneCos > 0 && k.coneCos < 1 && allFinite));
    badCones += std::abs(glm::dot(glm::dvec3(k.coneAxis), glm::dvec3(k.coneAxis)) - 1) > 1e-6;
    for (size_t t = k.firstTriangle; t < triangleEnd; ++t) {
      const glm::vec3 n(c.planeX[t], c.planeY[t], c.planeZ[t]);
      if (t >= k.firstTriangle + k.triangleCount) {
        badPadding += c.corners[t] != 0 || n != glm::vec3(0) || c.planeW[t] != 0 || c.triangle[t] >= count;
        continue;
      }
      REQUIRE(c.triangle[t] < count);
      ++seen[c.triangle[t]];
      glm::vec3 v[3];
      for (int i = 0; i < 3; ++i) {
        const uint32_t corner = c.corners[t] >> (8 * i) & 0xFF;
        badCorners += corner >= k.vertexCount || c.corners[t] >> 24 != 0;
        v[i] = vertex(corner);
        for (int a = 0; a < 3; ++a) badCorners += !sameBits(v[i][a], s.positions[s.indices[c.triangle[t] * 3 + i]][a]);
      }
      const glm::dvec3 e = glm::dvec3(v[1]) - glm::dvec3(v[0]), f = glm::dvec3(v[2]) - glm::dvec3(v[0]);
      const glm::dvec3 exact(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x);
      const double size = std::max({std::fabs(exact.x), std::fabs(exact.y), std::fabs(exact.z)});
      const bool unknown = size > 0 && size < 1e-18;  // too short for float: no plane
      const float nan = std::numeric_limits<float>::quiet_NaN();
      const float nx = unknown ? nan : float(exact.x), ny = unknown ? nan : float(exact.y), nz = unknown ? nan : float(exact.z);
      const glm::vec3 r = v[0] - k.center;
      const float w = nx * r.x + ny * r.y + nz * r.z;
      auto same = [](float a, float b) { return sameBits(a, b) || (a != a && b != b); };
      badPlanes += !same(n.x, nx) || !same(n.y, ny) || !same(n.z, nz) || !same(c.planeW[t], w);
      if (k.coneCos == -1 || unknown) continue;
      long double along = 0, square = 0;
      for (int a = 0; a < 3; ++a) along += (long double)n[a] * k.coneAxis[a], square += (long double)n[a] * n[a];
      badCones += !(along >= (k.coneCos + 1e-5L) * std::sqrt(square));  // the margin is there
    }
  }
  REQUIRE(c.triangleCount == count);
  REQUIRE(c.x.size() == vertexEnd);
  REQUIRE(c.y.size() == vertexEnd);
  REQUIRE(c.z.size() == vertexEnd);
  for (const auto* a : {&c.planeX, &c.planeY, &c.planeZ, &c.planeW}) REQUIRE(a->size() == triangleEnd);
  REQUIRE(c.corners.size() == triangleEnd);
  REQUIRE(badLimits == 0);
  REQUIRE(badCorners == 0);
  REQUIRE(badPlanes == 0);
  REQUIRE(badPadding == 0);
  REQUIRE(outside == 0);
  REQUIRE(badCones == 0);
  REQUIRE(seen == std::vector<int>(count, 1));
}

bool same(const Clusters& a, const Clusters& b) {
  const auto equal = [](const auto& p, const auto& q) {
    return p.size() == q.size() && (p.empty() || std::memcmp(p.data(), q.data(), p.size() * sizeof(p[0])) == 0);
  };
  return equal(a.clusters, b.clusters) && equal(a.x, b.x) && equal(a.y, b.y) && equal(a.z, b.z) &&
         equal(a.corners, b.corners) && equal(a.triangle, b.triangle) && equal(a.planeX, b.planeX) &&
         equal(a.planeW, b.planeW);
}

}  // namespace

TEST_CASE("clusters: bounds, planes and padding hold for triangles as they come") {
  for (const Soup& s : soups()) requireSound(s, raster::buildClusters(s.positions, s.indices));
}

TEST_CASE("clusters: bounds, planes and padding hold for the engine's patches") {
  for (const Soup& s : soups()) requireSound(s, engineClusters(s));
}

TEST_CASE("clusters: an order and counts are kept, too large clusters are split, nonsense is ignored") {
  const Soup s = field(20);  // 800 triangles
  std::vector<uint32_t> order(800);
  for (uint32_t i = 0; i < 800; ++i) order[i] = 799 - i;
  const Clusters c = raster::buildClusters(s.positions, s.indices, order, std::vector<uint32_t>{5, 0, 7, 400, 9});
  requireSound(s, c);
  REQUIRE(c.clusters[0].triangleCount == 5);
  REQUIRE(c.clusters[1].triangleCount == 7);
  REQUIRE(c.clusters[2].triangleCount == 128);
  REQUIRE(c.triangle[0] == 799);
  REQUIRE(c.triangle[c.clusters[1].firstTriangle] == 794);

  const Clusters plain = raster::buildClusters(s.positions, s.indices);
  order[3] = order[4];
  REQUIRE(same(plain, raster::buildClusters(s.positions, s.indices, order)));
  order[3] = 800;
  REQUIRE(same(plain, raster::buildClusters(s.positions, s.indices, order)));
  order.resize(10);
  REQUIRE(same(plain, raster::buildClusters(s.positions, s.indices, order)));
  requireSound(s, raster::buildClusters(s.positions, s.indices, {}, std::vector<uint32_t>(3, UINT32_MAX)));
}

TEST_CASE("clusters: a flat patch has a narrow cone, a closed box none, a degenerate triangle changes neither") {
  Soup s = field(6);
  for (glm::vec3& p : s.positions) p.y = 0;
  s.indices.insert(s.indices.end(), {3, 3, 9});
  const Clusters flat = raster::buildClusters(s.positions, s.indices);
  REQUIRE(flat.clusters.size() == 1);
  REQUIRE(flat.clusters[0].coneCos > 0.9999f);
  REQUIRE(flat.clusters[0].coneAxis == glm::vec3(0, 1, 0));
  REQUIRE(flat.clusters[0].radius < 4.2427f);  // half the diagonal of 6 x 6

  const Soup tetrahedron{
      "tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}};
  REQUIRE(raster::buildClusters(tetrahedron.positions, tetrahedron.indices).clusters[0].coneCos == -1);
}

TEST_CASE("clusters: a vertex that is not finite takes the cone, not the sphere") {
  Soup s = field(6);
  s.positions[10].y = kNaN;
  const Clusters c = raster::buildClusters(s.positions, s.indices);
  REQUIRE(c.clusters[0].coneCos == -1);
  REQUIRE(c.clusters[0].radius > 4);
  REQUIRE(c.clusters[0].radius < 5);
}

TEST_CASE("clusters: the same mesh gives the same bytes") {
  for (const Soup& s : soups()) {
    INFO(s.name);
    REQUIRE(same(engineClusters(s), engineClusters(s)));
  }
}

TEST_CASE("clusters: vertices that share a position are one vertex, and patches stay compact") {
  Soup s = field(64);  // 8192 triangles, given as a soup in which no two triangles share a vertex
  std::vector<glm::vec3> own;
  for (uint32_t& v : s.indices) own.push_back(s.positions[v]), v = uint32_t(own.size() - 1);
  s.positions = own;
  const Clusters c = engineClusters(s);
  requireSound(s, c);
  size_t vertices = 0;
  double area = 0;
  for (const Cluster& k : c.clusters) vertices += k.vertexCount, area += double(k.radius) * k.radius;
  REQUIRE(vertices < 5800);  // 5468; 24576 without welding
  REQUIRE(c.clusters.size() < 95);  // 87
  REQUIRE(area < 4600);  // 4123
  REQUIRE(c.radius < 60);  // half the field's diagonal is 45
}

TEST_CASE("clusters: no triangles give no clusters") {
  REQUIRE(raster::buildClusters({}, {}).empty());
  REQUIRE(engineClusters(Soup{"none", {{0, 0, 0}}, {}}).empty());
}
