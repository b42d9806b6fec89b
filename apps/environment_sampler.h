// In:  an environment map.
// Out: its radiance by direction, and directions by importance.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "obscura/engine/environment_map.h"

namespace obscura::apps {

// Directions are of the space that viewFromMap, a rotation, leads to. Their density over a latlong map, the given one or one of as
// many texels, is the sum of its channels, interpolated as look-ups are, by the solid angle of its rows; even if it is black.
class EnvironmentSampler {
 public:
  // The map must outlive it. intensity: a factor on the radiance.
  EnvironmentSampler(const engine::EnvironmentMap& map, const glm::dmat3& viewFromMap, double intensity, raster::Parallel& parallel);

  glm::dvec3 radiance(const glm::dvec3& direction) const { return intensity_ * map_.lookUp(mapFromView_ * direction); }
  glm::dvec3 direction(const glm::dvec2& xi) const;   // for a point of the unit square
  double density(const glm::dvec3& direction) const;  // of these, per steradian

 private:
  double weight(int x, int y) const;  // of a texel, or of the nearest one beyond a pole

  const engine::EnvironmentMap& map_;
  glm::dmat3 viewFromMap_, mapFromView_;
  double intensity_;
  engine::EnvironmentProjector latlong_;
  std::vector<double> upTo_;      // of each row, width + 1: the sum of its texels' weights before this one
  std::vector<double> rowsUpTo_;  // height + 1
};

}  // namespace obscura::apps
