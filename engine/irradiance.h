// In:  an environment map.
// Out: its diffuse light: irradiance by normal, from nine spherical harmonics (Ramamoorthi and Hanrahan 2001, "An Efficient
//      Representation for Irradiance Environment Maps").
#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "obscura/engine/environment_map.h"
#include "obscura/post/ambient_light.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {

// L_lm of the radiance per channel, l <= 2, in the order 00, 1-1, 10, 11, 2-2, 2-1, 20, 21, 22 (equations 2 and 3).
using Harmonics = std::array<glm::dvec3, 9>;

// The integral over the sphere by texels and their solid angles: the same bits for any number of threads.
Harmonics harmonicsOf(const EnvironmentMap& map, raster::Parallel& parallel);

// The radiance from the unit direction d that the coefficients make up: a blurred one, and where the map is dark beside something
// bright, a negative one.
glm::dvec3 radianceOf(const Harmonics& l, const glm::dvec3& d);

// E(n) of equation 13, not kept from being negative. It lacks what is beyond the second order: of light from a single
// direction, the worst case, it errs by at most 9.4 % of the largest irradiance (where the light just grazes the surface),
// and falls to -4.0 % of it behind; of skies by far less: see docs/lighting.md.
glm::dvec3 irradiance(const Harmonics& l, const glm::dvec3& n);

// intensity E(n) / pi for normals of another space. viewFromMap: a rotation from the map's directions to that space.
post::NormalQuadric quadricOf(const Harmonics& l, const glm::dmat3& viewFromMap, double intensity);

}  // namespace obscura::engine
