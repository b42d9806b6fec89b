#include "obscura/raster/clusters.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace obscura::raster {
namespace {

constexpr uint32_t kPad = 16;
constexpr uint8_t kNoSlot = 0xFF;
static_assert(Clusters::kMaxVertices <= kNoSlot, "a cluster-local vertex is one byte, one value means none");

// coneCos is this much below the smallest cosine found in double precision: it covers a culling test of up to some
// hundred float roundings (2^-24 each) and costs 0.3 degrees on a flat cluster.
constexpr double kConeMargin = 1.0 / 65536;
// The same for the sphere, relative to its radius.
constexpr double kRadiusMargin = 1.0 / (1 << 20);

uint32_t padded(uint32_t n) { return (n + kPad - 1) / kPad * kPad; }

bool finite(const glm::vec3& p) { return p.x - p.x == 0 && p.y - p.y == 0 && p.z - p.z == 0; }

struct Vec {
  double x = 0, y = 0, z = 0;
};
Vec vec(const glm::vec3& v) { return {v.x, v.y, v.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// The cluster that is being filled, in arrays of fixed size.
struct Builder {
  uint32_t vertexCount = 0, triangleCount = 0;
  std::array<uint32_t, Clusters::kMaxVertices> vertex;  // number in the mesh
  std::array<glm::vec3, Clusters::kMaxVertices> position;
  std::array<uint32_t, Clusters::kMaxTriangles> triangle;
  std::array<uint32_t, Clusters::kMaxTriangles> corners;
  std::array<Vec, Clusters::kMaxTriangles> normal;  // exact but for double's rounding
};

// The largest squared distance of a finite vertex from `center`, and which vertex that is.
double farthest(const Builder& b, Vec center, uint32_t* which) {
  double best = -1;
  for (uint32_t i = 0; i < b.vertexCount; ++i) {
    const Vec d = vec(b.position[i]) - center;
    const double square = dot(d, d);
    if (square > best && finite(b.position[i])) best = square, *which = i;
  }
  return best;
}

// The margin is 16 times the rounding to float; FLT_MIN stands in for it where that rounding is not relative.
void setSphere(Cluster& c, glm::vec3 center, double squaredRadius) {
  const double radius = std::sqrt(squaredRadius) * (1 + kRadiusMargin) + FLT_MIN;
  c.center = center;
  c.radius = radius < FLT_MAX ? float(radius) : HUGE_VALF;
}

// The smaller of two spheres: around the middle of the box, and around the farthest pair found by two sweeps. The
// radius is always measured from the centre as rounded to float. All of it is 0 without a finite vertex.
void boundSphere(const Builder& b, Cluster& c) {
  Vec lo, hi;
  bool any = false;
  for (uint32_t i = 0; i < b.vertexCount; ++i) {
    if (!finite(b.position[i])) continue;
    const Vec p = vec(b.position[i]);
    if (!any) lo = hi = p;
    any = true;
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  if (!any) return;
  const auto middle = [](Vec p, Vec q) {
    return glm::vec3(float((p.x + q.x) * 0.5), float((p.y + q.y) * 0.5), float((p.z + q.z) * 0.5));
  };
  uint32_t p = 0, q = 0, unused = 0;
  const glm::vec3 boxCenter = middle(lo, hi);
  const double boxSquare = farthest(b, vec(boxCenter), &p);
  farthest(b, vec(b.position[p]), &q);
  const glm::vec3 pairCenter = middle(vec(b.position[p]), vec(b.position[q]));
  const double pairSquare = farthest(b, vec(pairCenter), &unused);
  if (pairSquare < boxSquare) setSphere(c, pairCenter, pairSquare);
  else setSphere(c, boxCenter, boxSquare);
}

// Around the mean of the unit normals; none (coneCos -1) where that is 0, wider than a half space, or where a vertex
// or a plane is not finite. Triangles of plane 0 never face anything and do not widen it.
void boundNormals(const Builder& b, Cluster& c) {
  c.coneAxis = glm::vec3(0, 0, 1);
  c.coneCos = -1;
  std::array<Vec, Clusters::kMaxTriangles> unit;
  uint32_t count = 0;
  Vec sum;
  for (uint32_t t = 0; t < b.triangleCount; ++t) {
    const Vec n = b.normal[t];
    const double square = dot(n, n);  // products of floats' products: neither overflows nor, unless n is 0, vanishes
    if (square == 0) continue;
    const double scale = 1 / std::sqrt(square);
    unit[count] = {n.x * scale, n.y * scale, n.z * scale};
    sum = {sum.x + unit[count].x, sum.y + unit[count].y, sum.z + unit[count].z};
    ++count;
  }
  const double length = std::sqrt(dot(sum, sum));
  if (!(length > 1e-3)) return;  // NaN too: one value that is not finite in any plane makes the sum NaN
  const glm::vec3 axis(float(sum.x / length), float(sum.y / length), float(sum.z / length));
  double least = 1;
  for (uint32_t i = 0; i < count; ++i) least = std::min(least, dot(unit[i], vec(axis)));
  least -= kConeMargin;
  if (least <= 0) return;
  c.coneAxis = axis;
  c.coneCos = float(least);
}

// Planes shorter than this are not used: products with them could underflow.
constexpr double kSmallestPlane = 1e-18;

// Appends the builder's cluster to `out`, with planes, padding and bounds.
void flush(Builder& b, Clusters& out) {
  if (b.triangleCount == 0) return;
  Cluster c;
  c.firstVertex = uint32_t(out.x.size());
  c.vertexCount = b.vertexCount;
  c.firstTriangle = uint32_t(out.triangle.size());
  c.triangleCount = b.triangleCount;
  boundSphere(b, c);
  const size_t vertexEnd = out.x.size() + padded(b.vertexCount);
  for (auto* v : {&out.x, &out.y, &out.z}) v->resize(vertexEnd);
  for (uint32_t i = 0; i < padded(b.vertexCount); ++i) {
    const glm::vec3 p = b.position[i < b.vertexCount ? i : 0];
    out.x[c.firstVertex + i] = p.x;
    out.y[c.firstVertex + i] = p.y;
    out.z[c.firstVertex + i] = p.z;
  }
  const size_t triangleEnd = out.triangle.size() + padded(b.triangleCount);
  out.corners.resize(triangleEnd);  // the padding's corners 0 0 0 and plane 0 are a degenerate triangle
  for (auto* v : {&out.planeX, &out.planeY, &out.planeZ, &out.planeW}) v->resize(triangleEnd);
  out.triangle.resize(triangleEnd, b.triangle[0]);
  for (uint32_t t = 0; t < b.triangleCount; ++t) {
    const size_t at = c.firstTriangle + t;
    out.triangle[at] = b.triangle[t];
    const uint32_t corners = out.corners[at] = b.corners[t];
    const glm::vec3 v0 = b.position[corners & 255];
    const Vec e1 = vec(b.position[corners >> 8 & 255]) - vec(v0), e2 = vec(b.position[corners >> 16]) - vec(v0);
    const Vec exact{e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
    b.normal[t] = exact;
    // Where float would lose bits to underflow, no plane at all: every such triangle is decided exactly.
    const double size = std::max({std::fabs(exact.x), std::fabs(exact.y), std::fabs(exact.z)});
    const float unknown = std::numeric_limits<float>::quiet_NaN();
    const glm::vec3 n = size > 0 && size < kSmallestPlane ? glm::vec3(unknown) : glm::vec3(float(exact.x), float(exact.y), float(exact.z));
    out.planeX[at] = n.x;
    out.planeY[at] = n.y;
    out.planeZ[at] = n.z;
    const glm::vec3 d = v0 - c.center;
    out.planeW[at] = n.x * d.x + n.y * d.y + n.z * d.z;
  }
  boundNormals(b, c);
  out.clusters.push_back(c);
}

// Around the box of all clusters' spheres; those without a finite vertex (radius 0) count for nothing.
void boundAll(Clusters& out) {
  Vec lo, hi;
  bool any = false;
  for (const Cluster& c : out.clusters) {
    if (c.radius == 0) continue;
    const Vec p = vec(c.center);
    const double r = c.radius;
    if (!any) lo = {p.x - r, p.y - r, p.z - r}, hi = {p.x + r, p.y + r, p.z + r};
    any = true;
    lo = {std::min(lo.x, p.x - r), std::min(lo.y, p.y - r), std::min(lo.z, p.z - r)};
    hi = {std::max(hi.x, p.x + r), std::max(hi.y, p.y + r), std::max(hi.z, p.z + r)};
  }
  if (!any) return;
  const auto middle = [](double a, double b) {
    const double m = (a + b) * 0.5;
    return m >= -FLT_MAX && m <= FLT_MAX ? float(m) : 0.0f;  // infinite radii give NaN
  };
  out.center = glm::vec3(middle(lo.x, hi.x), middle(lo.y, hi.y), middle(lo.z, hi.z));
  double radius = 0;
  for (const Cluster& c : out.clusters) {
    if (c.radius == 0) continue;
    const Vec d = vec(c.center) - vec(out.center);
    radius = std::max(radius, std::sqrt(dot(d, d)) + double(c.radius));
  }
  radius = radius * (1 + kRadiusMargin);
  out.radius = radius < FLT_MAX ? float(radius) : HUGE_VALF;
}

bool isPermutation(Span<const uint32_t> order, uint32_t count) {
  if (order.size() != count) return false;
  std::vector<uint8_t> seen(count);
  for (const uint32_t t : order) {
    if (t >= count || seen[t]) return false;
    seen[t] = 1;
  }
  return true;
}

}  // namespace

Clusters buildClusters(Span<const glm::vec3> positions, Span<const uint32_t> indices, Span<const uint32_t> order,
                       Span<const uint32_t> counts) {
  Clusters out;
  out.triangleCount = uint32_t(indices.size() / 3);
  const bool ordered = isPermutation(order, out.triangleCount);
  const size_t expected = size_t(out.triangleCount) + out.triangleCount / 8 + kPad;
  for (auto* v : {&out.x, &out.y, &out.z, &out.planeX, &out.planeY, &out.planeZ, &out.planeW}) v->reserve(expected);
  out.corners.reserve(expected);
  out.triangle.reserve(expected);

  std::vector<uint8_t> slots(positions.size(), kNoSlot);  // cluster-local number of each vertex of the mesh
  Builder b;
  const auto close = [&] {
    flush(b, out);
    for (uint32_t i = 0; i < b.vertexCount; ++i) slots[b.vertex[i]] = kNoSlot;
    b.vertexCount = b.triangleCount = 0;
  };
  size_t group = 0;
  uint64_t groupEnd = counts.empty() ? UINT64_MAX : counts[0];
  for (uint32_t k = 0; k < out.triangleCount; ++k) {
    const uint32_t t = ordered ? order[k] : k;
    const uint32_t* corners = indices.data() + size_t(t) * 3;
    for (int i = 0; i < 3; ++i)
      if (corners[i] >= positions.size())
        throw std::invalid_argument("obscura raster: triangle " + std::to_string(t) + " has vertex " + std::to_string(corners[i]) +
                                    " of " + std::to_string(positions.size()));
    while (k >= groupEnd) {
      close();
      groupEnd = ++group < counts.size() ? groupEnd + counts[group] : UINT64_MAX;
    }
    uint32_t fresh = 0;  // counts a vertex that the triangle names twice twice: at worst a cluster ends early
    for (int i = 0; i < 3; ++i) fresh += slots[corners[i]] == kNoSlot;
    if (b.triangleCount == Clusters::kMaxTriangles || b.vertexCount + fresh > Clusters::kMaxVertices) close();
    uint32_t packed = 0;
    for (int i = 0; i < 3; ++i) {
      const uint32_t v = corners[i];
      if (slots[v] == kNoSlot) {
        slots[v] = uint8_t(b.vertexCount);
        b.vertex[b.vertexCount] = v;
        b.position[b.vertexCount++] = positions[v];
      }
      packed |= uint32_t(slots[v]) << (8 * i);
    }
    b.corners[b.triangleCount] = packed;
    b.triangle[b.triangleCount++] = t;
  }
  close();
  boundAll(out);
  return out;
}

}  // namespace obscura::raster
