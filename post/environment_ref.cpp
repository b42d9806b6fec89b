// Scalar twins of what looks into an environment cube.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/post/ambient_light.h"
#include "obscura/post/brdf_ref.h"
#include "obscura/post/environment_background.h"
#include "obscura/post/environment_reflection.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

glm::vec3 lookUp(const EnvironmentChain& chain, int level, const glm::vec3& v) {
  constexpr int kRight[6] = {2, -2, 0, 0, -9, 0}, kUp[6] = {1, 1, 2, -2, 1, 1};  // axis, negative: against it; -9: against x
  const glm::vec3 a(std::fabs(v.x), std::fabs(v.y), std::fabs(v.z));
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2, face = 2 * axis + (v[axis] < 0);
  const float right = kRight[face] == -9 ? -v.x : kRight[face] < 0 ? -v.z : v[kRight[face]], up = kUp[face] < 0 ? -v.z : v[kUp[face]];
  const int size = chain.sizes[level];
  const float half = 0.5f * float(size), middle = half + 0.5f, most = float(size) + 0.5f;
  const auto kept = [&](float at) { return !(at > 0.5f) ? 0.5f : std::min(at, most); };
  const float x = kept(right / a[axis] * half + middle), y = kept(-(up / a[axis]) * half + middle);
  const int i = int(x), j = int(y);
  const float u = x - float(i), w = y - float(j);
  const auto texel = [&](int column, int row) {
    const int n = size + 2;
    return chain.texels[size_t(chain.first(level) + (face * n + row) * n + column)];
  };
  const glm::vec3 above = texel(i, j) * (1 - u) + texel(i + 1, j) * u, below = texel(i, j + 1) * (1 - u) + texel(i + 1, j + 1) * u;
  return above * (1 - w) + below * w;
}

glm::vec3 trilinear(const EnvironmentChain& chain, const glm::vec3& v, float roughness) {
  const int k = int(roughness * 8);
  const glm::vec3 fine = lookUp(chain, k, v), coarse = lookUp(chain, std::min(k + 1, 8), v);
  return fine + (coarse - fine) * (roughness * 8 - float(k));
}

glm::vec3 turned(const glm::mat3& m, const glm::vec3& v) {
  glm::vec3 out;
  for (int k = 0; k < 3; ++k) out[k] = m[0][k] * v.x + m[1][k] * v.y + m[2][k] * v.z;
  return out;
}

float specularOcclusion(float o, float nv, float roughness) {
  const float s = 1 - roughness, s10 = s * s * (s * s) * (s * s * (s * s)) * (s * s);
  const float value = o + (std::sqrt(nv + o) - 1) * s10;
  return !(value > 0) ? 0 : std::min(value, 1.0f);
}

}  // namespace

void environmentBackgroundRef(const BackgroundInput& in, int y0, int y1, LinearColor& out) {
  const raster::FloatEnvironment environment;
  const Projector& p = in.projector;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) {
      if (in.g->depth.at(x, y) < std::numeric_limits<float>::infinity()) continue;
      glm::vec3 view(0, 0, -1);
      if (p.perspective) {
        view.x = (float(p.xFirst + x) + 0.5f - p.xCenter) * p.xInverse;
        view.y = (float(p.yFirst + y) + 0.5f - p.yCenter) * p.yInverse;
      }
      const glm::vec3 radiance = lookUp(in.environment.chain, 0, turned(in.environment.mapFromView, view));
      for (int c = 0; c < 3; ++c) out.rgb[c].at(x, y) = radiance[c] * in.environment.intensity;
    }
}

void environmentReflectionRef(const ReflectionInput& in, int y0, int y1, LinearColor& out) {
  const raster::FloatEnvironment environment;
  const raster::GBuffer& g = *in.g;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < g.width; ++x) {
      if (!(g.depth.at(x, y) < std::numeric_limits<float>::infinity())) continue;
      const glm::vec3 v = ref::viewDirection(in.projector, x, y), n(g.normal[0].at(x, y), g.normal[1].at(x, y), g.normal[2].at(x, y));
      const float cosine = n.x * v.x + n.y * v.y + n.z * v.z, given = g.roughness.at(x, y);
      const float roughness = given > 0 ? std::min(given, 1.0f) : given <= 0 ? 0 : 1;  // no number: 1
      const glm::vec3 r = 2 * cosine * n - v;
      const float alpha = roughness * roughness, s = 1 - alpha;
      const glm::vec3 along = n + (r - n) * (s * (std::sqrt(s) + alpha));
      glm::vec3 light = trilinear(in.environment.chain, turned(in.environment.mapFromView, along), roughness) * in.environment.intensity;
      if (hasOwnLight(in.instances, g.instance, x, y)) light = in.instances[g.instance.at(x, y)];
      if (in.obscurance) {
        const float facing = std::fabs(cosine) > kLeastFacing ? std::min(std::fabs(cosine), 1.0f) : kLeastFacing;
        light *= specularOcclusion(in.obscurance->at(x, y), facing, roughness);
      }
      for (int c = 0; c < 3; ++c) out.rgb[c].at(x, y) = light[c];
    }
}

}  // namespace obscura::post
