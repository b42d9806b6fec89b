#include <cmath>

#include "obscura/raster/clip.h"
#include "obscura/raster/setup.h"

namespace obscura::raster {
namespace {

void corners(const Draw& draw, uint32_t triangle, glm::vec3 v[3]) {
  for (int i = 0; i < 3; ++i) v[i] = draw.mesh->positions[draw.mesh->indices[size_t(triangle) * 3 + size_t(i)]];
}

glm::vec3 viewPosition(const Draw& draw, const glm::vec3& p) {
  float r[3];
  for (int i = 0; i < 3; ++i) {
    const float* m = draw.viewFromObject[i];
    r[i] = ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
  }
  return {r[0], r[1], r[2]};
}

}  // namespace

bool facesEye(const Draw& draw, uint32_t triangle) {
  glm::vec3 corner[3];
  corners(draw, triangle, corner);
  const glm::dvec3 v0(corner[0]), e1 = glm::dvec3(corner[1]) - v0, e2 = glm::dvec3(corner[2]) - v0;
  const glm::dvec3 n(e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x);
  const glm::dvec3 eye(draw.eye[0], draw.eye[1], draw.eye[2]), d = draw.eye[3] > 0 ? eye - v0 : eye;
  const double side = (n.x * d.x + n.y * d.y) + n.z * d.z;
  return draw.away ? side < 0 : side > 0;
}

void setupSingle(const View& view, const Draw& draw, uint32_t triangle, Bins& bins, Statistics& statistics) {
  glm::vec3 v[3];
  corners(draw, triangle, v);
  bool needsClip = false;
  for (glm::vec3& p : v) {
    p = viewPosition(draw, p);
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(p[c])) {
        ++statistics.invalid;
        return;
      }
    const float inverse = view.perspective ? 1.0f / -p.z : 1.0f;
    const float xs = (p.x * inverse) * view.xScaleSub + view.xShiftSub, ys = (p.y * inverse) * view.yScaleSub + view.yShiftSub;
    needsClip |= !(-p.z >= view.zNear) || -p.z > view.zFar || !(std::fabs(xs) <= float(kGuardSub)) || !(std::fabs(ys) <= float(kGuardSub));
  }
  glm::vec3 polygon[kMaxClipped] = {v[0], v[1], v[2]};
  int count = 3;
  if (needsClip) {
    ++statistics.clipped;
    count = clipTriangle(view, v, polygon);
  }
  bool drawn = false, anyArea = false;
  SnappedTriangle t;
  for (int i = 1; i + 1 < count; ++i) {
    const int fan[3] = {0, i, i + 1};
    for (int c = 0; c < 3; ++c) snapVertex(view, polygon[fan[c]], t.x[c], t.y[c], t.key[c]);
    const int facing = draw.material->doubleSided ? 0 : draw.mirrored != draw.away ? -1 : 1;
    LargeTriangle large;
    large.id = draw.firstTriangle + triangle;
    large.masked = draw.material->alphaMode == AlphaMode::Mask;
    const SetupResult result = setupTriangle(view, t, facing, large);
    anyArea |= result != SetupResult::FacesAway;
    if (result != SetupResult::Covers) continue;
    drawn = true;
    bins.add(large);
  }
  ++(drawn ? statistics.drawn : anyArea || count < 3 ? statistics.outside : statistics.facingAway);
}

}  // namespace obscura::raster
