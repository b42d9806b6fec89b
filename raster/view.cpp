#include "obscura/raster/view.h"

#include <cmath>
#include <limits>

namespace obscura::raster {
namespace {

// a * b of affine matrices, in double and in one fixed order.
glm::dmat4 multiply(const glm::dmat4& a, const glm::dmat4& b) {
  glm::dmat4 m(1.0);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      m[c][r] = (a[0][r] * b[c][0] + a[1][r] * b[c][1]) + a[2][r] * b[c][2] + (c == 3 ? a[3][r] : 0.0);
  return m;
}

struct Cofactors {
  double m[3][3];  // m[r][c]: cofactor of element (r, c); the inverse transpose times the determinant
  double determinant;
};

Cofactors cofactors(const glm::dmat4& a) {
  Cofactors f;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      f.m[r][c] = a[c1][r1] * a[c2][r2] - a[c2][r1] * a[c1][r2];
    }
  f.determinant = a[0][0] * f.m[0][0] + a[1][0] * f.m[0][1] + a[2][0] * f.m[0][2];
  return f;
}

}  // namespace

View makeView(const Camera& camera, int width, int height, const std::optional<Window>& window) {
  const Window w = window.value_or(Window{0, 0, width, height});
  const int32_t xHalfSub = width * (kSub / 2), yHalfSub = height * (kSub / 2);
  View v;
  v.left = w.x;
  v.top = w.y;
  v.width = w.width;
  v.height = w.height;
  v.perspective = camera.projection == Projection::Perspective;
  v.xFirstSub = w.x * kSub - xHalfSub;
  v.yFirstSub = w.y * kSub - yHalfSub;
  v.xLastSub = v.xFirstSub + w.width * kSub;
  v.yLastSub = v.yFirstSub + w.height * kSub;
  v.xScaleSub = camera.xScale * float(xHalfSub);
  v.yScaleSub = -(camera.yScale * float(yHalfSub));
  v.xShiftSub = camera.xShift * float(xHalfSub);
  v.yShiftSub = -(camera.yShift * float(yHalfSub));
  v.zNear = camera.zNear;
  v.zFar = camera.zFar > 0 ? camera.zFar : std::numeric_limits<float>::max();
  return v;
}

std::vector<Draw> makeDraws(const DrawList& list, const Camera& camera) {
  std::vector<Draw> draws;
  draws.reserve(list.instances.size());
  uint32_t firstTriangle = 0;
  for (const Instance& instance : list.instances) {
    Draw d;
    d.instance = uint32_t(&instance - list.instances.data());
    d.mesh = instance.mesh;
    d.clusters = instance.mesh->clusters;
    d.material = &list.materials[instance.material];
    d.materialIndex = instance.material;
    d.triangleCount = instance.mesh->triangleCount();
    d.firstTriangle = firstTriangle;
    firstTriangle += d.triangleCount;
    if (d.triangleCount == 0) continue;

    const glm::dmat4 m = multiply(camera.viewFromWorld, instance.worldFromObject);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) d.viewFromObject[r][c] = float(m[c][r]);

    const Cofactors f = cofactors(m);
    double squares = 0, largest = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        squares += m[c][r] * m[c][r];
        largest = std::fmax(largest, std::fabs(f.m[r][c]));
      }
    d.maxScale = float(std::sqrt(squares)) * 1.0001f;  // the Frobenius norm bounds the spectral norm
    d.mirrored = f.determinant < 0;
    d.invertible = std::isfinite(f.determinant) && std::fabs(f.determinant) > 0 && std::isfinite(1 / f.determinant) &&
                   std::isfinite(squares);
    // Normals are normalised later, so a scale does not matter; this one keeps them far from overflow. A mirroring
    // matrix has negative cofactors: the sign keeps the outside outside.
    const double scale = largest > 0 ? (d.mirrored ? -1 : 1) / largest : 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) d.normalToView[r][c] = float(f.m[r][c] * scale);

    const bool perspective = camera.projection == Projection::Perspective;
    for (int c = 0; c < 3; ++c) {
      // The inverse's row c is cofactor column c over the determinant. Eye at the view's origin, or at +z infinity.
      const double e = perspective ? -(f.m[0][c] * m[3][0] + f.m[1][c] * m[3][1] + f.m[2][c] * m[3][2]) : f.m[2][c];
      d.eye[c] = d.invertible ? float(e / f.determinant) : 0.f;
      d.invertible = d.invertible && std::isfinite(d.eye[c]);
    }
    d.eye[3] = perspective ? 1.f : 0.f;
    draws.push_back(d);
  }
  return draws;
}

}  // namespace obscura::raster
