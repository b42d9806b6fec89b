// In:  a light of the scene, the frame's camera, a box around what is seen of the light.
// Out: the light as the post process takes it, and the cameras of its shadow maps.
#pragma once

#include <vector>

#include "obscura/engine/scene.h"
#include "obscura/post/direct_light.h"

namespace obscura::engine {

// Null, or what is wrong with a light.
const char* wrongLight(const SceneLight& light);

struct LightViews {
  post::PunctualLight light;            // its maps' depth is null
  std::vector<raster::Camera> cameras;  // as many as it has maps
};

// Shadow maps show two texels more on each side than lit points need, for the filter. A spot that opens by less than 53
// degrees from its axis has one; wider ones have six, as point lights have. What is nearer to a point or spot light than
// 1/10000 of the scene's size casts no shadow. size: texels a side; 0: no maps. Of directional lights see fitted().
LightViews viewsOf(const SceneLight& light, const raster::Camera& camera, const Bounds& scene, int size);

// A directional light with one map: its map shows all that is seen, and what of the scene lies before that. `seen`: in the
// light space that viewsOf() gives, and the same for every crop of a frame, as the map is made of it.
void fitted(const SceneLight& light, const raster::Camera& camera, const Bounds& scene, int size, const post::LightBounds& seen,
            LightViews& views);

}  // namespace obscura::engine
