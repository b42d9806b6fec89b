// In:  all surfaces of a scene; directions, one for each class; an environment.
// Out: how much of its light arrives at the surfaces of each class: what of the scene stands in its way.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "obscura/engine/irradiance.h"
#include "obscura/engine/scene.h"
#include "obscura/raster/rasterizer.h"

namespace obscura::engine {

// Of the light from outside that a surface would get of its whole hemisphere, by cosines: the part that arrives, 0 ... 1.
struct OutsidePart {
  double open = 1;        // of light that is the same from everywhere: how much of its view is the outside
  glm::dvec3 passed{1};   // of the environment's, per channel
};

// Points all over the surfaces, each for the same area, see 32 shadow maps of the whole scene from all around (bounced_light.h).
// They count for the classes by the weights of ambientClasses(). The environment is here what its coefficients of the first two
// orders make of it, kept from being negative. What is open by less than 1/256 counts as closed: maps cannot tell. What no surface belongs to gets the mean of all; without surfaces all is open.
// worldFromMap: a rotation. The same bits for any number of threads. Throws std::bad_alloc.
std::vector<OutsidePart> outsideParts(const Scene& scene, const std::vector<glm::dvec3>& directions, const Harmonics& environment,
                                      const glm::dmat3& worldFromMap, const raster::Settings& settings);

}  // namespace obscura::engine
