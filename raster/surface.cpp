#include "obscura/raster/surface.h"

#include <cmath>

namespace obscura::raster {

void DrawRuns::find(Span<const Draw> draws) {
  constexpr uint32_t kMost = 4096;  // runs
  const uint32_t end = draws.empty() ? 0 : draws[draws.size() - 1].firstTriangle + draws[draws.size() - 1].triangleCount;
  shift = 0;
  while (end >> shift >= kMost) ++shift;
  draw.clear();
  for (uint32_t k = 0; k < draws.size(); ++k) {
    const uint32_t lastRun = (draws[k].firstTriangle + (draws[k].triangleCount - 1)) >> shift;
    while (draw.size() <= lastRun) draw.push_back(k);
  }
  draw.push_back(uint32_t(draws.size()) - 1);
}

WeightPlanes weightPlanes(const View& view, const Draw& draw, const uint32_t vertex[3], int x, int y) {
  const double xc = double(view.xCenterSub(x)) - double(view.xShiftSub), yc = double(view.yCenterSub(y)) - double(view.yShiftSub);
  double w[3], hx[3], hy[3];
  for (int i = 0; i < 3; ++i) {
    const glm::vec3& o = draw.mesh->positions[vertex[i]];
    double p[3];
    for (int r = 0; r < 3; ++r) {
      const float* m = draw.viewFromObject[r];
      p[r] = ((double(m[0]) * double(o.x) + double(m[1]) * double(o.y)) + double(m[2]) * double(o.z)) + double(m[3]);
    }
    w[i] = view.perspective ? -p[2] : 1.0;
    hx[i] = p[0] * double(view.xScaleSub) - w[i] * xc;
    hy[i] = p[1] * double(view.yScaleSub) - w[i] * yc;
  }
  double planes[3][3], largest = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    planes[0][i] = hx[j] * hy[k] - hy[j] * hx[k];
    planes[1][i] = (w[k] * hy[j] - w[j] * hy[k]) * kSub;
    planes[2][i] = (w[j] * hx[k] - w[k] * hx[j]) * kSub;
    for (const auto& plane : planes) largest = std::fabs(plane[i]) > largest ? std::fabs(plane[i]) : largest;
  }
  const double scale = 1.0 / largest;
  WeightPlanes out;
  for (int i = 0; i < 3; ++i) {
    out.c[i] = float(planes[0][i] * scale);
    out.gx[i] = float(planes[1][i] * scale);
    out.gy[i] = float(planes[2][i] * scale);
  }
  return out;
}

}  // namespace obscura::raster
