// In:  the vertices of a cluster, object space, structure of arrays.
// Out: the same vertices snapped to sub-pixels, with depth keys and outcodes.
#pragma once

#include <cstdint>

#include "obscura/raster/clusters.h"
#include "obscura/raster/target.h"
#include "obscura/raster/view.h"

namespace obscura::raster {

// Why a vertex cannot be used as it is (first three), or on which side of the window it lies.
enum Outcode : int32_t {
  kBeforeNear = 1,  // not zView >= zNear, NaN included
  kBeyondFar = 2,
  kOutsideGuard = 4,  // not |x|, |y| <= kGuardSub, NaN included
  kNeedsClip = 7,
  kLeft = 8,
  kRight = 16,
  kAbove = 32,
  kBelow = 64,
};

struct TransformedVertices {
  static constexpr int kCapacity = int(Clusters::kMaxVertices);
  alignas(64) int32_t xSub[kCapacity];  // 0 where the outcode has kNeedsClip
  alignas(64) int32_t ySub[kCapacity];
  alignas(64) float key[kCapacity];     // depth key
  alignas(64) int32_t code[kCapacity];  // Outcode bits
  int32_t anyCode, allCodes;            // or / and over the vertices
  int32_t xLeast, yLeast, xGreatest, yGreatest;  // of xSub, ySub
  float nearestKey;                              // the greatest of key; meaningless if anyCode has kNeedsClip
  // Where all of the cluster lies within 256 pixels (`packed`): x - xLeast in the lower 16 bits, y - yLeast in the
  // upper ones, so that setup gathers half as often.
  alignas(64) int32_t xy[kCapacity];
  bool packed;
};

// count vertices, padded to a multiple of 16 that can be read; count <= kCapacity.
void transformVertices(const View& view, const Draw& draw, const float* x, const float* y, const float* z, int count,
                       TransformedVertices& out, Target target);
// The scalar twin.
void transformVerticesRef(const View& view, const Draw& draw, const float* x, const float* y, const float* z, int count,
                          TransformedVertices& out);

}  // namespace obscura::raster
