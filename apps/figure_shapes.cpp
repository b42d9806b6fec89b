#include "obscura/apps/figure_shapes.h"

#include "obscura/apps/demo_random.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using glm::dvec3;
constexpr double kTau = 6.283185307179586;

void addQuad(GlbMesh& mesh, const dvec3 (&corners)[4]) {
  const uint32_t first = uint32_t(mesh.positions.size());
  const dvec3 n = unit(cross(corners[1] - corners[0], corners[3] - corners[0]));
  for (const dvec3& p : corners) {
    mesh.positions.emplace_back(p);
    mesh.normals.emplace_back(n);
  }
  mesh.uvs.insert(mesh.uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
}

}  // namespace

GlbMesh makeSurface(const char* name, int columns, int rows, bool closed, const std::function<dvec3(double u, double v)>& at) {
  GlbMesh mesh;
  mesh.name = name;
  const uint32_t width = uint32_t(columns) + 1;
  std::vector<dvec3> points;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double u = closed && i == columns ? 0 : double(i) / columns, v = double(j) / rows;
      points.push_back(at(u, v));
      mesh.positions.emplace_back(points.back());
      mesh.uvs.emplace_back(float(i) / float(columns), float(v));
    }
  std::vector<dvec3> sums(points.size(), dvec3(0));
  const auto addTriangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    const dvec3 n = cross(points[b] - points[a], points[c] - points[a]);
    for (uint32_t k : {a, b, c}) {
      sums[k] += n;
      mesh.indices.push_back(k);
    }
  };
  for (uint32_t j = 0; j < uint32_t(rows); ++j)
    for (uint32_t i = 0; i < uint32_t(columns); ++i) {
      const uint32_t a = j * width + i, b = a + width;
      addTriangle(a, b, b + 1);
      addTriangle(a, b + 1, a + 1);
    }
  for (uint32_t j = 0; closed && j <= uint32_t(rows); ++j) {
    dvec3 &first = sums[j * width], &last = sums[j * width + width - 1];
    first = last = first + last;
  }
  for (const dvec3& n : sums) mesh.normals.emplace_back(dot(n, n) > 0 ? unit(n) : dvec3(0, 1, 0));
  return mesh;
}

GlbMesh makeTurned(const char* name, int columns, int rows, const std::function<glm::dvec2(double v)>& profile) {
  return makeSurface(name, columns, rows, true, [&](double u, double v) {
    const glm::dvec2 p = profile(v);
    return dvec3(p.x * raster::exactSin(kTau * u), p.y, p.x * raster::exactCos(kTau * u));
  });
}

GlbMesh makeBall(double radius, int columns) {
  return makeTurned("ball", columns, columns / 2, [radius](double v) {
    return radius * glm::dvec2(raster::exactSin(kTau / 2 * v), raster::exactCos(kTau / 2 * v));
  });
}

GlbMesh makeBox(dvec3 half) {
  GlbMesh mesh;
  mesh.name = "box";
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      dvec3 corners[4];
      for (int k = 0; k < 4; ++k) {
        corners[k][axis] = side * half[axis];
        corners[k][u] = (k == 1 || k == 2 ? 1 : -1) * side * half[u];
        corners[k][v] = (k >= 2 ? 1 : -1) * half[v];
      }
      addQuad(mesh, corners);
    }
  return mesh;
}

GlbMesh makeQuad(dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
  GlbMesh mesh;
  mesh.name = "quad";
  addQuad(mesh, {a, b, c, d});
  return mesh;
}

}  // namespace obscura::apps
