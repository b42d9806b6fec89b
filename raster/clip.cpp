#include "obscura/raster/clip.h"

#include <algorithm>
#include <cmath>

namespace obscura::raster {
namespace {

// Signed distance (scaled) of a view position to a clip plane: a x + b y + c zView + d, inside where >= 0.
struct ClipPlane {
  double a, b, c, d;
  int axis;     // 0, 1: a side of the guard band, x or y; 2: near or far
  float sign;   // of the side
  double distance(const glm::dvec3& p) const { return ((a * p.x + b * p.y) - c * p.z) + d; }
};

// Which points are cut off. For the guard band this is what the vertex stage decides, to the bit: a triangle that it
// leaves whole shares edges with triangles that are cut, and what it calls inside must stay where it is.
bool isInside(const View& v, const ClipPlane& plane, const glm::dvec3& p, double distance) {
  if (plane.axis == 2) return distance >= 0;
  const glm::vec3 q(p);
  const float inverse = v.perspective ? 1.0f / -q.z : 1.0f;
  const float at = plane.axis == 0 ? (q.x * inverse) * v.xScaleSub + v.xShiftSub : (q.y * inverse) * v.yScaleSub + v.yShiftSub;
  return plane.sign * at <= float(kGuardSub);
}

// The band is cut a little inside of what the vertex stage accepts: projecting rounds.
constexpr double kGuard = kGuardSub - 64;

int makePlanes(const View& v, ClipPlane planes[6]) {
  int n = 0;
  planes[n++] = {0, 0, 1, -double(v.zNear), 2, 0};
  planes[n++] = {0, 0, -1, double(v.zFar), 2, 0};
  for (double sign : {1.0, -1.0}) {
    // sign * xSub <= guard, multiplied by zView in the perspective case.
    if (v.perspective) {
      planes[n++] = {-sign * v.xScaleSub, 0, kGuard - sign * v.xShiftSub, 0, 0, float(sign)};
      planes[n++] = {0, -sign * v.yScaleSub, kGuard - sign * v.yShiftSub, 0, 1, float(sign)};
    } else {
      planes[n++] = {-sign * v.xScaleSub, 0, 0, kGuard - sign * v.xShiftSub, 0, float(sign)};
      planes[n++] = {0, -sign * v.yScaleSub, 0, kGuard - sign * v.yShiftSub, 1, float(sign)};
    }
  }
  return n;
}

}  // namespace

int clipTriangle(const View& view, const glm::vec3 triangle[3], glm::vec3 polygon[kMaxClipped]) {
  glm::dvec3 buffers[2][kMaxClipped];
  int count = 3;
  for (int i = 0; i < 3; ++i) {
    buffers[0][i] = glm::dvec3(triangle[i]);
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(triangle[i][c])) return 0;
  }
  ClipPlane planes[6];
  const int planeCount = makePlanes(view, planes);
  int from = 0;
  for (int k = 0; k < planeCount; ++k, from ^= 1) {
    const glm::dvec3* in = buffers[from];
    glm::dvec3* out = buffers[from ^ 1];
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const glm::dvec3 &p = in[i], &q = in[(i + 1) % count];
      const double dp = planes[k].distance(p), dq = planes[k].distance(q);
      const bool outwards = isInside(view, planes[k], p, dp);
      if (outwards) out[kept++] = p;
      if (outwards != isInside(view, planes[k], q, dq)) {
        const glm::dvec3 &inner = outwards ? p : q, &outer = outwards ? q : p;
        const double di = outwards ? dp : dq, dOut = outwards ? dq : dp;
        // Between the plane and what counts as inside, the inner vertex itself is the end.
        const double t = di > 0 && dOut < 0 ? di / (di - dOut) : 0;
        // Where the vertices are far apart the sum loses z: it never leaves the view's range, and on its plane is exact.
        const double zView = k == 0 ? view.zNear : k == 1 ? view.zFar : -(inner.z + (outer.z - inner.z) * t);
        out[kept++] = {inner.x + (outer.x - inner.x) * t, inner.y + (outer.y - inner.y) * t,
                       -std::clamp(zView, double(view.zNear), double(view.zFar))};
      }
    }
    count = kept;
    if (count < 3) return 0;
  }
  for (int i = 0; i < count; ++i) polygon[i] = glm::vec3(buffers[from][i]);
  return count;
}

void snapVertex(const View& view, glm::vec3 p, int32_t& xSub, int32_t& ySub, float& key) {
  const float inverse = view.perspective ? 1.0f / -p.z : 1.0f;
  const float guard = float(kGuardSub);
  const float xs = (p.x * inverse) * view.xScaleSub + view.xShiftSub;
  const float ys = (p.y * inverse) * view.yScaleSub + view.yShiftSub;
  // The clamp only catches what rounding pushed beyond the band.
  xSub = int32_t(std::nearbyint(std::clamp(xs, -guard, guard)));
  ySub = int32_t(std::nearbyint(std::clamp(ys, -guard, guard)));
  key = view.perspective ? inverse : p.z;
}

}  // namespace obscura::raster
