// How the constants of brdf_table.cpp are made. Part of obscura-make-brdf-tables and of the test that regenerates them, not
// of the library. + - * / sqrt on doubles and raster/exact_math.h: the same everywhere.
#pragma once

#include <cstdint>

#include "obscura/post/brdf.h"

namespace obscura::post {

// E and B / E of brdf.h.
struct LobeIntegrals {
  double e = 0, share = 0;
};

// In: a glossy BRDF; kLeastFacing <= nv <= 1; roughness 0 ... 1.
// Out: the integrals over half vectors h, which the lobe is narrow around: dl = 4 v.h dh. They lie on rings of equal n.h, as
// densely as GGX's D n.h says, and these are dealt by the midpoint rule to those that have n.l > 0 all round and to those
// that have not, kHalfVectorRings of each, denser at both ends; on each ring there are kHalfVectorSteps, denser where n.l
// falls to 0. The error is at most 2e-4 (n.v below 0.01), mostly below 1e-5.
constexpr int kHalfVectorRings = 256, kHalfVectorSteps = 32;
LobeIntegrals integrateLobe(Brdf brdf, double nv, double roughness);

// Element (i, j) of kBrdfTables.
uint32_t makeBrdfElement(Brdf brdf, int i, int j);

}  // namespace obscura::post
