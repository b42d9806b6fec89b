// What turning a covered pixel into attributes needs, for the alpha test and for resolve.
//
// Perspective-correct barycentrics without a division per vertex (after Olano and Greer's homogeneous rasterization):
// with p_i = (x, y) of vertex i in sub-pixels times its w (w = zView, or 1 if orthographic) and C the pixel's centre,
// h_i = p_i - w_i C is where the vertex lies as seen from the pixel, and the point seen has weights proportional to
//     b0 = h1 x h2,  b1 = h2 x h0,  b2 = h0 x h1        (cross products in the plane)
// for vertices in front of the eye and behind it alike, so clipped triangles need no care. The weights are clamped so
// that no attribute leaves its triangle's range.
#pragma once

#include "obscura/raster/draw.h"
#include "obscura/raster/view.h"

namespace obscura::raster {

struct SurfaceContext {
  const View* view = nullptr;
  Span<const Draw> draws;  // ascending firstTriangle
  Span<const TextureView> textures;
  const float* srgbToLinear = nullptr;  // SrgbTable::linear
};

// The draw that a triangle id belongs to; the id must be one of the frame's. `hint` is tried first.
inline const Draw& drawOf(const SurfaceContext& context, uint32_t id, const Draw* hint = nullptr) {
  if (hint && id - hint->firstTriangle < hint->triangleCount) return *hint;
  size_t lo = 0, hi = context.draws.size();
  while (hi - lo > 1) {
    const size_t mid = (lo + hi) / 2;
    (context.draws[mid].firstTriangle <= id ? lo : hi) = mid;
  }
  return context.draws[lo];
}

}  // namespace obscura::raster
