// Scalar twins of what looks into an environment cube.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/post/environment_background.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

glm::vec3 lookUp(const EnvironmentCube& cube, const glm::vec3& v) {
  constexpr int kRight[6] = {2, -2, 0, 0, -9, 0}, kUp[6] = {1, 1, 2, -2, 1, 1};  // axis, negative: against it; -9: against x
  const glm::vec3 a(std::fabs(v.x), std::fabs(v.y), std::fabs(v.z));
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2, face = 2 * axis + (v[axis] < 0);
  const float right = kRight[face] == -9 ? -v.x : kRight[face] < 0 ? -v.z : v[kRight[face]], up = kUp[face] < 0 ? -v.z : v[kUp[face]];
  const float half = 0.5f * float(cube.size), middle = 0.5f * float(cube.size + 1), most = float(cube.size) + 0.5f;
  const auto kept = [&](float at) { return !(at > 0.5f) ? 0.5f : std::min(at, most); };
  const float x = kept(right / a[axis] * half + middle), y = kept(-(up / a[axis]) * half + middle);
  const int i = int(x), j = int(y);
  const float u = x - float(i), w = y - float(j);
  const auto texel = [&](int column, int row) {
    const size_t n = size_t(cube.size + 2);
    return cube.texels[(size_t(face) * n + size_t(row)) * n + size_t(column)];
  };
  const glm::vec3 above = texel(i, j) * (1 - u) + texel(i + 1, j) * u, below = texel(i, j + 1) * (1 - u) + texel(i + 1, j + 1) * u;
  return above * (1 - w) + below * w;
}

}  // namespace

void environmentBackgroundRef(const BackgroundInput& in, int y0, int y1, LinearColor& out) {
  const raster::FloatEnvironment environment;
  const Projector& p = in.projector;
  const glm::mat3& m = in.environment.mapFromView;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) {
      if (in.g->depth.at(x, y) < std::numeric_limits<float>::infinity()) continue;
      glm::vec3 view(0, 0, -1);
      if (p.perspective) {
        view.x = (float(p.xFirst + x) + 0.5f - p.xCenter) * p.xInverse;
        view.y = (float(p.yFirst + y) + 0.5f - p.yCenter) * p.yInverse;
      }
      glm::vec3 d;
      for (int k = 0; k < 3; ++k) d[k] = m[0][k] * view.x + m[1][k] * view.y + m[2][k] * view.z;
      const glm::vec3 radiance = lookUp(in.environment.chain.mirror(), d);
      for (int c = 0; c < 3; ++c) out.rgb[c].at(x, y) = radiance[c] * in.environment.intensity;
    }
}

}  // namespace obscura::post
