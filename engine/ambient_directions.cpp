#include "obscura/engine/ambient_directions.h"

#include <cmath>

#include "obscura/raster/exact_math.h"

namespace obscura::engine {
namespace {

using glm::dvec3;
using Directions = std::vector<dvec3>;

// (0, +-a, +-b) and its cyclic permutations.
void addRectangles(double a, double b, Directions& out) {
  for (int axis = 0; axis < 3; ++axis)
    for (int sign = 0; sign < 4; ++sign) {
      dvec3 v(0);
      v[(axis + 1) % 3] = sign & 1 ? -a : a, v[(axis + 2) % 3] = sign & 2 ? -b : b;
      out.push_back(v);
    }
}

void addCorners(Directions& out) {
  for (int k = 0; k < 8; ++k) out.push_back(dvec3(k & 1 ? -1 : 1, k & 2 ? -1 : 1, k & 4 ? -1 : 1));
}

// Swinbank and Purser 2006, "Fibonacci grids": equal steps of height, and the golden angle from one to the next.
Directions spiral(int count) {
  constexpr double kGoldenAngle = 2.399963229728653;
  Directions out;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1) / double(count), across = std::sqrt(1 - y * y), angle = i * kGoldenAngle;
    out.push_back({across * raster::exactCos(angle), y, across * raster::exactSin(angle)});
  }
  return out;
}

}  // namespace

std::vector<glm::dvec3> spreadDirections(int count) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  Directions out;
  switch (count) {
    case 4: out = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}; break;
    case 6: out = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}; break;
    case 8: addCorners(out); break;
    case 12: addRectangles(1, golden, out); break;
    case 20: addCorners(out), addRectangles(1 / golden, golden, out); break;
    default: out = spiral(count);
  }
  for (dvec3& d : out) d /= std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  return out;
}

std::vector<post::AmbientDirection> cubeOf(const std::array<glm::vec3, 6>& colors) {
  std::vector<post::AmbientDirection> out;
  const Directions sides = spreadDirections(6);
  for (size_t k = 0; k < 6; ++k) out.push_back({glm::vec3(sides[k]), colors[k]});
  return out;
}

}  // namespace obscura::engine
