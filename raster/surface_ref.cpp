// Scalar twin of surface-inl.h.
#include <algorithm>
#include <cmath>

#include "obscura/raster/surface_ref.h"

namespace obscura::raster::ref {
namespace {

float clampWeight(float l, float most) { return l > 0 ? std::min(l, most) : 0; }

}  // namespace

SurfacePoint seePixel(const View& view, const Draw& draw, uint32_t triangle, int x, int y) {
  SurfacePoint p;
  p.draw = &draw;
  for (int i = 0; i < 3; ++i) {
    p.vertex[i] = draw.mesh->indices[size_t(triangle) * 3 + size_t(i)];
    p.object[i] = draw.mesh->positions[p.vertex[i]];
  }
  const int left = x - ((view.left + x) & (kCell - 1)), top = y - ((view.top + y) & (kCell - 1));
  p.planes = weightPlanes(view, draw, p.vertex, left, top);
  float b[3];
  for (int i = 0; i < 3; ++i) b[i] = p.planes.c[i] + (p.planes.gx[i] * float(x - left) + p.planes.gy[i] * float(y - top));
  p.sum = b[0] + b[1] + b[2];
  p.clockwise = p.sum > 0;
  const float perSum = 1 / p.sum;
  p.weight[1] = clampWeight(b[1] * perSum, 1);
  p.weight[2] = clampWeight(b[2] * perSum, 1 - p.weight[1]);
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
    const float* db = axis == 0 ? p.planes.gx : p.planes.gy;
    const float dSum = db[0] + db[1] + db[2];
    float squared = 0;
    for (int c = 0; c < 2; ++c) {
      const float d = db[0] * uv[0][c] + db[1] * uv[1][c] + db[2] * uv[2][c];
      const float texels = float(c == 0 ? texture.width : texture.height);
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
