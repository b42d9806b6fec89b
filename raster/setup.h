// In:  a cluster and its transformed vertices.
// Out: its visible triangles, in the bins of the tiles they may cover.
#pragma once

#include "obscura/raster/bins.h"
#include "obscura/raster/occlusion.h"
#include "obscura/raster/statistics.h"
#include "obscura/raster/target.h"
#include "obscura/raster/transform.h"

namespace obscura::raster {

// A single-sided triangle is seen if it faces the eye before *and* after snapping:
//   before: n . eye - (n . v0) eye.w > 0, as ((n.x (e.x - v0.x) + n.y (e.y - v0.y)) + n.z (e.z - v0.z)) in double
//           (eye.w = 0: n . e), n = (v1 - v0) x (v2 - v0) in double: float could not tell a needle's side, and a plane of
//           needles would have holes. This is what lets a cluster be culled by its normal cone without changing a bit:
//           tiny triangles may turn round when they are snapped.
//   after:  the doubled area's sign.
// Double-sided triangles only need an area; of a flattened instance only the second test is made.
// Of a draw with Draw::away (single-sided) those are taken that face away before and after, both signs turned: < 0 and the
// other area. What is edge-on, or turned round by snapping, is neither.
// occlusion: what is hidden by triangles drawn before, or null.
void setupCluster(const View& view, const Draw& draw, const Cluster& cluster, const TransformedVertices& vertices,
                  const OcclusionMap* occlusion, Bins& bins, Statistics& statistics, Target target);

// The exact predicate "before" for one triangle of the mesh; with Draw::away, of facing away.
bool facesEye(const Draw& draw, uint32_t triangle);

// One triangle by the scalar way, clipping it if need be (any size; the few that the SIMD path does not take).
void setupSingle(const View& view, const Draw& draw, uint32_t triangle, Bins& bins, Statistics& statistics);

}  // namespace obscura::raster
