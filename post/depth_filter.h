// In:  the transfer's sums, depth (and albedo, for the own-albedo W; normals, for FilterGuide::Plane).
// Out: obscurance O and ambient transfer W (or the bounced light that makes it) per pixel: the 4x4 box over pixels of
//      nearly the same depth or of the same plane, then one quotient of sums (long paper, sections 4.1 and 4.2).
#pragma once

#include "obscura/post/ambient_transfer.h"

namespace obscura::post {

// O = sum num / sum n;  W = sum num / sum den per channel, or with own albedo O / (1 - a (1 - O)) (short paper, equation
// 4). Where the denominator does not exceed the numerator (all rays inside and albedo 1: the closed white room; or no
// ray inside) W is 1. Never NaN, infinite, negative or above 1, whatever the G-buffer holds.
// With stored radiance W = O + bounced / La, bounced = -sum den / sum n, which is 1/pi int (1 - mu) L(y) cos dw: kept
// without La, as it is there where La is 0, too. From 0 to the largest L, but for roundings; 0 where the sum is no number
// and where it is negative. Hence W <= max(1, largest L / La): it is a mean of what the rays bring, 1 or L / La.
struct Transfer {
  raster::Plane<float> obscurance;  // allocated if asked for
  raster::Plane<float> w[3];        // allocated if asked for; with stored radiance see transferOfBounced() in light.h
  raster::Plane<float> bounced[3];  // allocated if asked for, which needs stored radiance; that of L
};

struct TransferPlanes {
  bool obscurance = false, w = false, bounced = false;
};

Transfer makeTransfer(int width, int height, const TransferPlanes& planes, Transfer used = {});

// FilterGuide::Plane: a neighbour counts if |N . (p' - p)| < kPlaneDistance R and N . N' > kNormalCosine, p and p' the
// points seen, N and N' their normals. Differs from the papers, whose depth difference leaves few pixels of a window on a
// surface seen at a grazing angle, and mixes those of an edge between two faces.
constexpr float kPlaneDistance = 0.1f, kNormalCosine = 0.9f;

// Window x-2 ... x+1, y-2 ... y+1, clamped at the border. FilterGuide::Depth: a neighbour counts if |z - z'| < threshold.
// The pixel itself always does. Without AmbientSettings::filter only the pixel itself. Empty pixels have O = W = 1 and
// no bounced light. Planes that the settings do not speak of are left as they are.
void depthFilter(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out, raster::Target target);
void depthFilterRef(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out);  // the scalar twin

}  // namespace obscura::post
