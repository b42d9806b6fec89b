// In: a scene and a frame's settings.  Out: the ambient light La(x) as the post process takes it.
#pragma once

#include <vector>

#include "obscura/engine/frame.h"
#include "obscura/post/ambient_light.h"
#include "obscura/post/environment_cube.h"

namespace obscura::engine {

// Some instance has an ambient light of its own.
bool hasAmbientGroups(const Scene& scene);

// From directions of an environment map that is turned by so many degrees around +y, counter-clockwise seen from above, to
// view space: a rotation, for cameras whose view is one but for a scale.
glm::dmat3 viewFromEnvironment(const raster::Camera& camera, double degrees);

// What the environment's cubes are to the pixels of a frame. They must be there.
post::EnvironmentView environmentViewOf(const FrameSettings& settings);

// The table that the result may point to is kept in `table`. Throws std::invalid_argument if an instance's light is below 0
// or not finite.
post::AmbientLight ambientLightOf(const Scene& scene, const FrameSettings& settings, std::vector<glm::vec3>& table);

}  // namespace obscura::engine
