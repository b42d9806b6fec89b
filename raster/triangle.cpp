#include "obscura/raster/triangle.h"

#include <algorithm>
#include <cmath>

namespace obscura::raster {

SetupResult setupTriangle(const View& view, const SnappedTriangle& t, int facing, LargeTriangle& out) {
  const int64_t dx1 = t.x[1] - t.x[0], dy1 = t.y[1] - t.y[0], dx2 = t.x[2] - t.x[0], dy2 = t.y[2] - t.y[0];
  const int64_t area = dx1 * dy2 - dx2 * dy1;  // doubled; positive is clockwise on the screen, as y points down
  if (area == 0 || (facing > 0 && area > 0) || (facing < 0 && area < 0)) return SetupResult::FacesAway;

  const auto [minX, maxX] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [minY, maxY] = std::minmax({t.y[0], t.y[1], t.y[2]});
  out.x0 = std::max((minX - view.xFirstSub + kSub / 2 - 1) >> kSubBits, 0);
  out.y0 = std::max((minY - view.yFirstSub + kSub / 2 - 1) >> kSubBits, 0);
  out.x1 = std::min((maxX - view.xFirstSub - kSub / 2) >> kSubBits, view.width - 1);
  out.y1 = std::min((maxY - view.yFirstSub - kSub / 2) >> kSubBits, view.height - 1);
  if (out.x0 > out.x1 || out.y0 > out.y1) return SetupResult::Outside;

  const int order[3] = {0, area > 0 ? 1 : 2, area > 0 ? 2 : 1};
  for (int i = 0; i < 3; ++i) {
    const int p = order[i], q = order[(i + 1) % 3];
    const int32_t a = t.y[p] - t.y[q], b = t.x[q] - t.x[p];
    const bool topLeft = a > 0 || (a == 0 && b > 0);
    out.a[i] = a;
    out.b[i] = b;
    out.e[i] = int64_t(a) * (view.xCenterSub(0) - t.x[p]) + int64_t(b) * (view.yCenterSub(0) - t.y[p]) - (topLeft ? 0 : 1);
  }

  const double d1 = double(t.key[1]) - double(t.key[0]), d2 = double(t.key[2]) - double(t.key[0]);
  const double perArea = 1.0 / double(area);
  out.key0 = t.key[0];
  out.xGradient = float((d1 * double(dy2) - d2 * double(dy1)) * perArea);
  out.yGradient = float((d2 * double(dx1) - d1 * double(dx2)) * perArea);
  out.p0x = t.x[0];
  out.p0y = t.y[0];
  out.keyMin = std::min({t.key[0], t.key[1], t.key[2]});
  out.keyMax = std::max({t.key[0], t.key[1], t.key[2]});
  return SetupResult::Covers;
}

}  // namespace obscura::raster
