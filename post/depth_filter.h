// In:  the transfer's sums, depth (and albedo, for the own-albedo W).
// Out: obscurance O and ambient transfer W per pixel: the 4x4 box over pixels of nearly the same depth, then one
//      quotient of sums (long paper, sections 4.1 and 4.2).
#pragma once

#include "obscura/post/ambient_transfer.h"

namespace obscura::post {

// O = sum num / sum n;  W = sum num / sum den per channel, or with own albedo O / (1 - a (1 - O)) (short paper, equation
// 4). Where the denominator does not exceed the numerator (all rays inside and albedo 1: the closed white room; or no
// ray inside) W is 1. Never NaN, infinite, negative or above 1, whatever the G-buffer holds.
struct Transfer {
  raster::Plane<float> obscurance;  // allocated if asked for
  raster::Plane<float> w[3];        // allocated if asked for
};

Transfer makeTransfer(int width, int height, bool obscurance, bool w, Transfer used = {});

// Window x-2 ... x+1, y-2 ... y+1, clamped at the border. A neighbour counts if |z - z'| < threshold; the pixel itself
// always does. Without AmbientSettings::filter only the pixel itself. Empty pixels have O = W = 1.
void depthFilter(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out, raster::Target target);
void depthFilterRef(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out);  // the scalar twin

}  // namespace obscura::post
