// In:  bounding spheres and normal cones.
// Out: what certainly covers no pixel. Conservative by margins far above float's rounding, so it cannot change a bit.
#pragma once

#include "obscura/raster/clusters.h"
#include "obscura/raster/view.h"

namespace obscura::raster {

// A sphere in object space reaches into the view (or may).
bool sphereVisible(const View& view, const Draw& draw, const glm::vec3& center, float radius);

// Some triangle of the cluster may face the eye, or away from it for Draw::away. Always true for what has two sides.
bool clusterFacesEye(const Draw& draw, const Cluster& cluster);

}  // namespace obscura::raster
