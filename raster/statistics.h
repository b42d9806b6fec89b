// What a frame met and what it could skip.
#pragma once

#include <cstdint>

namespace obscura::raster {

// Every triangle of a drawn cluster ends in exactly one of: facingAway, outside, hidden, invalid, drawn; those of culled
// instances and clusters are counted with them.
struct Statistics {
  uint64_t instances = 0, instancesCulled = 0;  // outside the view
  uint64_t clusters = 0, clustersCulled = 0;    // of the instances left: outside the view, facing away, or between pixel centres
  uint64_t instancesHidden = 0, clustersHidden = 0;  // behind what was drawn before
  uint64_t triangles = 0;        // submitted
  uint64_t trianglesCulled = 0;  // in culled and hidden instances and clusters
  uint64_t facingAway = 0;       // single-sided, seen from behind; or without area after snapping
  uint64_t outside = 0;          // covers no pixel centre of the image
  uint64_t hidden = 0;           // behind what was drawn before
  uint64_t clipped = 0;          // cut by the near or far plane or the guard band (and then drawn or outside)
  uint64_t invalid = 0;          // NaN or infinite positions
  uint64_t drawn = 0;            // sent to tiles
  uint64_t tiles = 0, tilesEmpty = 0;

  void add(const Statistics& o) {
    instances += o.instances, instancesCulled += o.instancesCulled;
    clusters += o.clusters, clustersCulled += o.clustersCulled;
    instancesHidden += o.instancesHidden, clustersHidden += o.clustersHidden;
    triangles += o.triangles, trianglesCulled += o.trianglesCulled;
    facingAway += o.facingAway, outside += o.outside, hidden += o.hidden, clipped += o.clipped, invalid += o.invalid, drawn += o.drawn;
    tiles += o.tiles, tilesEmpty += o.tilesEmpty;
  }
};

}  // namespace obscura::raster
