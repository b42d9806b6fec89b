#include "obscura/raster/cull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace obscura::raster {
namespace {

// Relative slack of every test here; a float expression of this length errs by some 1e-6.
constexpr float kSlack = 1e-4f;

constexpr float kMostReach = 1e18f;  // beyond, products come near to overflow

}  // namespace

ViewSphere viewSphere(const Draw& draw, const glm::vec3& center, float radius) {
  ViewSphere s;
  float size = 0;
  for (int r = 0; r < 3; ++r) {
    const float* m = draw.viewFromObject[r];
    s.p[r] = m[0] * center.x + m[1] * center.y + m[2] * center.z + m[3];
    size += std::fabs(m[0] * center.x) + std::fabs(m[1] * center.y) + std::fabs(m[2] * center.z) + std::fabs(m[3]);
  }
  s.reach = radius * draw.maxScale + (size + radius * draw.maxScale) * kSlack;
  return s;
}

bool sphereVisible(const View& view, const ViewSphere& sphere) {
  const float* p = sphere.p;
  const float reach = sphere.reach;
  if (!(reach < kMostReach)) return true;  // the triangles decide one by one
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

ScreenBound screenBound(const View& view, const ViewSphere& s) {
  ScreenBound b;
  b.x1 = view.width - 1;
  b.y1 = view.height - 1;
  const float first = -s.p[2] - s.reach, last = -s.p[2] + s.reach;
  b.nearestKey = std::numeric_limits<float>::infinity();
  if (!(s.reach < kMostReach) || (view.perspective && !(first > s.reach * kSlack))) return b;
  b.nearestKey = view.perspective ? 1 / first * (1 + kSlack) : -first + std::fabs(first) * kSlack;
  const float scale[2] = {view.xScaleSub, view.yScaleSub}, shift[2] = {view.xShiftSub, view.yShiftSub};
  const int32_t origin[2] = {view.xFirstSub, view.yFirstSub};
  int* const range[2][2] = {{&b.x0, &b.x1}, {&b.y0, &b.y1}};
  for (int axis = 0; axis < 2; ++axis) {
    // x / z of the box around the sphere is least and greatest in its corners.
    const float lo = s.p[axis] - s.reach, hi = s.p[axis] + s.reach;
    const float least = view.perspective ? lo / (lo < 0 ? first : last) : lo;
    const float most = view.perspective ? hi / (hi > 0 ? first : last) : hi;
    float from = least * scale[axis] + shift[axis], to = most * scale[axis] + shift[axis];
    if (from > to) std::swap(from, to);
    const float slack = (std::fabs(from) + std::fabs(to)) * kSlack + 2 * kSub;  // a pixel for snapping, one for rounding
    const auto pixel = [&](float sub) { return int(std::floor((sub - float(origin[axis])) * (1.0f / kSub))); };
    const float limit = 4.0f * kMaxImageSize * kSub;
    *range[axis][0] = std::max(*range[axis][0], pixel(std::clamp(from - slack, -limit, limit)));
    *range[axis][1] = std::min(*range[axis][1], pixel(std::clamp(to + slack, -limit, limit)));
  }
  return b;
}

ScreenBound boundOf(const View& view, const TransformedVertices& v) {
  const auto first = [](int32_t sub, int32_t origin) { return std::max((sub - origin + kSub / 2 - 1) >> kSubBits, 0); };
  const auto last = [](int32_t sub, int32_t origin, int size) { return std::min((sub - origin - kSub / 2) >> kSubBits, size - 1); };
  return {first(v.xLeast, view.xFirstSub), first(v.yLeast, view.yFirstSub), last(v.xGreatest, view.xFirstSub, view.width),
          last(v.yGreatest, view.yFirstSub, view.height), v.nearestKey};
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
  // Turning all normals round turns the axis round.
  const float alongAxis = d.x * cluster.coneAxis.x + d.y * cluster.coneAxis.y + d.z * cluster.coneAxis.z;
  const float along = draw.away ? -alongAxis : alongAxis;
  if (along <= 0) return true;
  // Every normal is within alpha of the axis, so its cosine with d is at least cos(theta + alpha) =
  // cos theta cos alpha - sin theta sin alpha; all faces are turned away if even that much exceeds the radius.
  const float across = std::sqrt(std::fmax(square - along * along, 0.f));
  const float sine = std::sqrt(std::fmax(1 - cluster.coneCos * cluster.coneCos, 0.f));
  return !(along * cluster.coneCos - across * sine > cluster.radius * w + (distance + cluster.radius * w) * kSlack * 4);
}

}  // namespace obscura::raster
