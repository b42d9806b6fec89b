// Environment maps for tests, by functions of the direction.
#pragma once

#include "obscura/engine/environment_map.h"

namespace obscura::tests {

// `side` texels a side, of a latlong map twice as many across.
inline engine::EnvironmentProjector environmentProjector(engine::EnvironmentProjection p, int side) {
  return {p, p == engine::EnvironmentProjection::Latlong ? 2 * side : side, side};
}

// radiance(direction) of each texel's centre, panel by panel, row by row.
template <class F>
engine::EnvironmentMap filledEnvironment(const engine::EnvironmentProjector& p, const F& radiance) {
  engine::EnvironmentMap map(p);
  for (int panel = 0; panel < p.panels(); ++panel)
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x)
        if (p.shows(x, y)) map.at(panel, x, y) = glm::vec3(radiance(p.directionAt({panel, x + 0.5, y + 0.5})));
  raster::Parallel parallel(2);
  map.fillBorders(parallel);
  return map;
}

}  // namespace obscura::tests
