#include "obscura/raster/cull.h"

#include <cmath>

namespace obscura::raster {
namespace {

// Relative slack of every test here; a float expression of this length errs by some 1e-6.
constexpr float kSlack = 1e-4f;

}  // namespace

bool sphereVisible(const View& view, const Draw& draw, const glm::vec3& center, float radius) {
  float p[3], size = 0;
  for (int r = 0; r < 3; ++r) {
    const float* m = draw.viewFromObject[r];
    p[r] = m[0] * center.x + m[1] * center.y + m[2] * center.z + m[3];
    size += std::fabs(m[0] * center.x) + std::fabs(m[1] * center.y) + std::fabs(m[2] * center.z) + std::fabs(m[3]);
  }
  const float reach = radius * draw.maxScale + (size + radius * draw.maxScale) * kSlack;
  if (!(reach < 1e18f)) return true;  // NaN, infinite or near overflow: the triangles decide one by one
  const float zView = -p[2];
  if (zView + reach < view.zNear || zView - reach > view.zFar) return false;
  // Each side plane with a pixel to spare for snapping: (x scale) + zView (shift - first + 1 pixel) >= 0 on the left and
  // above, -(x scale) + zView (last + 1 pixel - shift) >= 0 on the right and below.
  const float scale[2] = {view.xScaleSub, view.yScaleSub}, shift[2] = {view.xShiftSub, view.yShiftSub};
  const float toFirst[2] = {float(kSub - view.xFirstSub), float(kSub - view.yFirstSub)};
  const float toLast[2] = {float(view.xLastSub + kSub), float(view.yLastSub + kSub)};
  for (int axis = 0; axis < 2; ++axis)
    for (float sign : {1.f, -1.f}) {
      const float a = sign * scale[axis], b = (sign > 0 ? toFirst : toLast)[axis] + sign * shift[axis];
      const float distance = view.perspective ? a * p[axis] + b * zView : a * p[axis] + b;
      const float length = view.perspective ? std::sqrt(a * a + b * b) : std::fabs(a);
      const float slack = view.perspective ? 0 : b * kSlack;
      if (distance + reach * length * (1 + kSlack) + std::fabs(slack) < 0) return false;
    }
  return true;
}

bool clusterFacesEye(const Draw& draw, const Cluster& cluster) {
  if (draw.material->doubleSided || !draw.invertible || cluster.coneCos <= 0) return true;
  // From the eye to the centre, and how far a vertex may be from there.
  const float w = draw.eye[3];
  const glm::vec3 d = w > 0 ? glm::vec3(cluster.center.x - draw.eye[0], cluster.center.y - draw.eye[1], cluster.center.z - draw.eye[2])
                            : glm::vec3(-draw.eye[0], -draw.eye[1], -draw.eye[2]);
  const float square = d.x * d.x + d.y * d.y + d.z * d.z;
  if (!(square > 1e-30f && square < 1e30f)) return true;
  const float distance = std::sqrt(square);
  const float along = d.x * cluster.coneAxis.x + d.y * cluster.coneAxis.y + d.z * cluster.coneAxis.z;
  if (along <= 0) return true;
  // Every normal is within alpha of the axis, so its cosine with d is at least cos(theta + alpha) =
  // cos theta cos alpha - sin theta sin alpha; all faces are turned away if even that much exceeds the radius.
  const float across = std::sqrt(std::fmax(square - along * along, 0.f));
  const float sine = std::sqrt(std::fmax(1 - cluster.coneCos * cluster.coneCos, 0.f));
  return !(along * cluster.coneCos - across * sine > cluster.radius * w + (distance + cluster.radius * w) * kSlack * 4);
}

}  // namespace obscura::raster
