// Scalar twin of relief.cpp and height-inl.h.
#include <algorithm>
#include <cmath>
#include <optional>

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

// Where the ray of a pixel meets the map of the triangle that it shows.
struct Sunk {
  SurfacePoint point;  // on the triangle, then with weights beyond it
  ReliefFrame frame;
  glm::vec3 gradient[2];  // of u and v, in view space
  glm::vec3 uvh;          // in the map
  float behind;           // the triangle, along the view axis
};

// Nothing where the triangle is not displaced.
std::optional<Sunk> sink(const SurfaceContext& context, uint32_t id, int x, int y) {
  const View& view = *context.view;
  const Draw& draw = drawOf(context, id);
  const TextureSlot& slot = draw.material->heightMap;
  const Span<const glm::vec2> uvs = draw.mesh->uvs[slot.uvSet];
  if (slot.texture < 0 || uvs.empty()) return {};
  const HeightView& map = context.heights[size_t(slot.texture)];
  SurfacePoint p = seePixel(view, draw, id - draw.firstTriangle, x, y);
  const ReliefFrame f = reliefFrame(draw, p.vertex);
  if (!(f.depth > 0)) return {};

  glm::vec2 corner[3];
  for (int i = 0; i < 3; ++i) {
    const auto& t = slot.uvFromUv;
    const glm::vec2 uv = uvs[p.vertex[i]];
    corner[i] = {t[0] * uv.x + t[1] * uv.y + t[2], t[3] * uv.x + t[4] * uv.y + t[5]};
  }
  const float px = (float(view.xCenterSub(x)) - view.xShiftSub) / view.xScaleSub;
  const float py = (float(view.yCenterSub(y)) - view.yShiftSub) / view.yScaleSub;
  const glm::vec3 ray = view.perspective ? glm::vec3(px, py, -1) : glm::vec3(0, 0, -1);
  const float sinks = std::fabs(dot(vectorOf(f.normal), ray));
  const float span = f.depth / std::max(sinks, std::sqrt(dot(ray, ray)) * kFlattestRay), falls = sinks * span / f.depth;
  const glm::vec3 g1 = vectorOf(f.gradient[0]), g2 = vectorOf(f.gradient[1]);
  const float step1 = dot(g1, ray) * span, step2 = dot(g2, ray) * span;
  const glm::vec2 start = corner[0] * p.weight[0] + corner[1] * p.weight[1] + corner[2] * p.weight[2];
  const glm::vec2 along1 = corner[1] - corner[0], along2 = corner[2] - corner[0], way = along1 * step1 + along2 * step2;
  const auto at = [&](float tau) { return start + way * tau; };
  float steps = std::max({kFewestReliefSteps, std::fabs(way.x) * float(map.width), std::fabs(way.y) * float(map.height)});
  steps = std::min(steps, kMostReliefSteps);
  const float tau = lastAbove(steps, [&](float t) { return 1 - falls * t <= heightAt(map, at(t).x, at(t).y); });

  p.weight[1] += step1 * tau;
  p.weight[2] += step2 * tau;
  p.weight[0] = 1 - p.weight[1] - p.weight[2];
  return Sunk{p, f, {g1 * along1.x + g2 * along2.x, g1 * along1.y + g2 * along2.y}, {at(tau), 1 - falls * tau}, span * tau};
}

// The interpolated normal, tilted by the map.
glm::vec3 tilted(const Sunk& s, const HeightView& map, const glm::vec3& smooth) {
  const glm::vec2 size(float(map.width), float(map.height)), texel(1 / size.x, 1 / size.y);
  const float u = s.uvh.x, v = s.uvh.y;
  const float slopeU = (heightAt(map, u + texel.x, v) - heightAt(map, u - texel.x, v)) * (0.5f * size.x * s.frame.depth);
  const float slopeV = (heightAt(map, u, v + texel.y) - heightAt(map, u, v - texel.y)) * (0.5f * size.y * s.frame.depth);
  const glm::vec3 n = smooth - (s.gradient[0] * slopeU + s.gradient[1] * slopeV);
  const float square = dot(n, n);
  return square >= 1e-36f && square <= 1e36f ? n * (1 / std::sqrt(square)) : smooth;
}

void displacePixel(const SurfaceContext& context, uint32_t id, float key, int x, int y, GBuffer& out) {
  const std::optional<Sunk> s = sink(context, id, x, y);
  if (!s) return;
  const Material& m = *drawOf(context, id).material;
  glm::vec3 base = glm::vec3(baseColor(context, s->point)), emitted = m.emissive, smooth(0), normal(0);
  if (m.emissiveMap.texture >= 0) emitted *= glm::vec3(sampleSlot(context, s->point, m.emissiveMap));
  if (!out.normal[0].empty()) {
    smooth = glm::vec3(out.normal[0].at(x, y), out.normal[1].at(x, y), out.normal[2].at(x, y));
    normal = tilted(*s, context.heights[size_t(m.heightMap.texture)], smooth);
  }
  const glm::vec2 gloss = metallicRoughness(context, s->point);
  resolveShaded(context, id, key, {normal, base, emitted, gloss.x, gloss.y}, x, y, out);
  if (out.heightMap.empty()) return;
  out.heightMap.at(x, y) = uint32_t(m.heightMap.texture);
  const glm::vec3 rows[4] = {s->uvh, s->gradient[0], s->gradient[1], smooth * (1 / s->frame.depth)};
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

void sinkInto(const SurfaceContext& context, const Visibility& displaced, Visibility& seen) {
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x) {
      const uint32_t id = displaced.triangle.at(x, y);
      if (id == kNoTriangle) continue;
      const bool perspective = context.view->perspective;
      float key = displaced.key.at(x, y);
      if (const std::optional<Sunk> s = sink(context, id, x, y)) {
        const float zView = (perspective ? 1 / key : 0 - key) + s->behind;
        key = std::min(key, perspective ? 1 / zView : 0 - zView);
      }
      if (key < seen.key.at(x, y) || (key == seen.key.at(x, y) && id > seen.triangle.at(x, y))) continue;
      seen.key.at(x, y) = key;
      seen.triangle.at(x, y) = id;
    }
}

void storeRelief(const SurfaceContext& context, const Visibility& seen, GBuffer& out) {
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x) {
      if (!out.heightMap.empty()) out.heightMap.at(x, y) = kNoTriangle;
      for (Plane<float>& plane : out.relief)
        if (!plane.empty()) plane.at(x, y) = 0;
      if (seen.triangle.at(x, y) != kNoTriangle) displacePixel(context, seen.triangle.at(x, y), seen.key.at(x, y), x, y, out);
    }
}

}  // namespace obscura::raster::ref
