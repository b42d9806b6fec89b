// In:  the G-buffer.
// Out: the obscurance by a few traced rays a pixel: the peer that obscura's estimators are measured against.
#pragma once

#include "obscura/apps/ray_scene.h"
#include "obscura/post/ambient_transfer.h"
#include "obscura/raster/parallel.h"

namespace obscura::apps {

// Writes sums as the ambient transfer does, so that the same filter follows: settings.samples rays a pixel whose mu are
// added up. Given the care that the estimators have: one scrambled Sobol net of 16 n directions, dealt to the 4x4 pattern
// whose box the filter sums; sixteen rays at a time, of neighbouring pixels where one has fewer. Rays begin at the depth
// map's point, 1/500 R along the normal from it.
void traceObscurance(const RayScene& rays, const post::TransferInput& in, raster::Parallel& parallel, post::TransferSums& out);

}  // namespace obscura::apps
