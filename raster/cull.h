// In:  bounding spheres and normal cones.
// Out: what certainly covers no pixel. Conservative by margins far above float's rounding, so it cannot change a bit.
#pragma once

#include "obscura/raster/clusters.h"
#include "obscura/raster/occlusion.h"
#include "obscura/raster/transform.h"
#include "obscura/raster/view.h"

namespace obscura::raster {

// A bounding sphere, seen: view-space centre, and a radius with room for the rounding of every vertex inside. reach is
// infinite or NaN where float cannot tell.
struct ViewSphere {
  float p[3];
  float reach;
};
ViewSphere viewSphere(const Draw& draw, const glm::vec3& center, float radius);

// It reaches into the view (or may).
bool sphereVisible(const View& view, const ViewSphere& sphere);

// The pixels that it may touch, and the key of its nearest point; all pixels and an infinite key if it is not wholly in
// front of the eye.
ScreenBound screenBound(const View& view, const ViewSphere& sphere);

// The pixel centres between the vertices of a cluster, none of which needs clipping; exact.
ScreenBound boundOf(const View& view, const TransformedVertices& vertices);

// Some triangle of the cluster may face the eye, or away from it for Draw::away. Always true for what has two sides.
bool clusterFacesEye(const Draw& draw, const Cluster& cluster);

}  // namespace obscura::raster
