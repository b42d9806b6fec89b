// Scalar twin of light.cpp.
#include <algorithm>
#include <limits>

#include "obscura/post/brdf_ref.h"
#include "obscura/post/light.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

glm::vec3 fromEnvironment(const NormalQuadric& q, float x, float y, float z) {
  glm::vec3 la;
  for (int c = 0; c < 3; ++c) {
    const float ofX = (q.xx[c] * x + q.xy[c] * y + q.xz[c] * z + q.x[c]) * x, ofY = (q.yy[c] * y + q.yz[c] * z + q.y[c]) * y;
    const float sum = ofX + ofY + (q.zz[c] * z + q.z[c]) * z + q.constant[c];
    la[c] = !(sum > 0) ? 0 : std::min(sum, q.most[c]);
  }
  return la;
}

// D(n), or A(n).
glm::vec3 meanByDirection(const AmbientLight& in, glm::vec3 AmbientDirection::*of, const raster::GBuffer& g, int x, int y) {
  glm::vec3 sum(0), all(0);
  float weights = 0;
  for (const AmbientDirection& k : in.directions) {
    const float cosine = g.normal[0].at(x, y) * k.direction.x + g.normal[1].at(x, y) * k.direction.y +
                         g.normal[2].at(x, y) * k.direction.z;
    all += k.*of;
    if (!(cosine > 0)) continue;
    weights += cosine;
    sum += cosine * (k.*of);
  }
  return weights > 0 && weights < 1e8f ? sum / weights : all / float(in.directions.size());
}

glm::vec3 factorAt(const AmbientLight& in, const raster::GBuffer& g, int x, int y) {
  return in.directions.empty() ? glm::vec3(1) : meanByDirection(in, &AmbientDirection::color, g, x, y);
}

glm::vec3 ambientAt(const AmbientLight& in, const raster::GBuffer& g, int x, int y) {
  glm::vec3 la = in.color;
  if (in.environment) la = fromEnvironment(*in.environment, g.normal[0].at(x, y), g.normal[1].at(x, y), g.normal[2].at(x, y));
  if (hasOwnLight(in.instances, g.instance, x, y)) la = in.instances[g.instance.at(x, y)];
  la *= factorAt(in, g, x, y);
  return in.adds() ? la + meanByDirection(in, &AmbientDirection::added, g, x, y) : la;
}

bool isSeen(const raster::GBuffer& g, int x, int y) { return g.depth.at(x, y) < std::numeric_limits<float>::infinity(); }

glm::vec3 vectorAt(const raster::Plane<float> (&planes)[3], int x, int y) {
  return {planes[0].at(x, y), planes[1].at(x, y), planes[2].at(x, y)};
}

// The parts of R_A(v); of Lambert all of it is diffuse.
ref::Reflectance reflectanceAt(const LightInput& in, int x, int y) {
  const raster::GBuffer& g = *in.g;
  ref::Surface s;
  s.base = vectorAt(g.albedo, x, y);
  if (!isGlossy(in.brdf)) return {s.base, glm::vec3(0)};
  s.metallic = g.metallic.at(x, y), s.roughness = g.roughness.at(x, y);
  s.n = vectorAt(g.normal, x, y), s.v = ref::viewDirection(in.projector, x, y);
  return ref::ambientReflectance(in.brdf, s);
}

}  // namespace

void lightRef(const LightInput& in, int y0, int y1, LinearColor& out) {
  const raster::FloatEnvironment environment;
  const raster::GBuffer& g = *in.g;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < g.width; ++x) {
      const glm::vec3 la = ambientAt(in.ambient, g, x, y);
      const ref::Reflectance r = reflectanceAt(in, x, y);
      const bool mirrors = isGlossy(in.brdf) && in.reflected;
      const glm::vec3 factor = factorAt(in.ambient, g, x, y);
      for (int c = 0; c < 3; ++c) {
        const float a = mirrors || !isGlossy(in.brdf) ? r.diffuse[c] : r.diffuse[c] + r.specular[c];
        float reflected = a * la[c];
        if (in.occlusion == Occlusion::Obscurance) reflected = a * in.transfer->obscurance.at(x, y) * la[c];
        if (in.occlusion == Occlusion::Transfer)
          reflected = in.transfer->bounced[c].empty()
                          ? a * in.transfer->w[c].at(x, y) * la[c]
                          : a * (in.transfer->obscurance.at(x, y) * la[c] + in.transfer->bounced[c].at(x, y));
        if (mirrors) reflected += r.specular[c] * factor[c] * in.reflected->rgb[c].at(x, y);
        if (mirrors && in.ambient.adds()) {
          float dims = 1;
          if (in.occlusion == Occlusion::Transfer && in.transfer->bounced[c].empty()) dims = in.transfer->w[c].at(x, y);
          else if (in.occlusion != Occlusion::None) dims = in.transfer->obscurance.at(x, y);
          reflected += r.specular[c] * dims * meanByDirection(in.ambient, &AmbientDirection::added, g, x, y)[c];
        }
        if (in.direct) reflected += in.direct->rgb[c].at(x, y);
        const float emitted = g.emissive[c].empty() ? 0 : g.emissive[c].at(x, y);
        out.rgb[c].at(x, y) = isSeen(g, x, y) ? reflected + emitted : in.background[c];
      }
    }
}

void transferOfBouncedRef(const LightInput& in, int y0, int y1, raster::Plane<float> (&w)[3]) {
  const raster::FloatEnvironment environment;
  const raster::GBuffer& g = *in.g;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < g.width; ++x) {
      const glm::vec3 la = ambientAt(in.ambient, g, x, y);
      for (int c = 0; c < 3; ++c) {
        const float o = in.transfer->obscurance.at(x, y), b = in.transfer->bounced[c].at(x, y);
        const float sum = la[c] > 0 ? std::min(o + b / la[c], std::numeric_limits<float>::max()) : o;
        w[c].at(x, y) = isSeen(g, x, y) ? sum : 1;
      }
    }
}

}  // namespace obscura::post
