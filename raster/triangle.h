// A triangle ready for the tiles: exact integer edge functions, depth as a plane, what it covers at most.
//
// Edge functions. With y downwards and vertices p, q, r in the order that makes the doubled area positive,
//     E(c) = A (c.x - p.x) + B (c.y - p.y),   A = p.y - q.y,  B = q.x - p.x      (sub-pixels squared)
// is positive for c on the inner side of edge p -> q, and all three are positive exactly inside. A centre on an edge
// (E = 0) belongs to the triangle if the edge is a left one (A > 0: it runs upwards) or a top one (A = 0, B > 0); so
// the others get a bias of -1 and "inside" is E + bias >= 0 for every edge. Stepping by a pixel adds 256 A or 256 B,
// hence the sign depends only on e = floor((E + bias) / 256), which steps by A and B.
#pragma once

#include <cstdint>

#include "obscura/raster/view.h"

namespace obscura::raster {

// Depth key at the centre c: clamp(key0 + ((xGradient (c.x - p0.x)) + (yGradient (c.y - p0.y))), keyMin, keyMax), p0 the
// triangle's vertex 0 (of the mesh, not of the order above). The clamp keeps slivers inside their range.

constexpr int kSmallExtentSub = 64 * kSub;  // both extents of a small triangle are at most this

// Tiles are stored and rasterized in blocks of 4 x 4 pixels: one AVX-512 vector, two of AVX2, four of SSE or NEON.
constexpr int kBlockBits = 2, kBlock = 1 << kBlockBits;

// A, B <= 2^14, centres are less than a block outside the box: |E| <= 2 * 2^14 * (2^14 + 2^10) < 2^31, in 32 bits.
static_assert(int64_t(2) * kSmallExtentSub * (kSmallExtentSub + kBlock * kSub) < (int64_t(1) << 31));

struct alignas(64) SmallTriangle {
  int32_t e[3];     // at the centre of the upper left pixel of block (x, y)
  int32_t ab[3];    // of 16 bits each: a lower, b upper
  int32_t block;    // x lower, y upper: first block that the covered centres' box touches, inside the window
  int32_t blocks;   // how many blocks it touches, less one: columns lower, rows upper; kMaskedBit if alpha decides per pixel
  float key0, xGradient, yGradient;  // gradients per sub-pixel
  float xFromP0, yFromP0;            // centre of that pixel minus p0, sub-pixels, exact
  float keyMin, keyMax;
  uint32_t id;

  static constexpr int32_t kMaskedBit = 1 << 15;
  int columns() const { return (blocks & (kMaskedBit - 1)) + 1; }
  int rows() const { return (blocks >> 16) + 1; }
  bool masked() const { return blocks & kMaskedBit; }
};
static_assert(sizeof(SmallTriangle) == 64, "one cache line");

// Halves of a packed pair, sign extended.
inline int lowerHalf(int32_t pair) { return int16_t(pair & 0xFFFF); }
inline int upperHalf(int32_t pair) { return pair >> 16; }

// Coordinates within the guard band: |A|, |B| <= 2^22, so |E| <= 2 * 2^22 * 2^22 = 2^45 fits in 64 bits.
static_assert(int64_t(2) * (2ll * kGuardSub) * (2ll * kGuardSub) <= (int64_t(1) << 45));

struct LargeTriangle {
  int64_t e[3];  // E + bias at the centre of pixel (0, 0), not yet divided
  int32_t a[3], b[3];
  int32_t x0, y0, x1, y1;  // box of covered centres inside the window, inclusive, pixels
  float key0, xGradient, yGradient;
  int32_t p0x, p0y;
  float keyMin, keyMax;
  uint32_t id;
  bool masked;
};

// Three snapped vertices, in the mesh's order.
struct SnappedTriangle {
  int32_t x[3], y[3];
  float key[3];
};

enum class SetupResult { Covers, FacesAway, Outside };  // FacesAway: or has no area; Outside: covers no pixel centre

// Any size. facing: +1 only counter-clockwise triangles are seen, -1 only clockwise ones, 0 both. Fills all of `out`
// but id and masked; what it holds is unspecified unless the result is Covers.
SetupResult setupTriangle(const View& view, const SnappedTriangle& t, int facing, LargeTriangle& out);

}  // namespace obscura::raster
