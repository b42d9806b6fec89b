// An environment of the project's own: a sky with clouds and a low sun over hills.
#pragma once

#include <memory>

#include "obscura/apps/figure.h"
#include "obscura/engine/environment.h"
#include "obscura/engine/environment_map.h"

namespace obscura::apps {

// Radiance by direction (unit); about 1 overhead, 150 in the sun.
glm::dvec3 skyRadiance(const glm::dvec3& direction);

// As a latlong map, height texels high. The same bits for any number of threads.
engine::EnvironmentMap makeSky(int height, int threads);

// To light with, to look into and to be reflected, as fine as pictures of this size need it.
std::shared_ptr<const engine::Environment> makeSkyLight(const FigureSettings& settings,
                                                        engine::EnvironmentParts parts = engine::EnvironmentParts::Background);

}  // namespace obscura::apps
