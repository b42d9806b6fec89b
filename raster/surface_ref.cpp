// Scalar twin of surface-inl.h.
#include <algorithm>
#include <cmath>

#include "obscura/raster/surface_ref.h"

namespace obscura::raster::ref {
namespace {

float cross2(const glm::vec3& a, const glm::vec3& b) { return a.x * b.y - a.y * b.x; }

float clampWeight(float b, float sum, float most) {
  const float l = std::fabs(sum) > 0 ? b / sum : 0;
  return l > 0 ? std::min(l, most) : 0;
}

}  // namespace

SurfacePoint seePixel(const View& view, const Draw& draw, uint32_t triangle, int x, int y) {
  SurfacePoint p;
  p.draw = &draw;
  const float xc = float(view.xCenterSub(x)) - view.xShiftSub, yc = float(view.yCenterSub(y)) - view.yShiftSub;
  for (int i = 0; i < 3; ++i) {
    p.vertex[i] = draw.mesh->indices[size_t(triangle) * 3 + size_t(i)];
    const glm::vec3 o = p.object[i] = draw.mesh->positions[p.vertex[i]];
    glm::vec3 v;
    for (int r = 0; r < 3; ++r) {
      const float* m = draw.viewFromObject[r];
      v[r] = m[0] * o.x + m[1] * o.y + m[2] * o.z + m[3];
    }
    const float w = view.perspective ? -v.z : 1;
    p.h[i] = {v.x * view.xScaleSub - w * xc, v.y * view.yScaleSub - w * yc, w};
  }
  const float b0 = cross2(p.h[1], p.h[2]), b1 = cross2(p.h[2], p.h[0]), b2 = cross2(p.h[0], p.h[1]);
  p.sum = b0 + b1 + b2;
  p.clockwise = p.sum > 0;
  p.weight[1] = clampWeight(b1, p.sum, 1);
  p.weight[2] = clampWeight(b2, p.sum, 1 - p.weight[1]);
  p.weight[0] = (1 - p.weight[1]) - p.weight[2];
  return p;
}

glm::vec4 sampleSlot(const SurfaceContext& context, const SurfacePoint& p, const TextureSlot& slot) {
  const TextureView& texture = context.textures[size_t(slot.texture)];
  const auto& m = slot.uvFromUv;
  const Span<const glm::vec2> uvs = p.draw->mesh->uvs[slot.uvSet];
  if (uvs.empty()) return sampleTexture(texture, context.srgbToLinear, m[2], m[5], levelOfDetail(0));
  glm::vec2 uv[3];
  for (int i = 0; i < 3; ++i) {
    const glm::vec2 t = uvs[p.vertex[i]];
    uv[i] = {m[0] * t.x + m[1] * t.y + m[2], m[3] * t.x + m[4] * t.y + m[5]};
  }
  const glm::vec2 at = uv[0] * p.weight[0] + uv[1] * p.weight[1] + uv[2] * p.weight[2];
  // Gradients of the weights by the quotient rule; per step of one pixel to the right (axis 0) and down (axis 1).
  float largest = 0;
  for (int axis = 0; axis < 2; ++axis) {
    glm::vec3 db;
    for (int i = 0; i < 3; ++i) {
      const glm::vec3 &j = p.h[(i + 1) % 3], &k = p.h[(i + 2) % 3];
      db[i] = axis == 0 ? k.z * j.y - j.z * k.y : j.z * k.x - k.z * j.x;
    }
    const float dSum = db.x + db.y + db.z;
    float squared = 0;
    for (int c = 0; c < 2; ++c) {
      const float d = db.x * uv[0][c] + db.y * uv[1][c] + db.z * uv[2][c];
      const float texels = float(c == 0 ? texture.width : texture.height) * float(kSub);
      const float g = (d - at[c] * dSum) / p.sum * texels;
      squared += g * g;
    }
    if (squared > largest) largest = squared;
  }
  return sampleTexture(texture, context.srgbToLinear, at.x, at.y, levelOfDetail(largest));
}

glm::vec4 baseColor(const SurfaceContext& context, const SurfacePoint& p) {
  glm::vec4 c = p.draw->material->baseColor;
  if (p.draw->material->baseColorMap.texture >= 0) c *= sampleSlot(context, p, p.draw->material->baseColorMap);
  const Span<const glm::vec4> colors = p.draw->mesh->colors;
  return colors.empty() ? c : c * interpolate(p, colors);
}

}  // namespace obscura::raster::ref
