// What turning a covered pixel into attributes needs, for the alpha test and for resolve.
//
// Perspective-correct barycentrics without a division per vertex (after Olano and Greer's homogeneous rasterization):
// with p_i = (x, y) of vertex i in sub-pixels times its w (w = zView, or 1 if orthographic) and C the pixel's centre,
// h_i = p_i - w_i C is where the vertex lies as seen from the pixel, and the point seen has weights proportional to
//     b0 = h1 x h2,  b1 = h2 x h0,  b2 = h0 x h1        (cross products in the plane)
// for vertices in front of the eye and behind it alike, so clipped triangles need no care. Each b is affine in C: a plane
// over the image. Its coefficients are found in double, since the cross products of a needle cancel, once per triangle and
// cell of 16 x 16 pixels; in the cell float is enough. The weights are clamped so that no attribute leaves its triangle's
// range, which a centre inside the snapped triangle but outside the true one would make it do.
#pragma once

#include <cstdint>
#include <vector>

#include "obscura/raster/draw.h"
#include "obscura/raster/view.h"

namespace obscura::raster {

// Where in the draws to look for a triangle id: of every run of 2^shift ids the draw of the first, and the last draw once more.
struct DrawRuns {
  int shift = 0;
  std::vector<uint32_t> draw;

  void find(Span<const Draw> draws);
};

struct SurfaceContext {
  const View* view = nullptr;
  Span<const Draw> draws;  // ascending firstTriangle
  const DrawRuns* runs = nullptr;  // of the draws, or null
  Span<const TextureView> textures;
  const float* srgbToLinear = nullptr;  // SrgbTable::linear
  Span<const HeightView> heights = {};
};

// Pixels. Cells begin at multiples of it in the whole image, and so does every window that the rasterizer draws.
constexpr int kCellBits = 4, kCell = 1 << kCellBits;

// b_i = c[i] + (gx[i] dx + gy[i] dy), dx and dy in pixels from the centre of the cell's upper left pixel; all of them
// scaled by one positive factor that makes the largest coefficient 1. NaN where a vertex is not finite or all are 0.
struct WeightPlanes {
  float c[3], gx[3], gy[3];
};

// x, y: the cell's upper left pixel. vertex: of the draw's mesh.
WeightPlanes weightPlanes(const View& view, const Draw& draw, const uint32_t vertex[3], int x, int y);

// The draw that a triangle id belongs to; the id must be one of the frame's. `hint` is tried first.
inline const Draw& drawOf(const SurfaceContext& context, uint32_t id, const Draw* hint = nullptr) {
  if (hint && id - hint->firstTriangle < hint->triangleCount) return *hint;
  size_t lo = 0, hi = context.draws.size();
  if (context.runs) {
    const uint32_t* run = context.runs->draw.data() + (id >> context.runs->shift);
    lo = run[0];
    hi = run[1] + 1;
  }
  while (hi - lo > 1) {
    const size_t mid = (lo + hi) / 2;
    (context.draws[mid].firstTriangle <= id ? lo : hi) = mid;
  }
  return context.draws[lo];
}

}  // namespace obscura::raster
