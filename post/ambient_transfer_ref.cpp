// Scalar twin of ambient_transfer.cpp, line by line after the long paper's shader (section 5).
#include <cmath>
#include <limits>

#include <glm/vec3.hpp>

#include "obscura/post/ambient_transfer.h"
#include "obscura/post/depth_map_ref.h"
#include "obscura/post/line_samples.h"
#include "obscura/post/ray_march.h"
#include "obscura/post/sample_sets.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/relief.h"

namespace obscura::post {
namespace {

// Below the height map that displaces the pixel, at an offset from its point.
bool belowRelief(const TransferInput& in, int x, int y, const glm::vec3& offset) {
  const raster::GBuffer& g = *in.g;
  if (in.heights.empty() || g.heightMap.empty() || g.heightMap.at(x, y) == raster::kNoTriangle) return false;
  glm::vec3 p;
  for (int c = 0; c < 3; ++c) {
    const raster::Plane<float>* gradient = g.relief + 3 * c + 3;
    p[c] = g.relief[c].at(x, y) + (offset.x * gradient[0].at(x, y) + offset.y * gradient[1].at(x, y) - offset.z * gradient[2].at(x, y));
  }
  return p.z < raster::ref::heightAt(in.heights[g.heightMap.at(x, y)], p.x, p.y);
}

// f(p) < 0 for some surface; view space has z towards the eye.
bool insideImplicit(const TransferInput& in, const glm::vec3& p) {
  for (const raster::ImplicitDraw& s : in.implicits) {
    glm::vec3 object;
    for (int r = 0; r < 3; ++r) {
      const double* m = s.objectFromView[r];
      object[r] = float(m[0]) * p.x + float(m[1]) * p.y - float(m[2]) * p.z + float(m[3]);
    }
    if (std::isnan(object.x + object.y + object.z)) continue;
    if (!s.doubleSided && raster::ref::implicitValue(s, object) < 0) return true;
  }
  return false;
}

// Whether a point at depth z is stopped by what is seen at depth `stored` at a texel: a shell that stands above the tangent
// plane of cPos.
bool stopped(const TransferInput& in, const glm::vec3& cPos, const glm::vec3& N, float z, Texel texel, float stored, float shell) {
  const Projector& p = in.projector;
  const float a = N.x * p.xInverse, b = N.y * p.yInverse, level = N.x * cPos.x + N.y * cPos.y + N.z * cPos.z + in.settings.bias;
  float sight = a * (0.5f - p.xCenter) + b * (0.5f - p.yCenter);
  if (p.perspective) sight += N.z;
  sight = a * float(texel.x + p.xFirst) + b * float(texel.y + p.yFirst) + sight;
  const float height = p.perspective ? stored * sight : sight + N.z * stored, behind = z - stored;
  return behind > 0 && behind < shell && height > level;
}

void shade(const TransferInput& in, const std::vector<RayMarch>& marches, int x, int y, TransferSums& out) {
  const raster::GBuffer& g = *in.g;
  const Projector& projector = in.projector;
  const AmbientSettings& s = in.settings;
  const float n = float(s.samples);
  float num = 0;
  glm::vec3 den(s.albedo == TransferAlbedo::Radiance ? 0 : n);
  const float depth = g.depth.at(x, y);
  const bool empty = !(depth < std::numeric_limits<float>::infinity());
  if (empty) num = n;

  const int xImage = x + projector.xFirst, yImage = y + projector.yFirst;
  glm::vec3 cPos((float(xImage) + 0.5f - projector.xCenter) * projector.xInverse,
                 (float(yImage) + 0.5f - projector.yCenter) * projector.yInverse, depth);
  if (projector.perspective) cPos.x *= depth, cPos.y *= depth;

  // Tangent space: T = normalize(N x (0, 1, 0.01)), B = N x T.
  const glm::vec3 N(g.normal[0].at(x, y), g.normal[1].at(x, y), -g.normal[2].at(x, y));
  glm::vec3 T(N.y * 0.01f - N.z, -(N.x * 0.01f), N.x);
  const float square = T.x * T.x + T.y * T.y + T.z * T.z;
  T = square > 1e-12f ? T / std::sqrt(square) : glm::vec3(1, 0, 0);
  const glm::vec3 B(N.y * T.z - N.z * T.y, N.z * T.x - N.x * T.z, N.x * T.y - N.y * T.x);

  // Interleaved sampling: rows (c, s, 0) and (s, -c, 0) of the noise map turn T and B; dealt samples are used as they are.
  const size_t inPattern = size_t((xImage & 3) + 4 * (yImage & 3)), samples = size_t(s.samples);
  const bool dealt = s.estimator != Estimator::Paper;
  const glm::vec2 r1 = s.interleave ? rotations()[inPattern] : glm::vec2(1, 0);
  const glm::vec3 T1 = dealt ? T : T * r1.x + B * r1.y, B1 = dealt ? B : T * r1.y - B * r1.x;

  for (size_t i = 0; i < samples && !empty; ++i) {
    const size_t ray = dealt ? inPattern * samples + i : i;
    const glm::vec3 xyz = in.offsets[ray];
    bool outer = true;
    Texel occluder{};
    for (int k = 1; k <= s.steps && outer; ++k) {
      const bool march = s.estimator == Estimator::March;
      const glm::vec3 o = march ? xyz : xyz * (float(k) / float(s.steps));
      glm::vec3 shift = T1 * o.x + B1 * o.y + N * o.z;
      if (march) shift *= (float(k) - marches[ray].early) * (1 / float(s.steps));
      const glm::vec3 scPos = cPos + shift;
      occluder = project(projector, scPos);
      if (march) {
        bool inner = stopped(in, cPos, N, scPos.z, occluder, g.depth.at(occluder.x, occluder.y), marches[ray].shell);
        if (s.layers == 2)
          inner = inner || stopped(in, cPos, N, scPos.z, occluder, g.depth2.at(occluder.x, occluder.y), marches[ray].shell2);
        outer = !(inner && scPos.z > projector.zNear) && !insideImplicit(in, scPos) && !belowRelief(in, x, y, shift);
        continue;
      }
      const float behind = scPos.z - g.depth.at(occluder.x, occluder.y);
      const float deepest = s.silhouetteBound ? s.radius : std::numeric_limits<float>::infinity();
      bool within = behind < deepest;
      if (s.layers == 2) {
        const float behind2 = scPos.z - g.depth2.at(occluder.x, occluder.y);
        within = within || (behind2 > s.bias && behind2 < kHiddenThickness * s.radius);
      }
      outer = !(behind > s.bias && within && scPos.z > projector.zNear) && !insideImplicit(in, scPos) &&
              !belowRelief(in, x, y, shift);
    }
    if (outer) num += 1;
    else
      for (int c = 0; c < 3; ++c) {
        if (s.albedo == TransferAlbedo::Neighbour) den[c] -= g.albedo[c].at(occluder.x, occluder.y);
        if (s.albedo == TransferAlbedo::Radiance) den[c] -= in.radiance->rgb[c].at(occluder.x, occluder.y);
      }
  }
  out.numerator.at(x, y) = num;
  if (s.albedo != TransferAlbedo::Own)
    for (int c = 0; c < 3; ++c) out.denominator[c].at(x, y) = den[c];
}

}  // namespace

void ambientTransferRef(const TransferInput& in, int y0, int y1, TransferSums& out) {
  if (in.settings.estimator == Estimator::Lines) return lineSamplesRef(in, y0, y1, out);
  const raster::FloatEnvironment environment;
  std::vector<RayMarch> marches;
  if (in.settings.estimator == Estimator::March) marches = rayMarches(in.settings, in.offsets);
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) {
      shade(in, marches, x, y, out);
      const uint8_t open = out.numerator.at(x, y) == float(in.settings.samples);
      out.open.at(x / kSegment, y) = x % kSegment == 0 ? open : out.open.at(x / kSegment, y) & open;
    }
}

}  // namespace obscura::post
