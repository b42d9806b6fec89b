// Directions that surfaces are told apart by: the classes of the extended ambient term, the sides of a cube of colours.
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/post/ambient_light.h"

namespace obscura::engine {

// With fewer than four some normals would face away from all of them.
constexpr int kLeastClasses = 4, kMostClasses = 256;

// count: kLeastClasses ... kMostClasses unit vectors, spread over the sphere: the normals of the faces of a platonic solid where
// one has so many (4, 6, 8, 12, 20), else a spherical Fibonacci spiral. 6: a cube's, +x, -x, +y, -y, +z, -z. With the weights
// max(0, n . f) the mean of those of a solid, but for the tetrahedron's, points along n; of a spiral it is off by at most 43
// degrees for 5, 21 for 7, 5.4 for 16, 1 for 64. Every class gets the same part of all directions within 7 %.
std::vector<glm::dvec3> spreadDirections(int count);

// Colours by direction: those of the cube's sides, in that order.
std::vector<post::AmbientDirection> cubeOf(const std::array<glm::vec3, 6>& colors);

}  // namespace obscura::engine
