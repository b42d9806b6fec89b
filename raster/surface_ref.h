// Scalar twin of surface-inl.h and texture-inl.h: one triangle seen from one pixel.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "obscura/raster/surface.h"

namespace obscura::raster::ref {

struct SurfacePoint {
  const Draw* draw = nullptr;
  uint32_t vertex[3];
  glm::vec3 object[3];
  float weight[3];
  bool clockwise = false;
  WeightPlanes planes;
  float sum = 0;  // of the planes, at the pixel
};

// a0 w0 + a1 w1 + a2 w2 of a vertex attribute.
template <class Values>
auto interpolate(const SurfacePoint& p, const Values& values) {
  return values[p.vertex[0]] * p.weight[0] + values[p.vertex[1]] * p.weight[1] + values[p.vertex[2]] * p.weight[2];
}

SurfacePoint seePixel(const View& view, const Draw& draw, uint32_t triangle, int x, int y);
glm::vec4 baseColor(const SurfaceContext& context, const SurfacePoint& p);
glm::vec4 sampleSlot(const SurfaceContext& context, const SurfacePoint& p, const TextureSlot& slot);
glm::vec4 sampleTexture(const TextureView& texture, const float* srgbToLinear, float u, float v, float lod);
float levelOfDetail(float squaredLength);
float foldCoordinate(float u, Wrap mode);   // into [0, 1]
int wrapTexel(int i, int size, Wrap mode);  // i at most one step outside of [0, size)

}  // namespace obscura::raster::ref
