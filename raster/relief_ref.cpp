// Scalar twin of relief.cpp and height-inl.h.
#include <algorithm>
#include <cmath>

#include "obscura/raster/reference.h"
#include "obscura/raster/relief.h"

namespace obscura::raster::ref {
namespace {

float dot(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
glm::vec3 vectorOf(const float v[3]) { return {v[0], v[1], v[2]}; }

// Where a ray meets the map: the last tau above it.
template <class Below>
float lastAbove(float steps, const Below& below) {
  if (below(0.0f)) return 0;
  const float step = 1 / steps;
  float low = 0, high = 0;
  for (float k = 1;; k += 1) {
    high = std::min(k * step, 1.0f);
    if (below(high) || high == 1) break;
    low = high;
  }
  for (int k = 0; k < kReliefHalvings; ++k) {
    const float middle = (low + high) * 0.5f;
    (below(middle) ? high : low) = middle;
  }
  return low;
}

void displacePixel(const SurfaceContext& context, uint32_t id, float& key, int x, int y, GBuffer& out) {
  const View& view = *context.view;
  const Draw& draw = drawOf(context, id);
  const Material& m = *draw.material;
  const Span<const glm::vec2> uvs = draw.mesh->uvs[m.heightMap.uvSet];
  if (m.heightMap.texture < 0 || uvs.empty()) return;
  const HeightView& map = context.heights[size_t(m.heightMap.texture)];
  SurfacePoint p = seePixel(view, draw, id - draw.firstTriangle, x, y);
  const ReliefFrame f = reliefFrame(draw, p.vertex);
  if (!(f.depth > 0)) return;

  glm::vec2 corner[3];
  for (int i = 0; i < 3; ++i) {
    const auto& t = m.heightMap.uvFromUv;
    const glm::vec2 uv = uvs[p.vertex[i]];
    corner[i] = {t[0] * uv.x + t[1] * uv.y + t[2], t[3] * uv.x + t[4] * uv.y + t[5]};
  }
  const float px = (float(view.xCenterSub(x)) - view.xShiftSub) / view.xScaleSub;
  const float py = (float(view.yCenterSub(y)) - view.yShiftSub) / view.yScaleSub;
  const glm::vec3 ray = view.perspective ? glm::vec3(px, py, -1) : glm::vec3(0, 0, -1);
  const float sinks = std::fabs(dot(vectorOf(f.normal), ray));
  const float span = f.depth / std::max(sinks, std::sqrt(dot(ray, ray)) * kFlattestRay), falls = sinks * span / f.depth;
  const float step1 = dot(vectorOf(f.gradient[0]), ray) * span, step2 = dot(vectorOf(f.gradient[1]), ray) * span;
  const glm::vec2 start = corner[0] * p.weight[0] + corner[1] * p.weight[1] + corner[2] * p.weight[2];
  const glm::vec2 way = (corner[1] - corner[0]) * step1 + (corner[2] - corner[0]) * step2;
  const auto at = [&](float tau) { return start + way * tau; };
  float steps = std::max({kFewestReliefSteps, std::fabs(way.x) * float(map.width), std::fabs(way.y) * float(map.height)});
  steps = std::min(steps, kMostReliefSteps);
  const float tau = lastAbove(steps, [&](float t) { return 1 - falls * t <= heightAt(map, at(t).x, at(t).y); });

  const float zView = view.perspective ? 1 / key : 0 - key, sunk = zView + span * tau;
  key = view.perspective ? 1 / sunk : 0 - sunk;
  p.weight[1] += step1 * tau;
  p.weight[2] += step2 * tau;
  p.weight[0] = 1 - p.weight[1] - p.weight[2];

  glm::vec3 base = glm::vec3(baseColor(context, p)), emitted = m.emissive, smooth(0), normal(0);
  if (m.emissiveMap.texture >= 0) emitted *= glm::vec3(sampleSlot(context, p, m.emissiveMap));
  const glm::vec2 uv = at(tau), texel(1 / float(map.width), 1 / float(map.height));
  const auto gradient = [&](int c) {
    return vectorOf(f.gradient[0]) * (corner[1][c] - corner[0][c]) + vectorOf(f.gradient[1]) * (corner[2][c] - corner[0][c]);
  };
  const glm::vec3 gradientU = gradient(0), gradientV = gradient(1);
  if (!out.normal[0].empty()) {
    smooth = glm::vec3(out.normal[0].at(x, y), out.normal[1].at(x, y), out.normal[2].at(x, y));
    const float slopeU = (heightAt(map, uv.x + texel.x, uv.y) - heightAt(map, uv.x - texel.x, uv.y)) * (0.5f * float(map.width) * f.depth);
    const float slopeV = (heightAt(map, uv.x, uv.y + texel.y) - heightAt(map, uv.x, uv.y - texel.y)) * (0.5f * float(map.height) * f.depth);
    normal = smooth - (gradientU * slopeU + gradientV * slopeV);
    const float square = dot(normal, normal);
    normal = square >= 1e-36f && square <= 1e36f ? normal * (1 / std::sqrt(square)) : smooth;
  }
  resolveShaded(context, id, key, {normal, base, emitted}, x, y, out);
  if (out.heightMap.empty()) return;
  out.heightMap.at(x, y) = uint32_t(m.heightMap.texture);
  const glm::vec3 upwards = smooth * (1 / f.depth);
  const glm::vec3 rows[4] = {{uv, 1 - falls * tau}, gradientU, gradientV, upwards};
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 3; ++c) out.relief[r * 3 + c].at(x, y) = rows[r][c];
}

}  // namespace

float heightAt(const HeightView& map, float u, float v) {
  const float x = foldCoordinate(u, map.wrapU) * float(map.width) - 0.5f, y = foldCoordinate(v, map.wrapV) * float(map.height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const auto line = [&](int row) {
    const float* heights = map.heights.data() + size_t(wrapTexel(row, map.height, map.wrapV)) * size_t(map.width);
    const float a = heights[wrapTexel(int(left), map.width, map.wrapU)], b = heights[wrapTexel(int(left) + 1, map.width, map.wrapU)];
    return a + (b - a) * (x - left);
  };
  const float a = line(int(top)), b = line(int(top) + 1);
  return a + (b - a) * (y - top);
}

void displace(const SurfaceContext& context, Visibility& seen, GBuffer& out) {
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x) {
      if (!out.heightMap.empty()) out.heightMap.at(x, y) = kNoTriangle;
      for (Plane<float>& plane : out.relief)
        if (!plane.empty()) plane.at(x, y) = 0;
      if (seen.triangle.at(x, y) != kNoTriangle) displacePixel(context, seen.triangle.at(x, y), seen.key.at(x, y), x, y, out);
    }
}

}  // namespace obscura::raster::ref
