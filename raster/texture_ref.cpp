// Scalar twin of texture-inl.h.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "obscura/raster/surface_ref.h"

namespace obscura::raster::ref {
float foldCoordinate(float u, Wrap mode) {
  if (mode == Wrap::Repeat) u -= std::floor(u);
  if (mode == Wrap::MirroredRepeat) {
    u -= 2 * std::floor(u * 0.5f);
    if (u > 1) u = 2 - u;
  }
  if (!(u > 0)) return 0;
  return u < 1 ? u : 1;
}

int wrapTexel(int i, int size, Wrap mode) {
  if (i >= 0 && i < size) return i;
  if (mode == Wrap::Repeat) return i < 0 ? size - 1 : 0;
  return i < 0 ? 0 : size - 1;
}

namespace {

struct Level {
  const TextureView& texture;
  const float* srgbToLinear;
  const uint32_t* texels;
  int width, height;

  Level(const TextureView& t, const float* table, int level) : texture(t), srgbToLinear(table), texels(t.texels.data()) {
    for (int k = 0; k < level; ++k) texels += size_t(std::max(1, t.width >> k)) * size_t(std::max(1, t.height >> k));
    width = std::max(1, t.width >> level);
    height = std::max(1, t.height >> level);
  }

  glm::vec4 texel(int x, int y) const {
    x = wrapTexel(x, width, texture.wrapU);
    y = wrapTexel(y, height, texture.wrapV);
    unsigned char c[4];
    std::memcpy(c, texels + size_t(y) * size_t(width) + size_t(x), 4);
    glm::vec4 v;
    for (int i = 0; i < 4; ++i) v[i] = texture.srgb && i < 3 ? srgbToLinear[c[i]] : float(c[i]) / 255.0f;
    return v;
  }

  glm::vec4 sample(float u, float v, Filter filter) const {
    const float x = u * float(width), y = v * float(height);
    if (filter == Filter::Nearest) return texel(int(x), int(y));
    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const float fx = (x - 0.5f) - left, fy = (y - 0.5f) - top;
    auto line = [&](int row) {
      const glm::vec4 a = texel(int(left), row), b = texel(int(left) + 1, row);
      return a + (b - a) * fx;
    };
    const glm::vec4 a = line(int(top)), b = line(int(top) + 1);
    return a + (b - a) * fy;
  }
};

}  // namespace

float levelOfDetail(float squaredLength) {
  if (!(squaredLength >= 1e-30f)) squaredLength = 1e-30f;
  if (squaredLength >= 1e30f) squaredLength = 1e30f;
  int exponent;
  const float t = std::frexp(squaredLength, &exponent) * 2 - 1;
  const float q = ((t * -0.045149015f + 0.148426603f) * t + -0.267179386f) * t + 0.441917037f;
  return (float(exponent - 1) + (t + (t * (1 - t)) * q)) * 0.5f;
}

glm::vec4 sampleTexture(const TextureView& t, const float* table, float u, float v, float lod) {
  u = foldCoordinate(u, t.wrapU);
  v = foldCoordinate(v, t.wrapV);
  if (!(lod > 0)) return Level(t, table, 0).sample(u, v, t.magFilter);
  if (t.mip == MipFilter::None) return Level(t, table, 0).sample(u, v, t.minFilter);
  const float l = std::min(lod, float(t.levels - 1));
  if (t.mip == MipFilter::Nearest) return Level(t, table, int(l + 0.5f)).sample(u, v, t.minFilter);
  const int lower = int(l), upper = std::min(lower + 1, t.levels - 1);
  const glm::vec4 a = Level(t, table, lower).sample(u, v, t.minFilter), b = Level(t, table, upper).sample(u, v, t.minFilter);
  return a + (b - a) * (l - float(lower));
}

}  // namespace obscura::raster::ref
