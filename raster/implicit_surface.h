// Implicit surfaces as plain data: f(p) >= 0 is outside, f(p) < 0 inside, the surface is between.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace obscura::raster {

enum class ImplicitShape : uint8_t {
  Sphere,     // around the origin: radius
  Box,        // around the origin, along the axes: halfSize
  Torus,      // around the y axis: radius of the circle in its middle, tube the radius of what goes round it
  Metaballs,  // balls, which flow into one another where they are near; one alone is a sphere
  Gyroid,     // a wall along sin x cos y + sin y cos z + sin z cos x = 0, cut to a sphere (radius) or a box (halfSize)
  Function,   // a function of the caller's, cut to the ball of `radius` around the origin
};

// Lengths are in object space, positive and at most kMostImplicit but where it says otherwise.
struct ImplicitBall {
  glm::dvec3 center{0};
  double radius = 1;
};

constexpr double kMostImplicit = 1e15;
constexpr size_t kMostBalls = 1024;  // of one surface

struct ImplicitSurface {
  ImplicitShape shape = ImplicitShape::Sphere;
  double radius = 1;                // Gyroid: 0 cuts it to a box
  double tube = 0.25;               // Torus
  glm::dvec3 halfSize{1};           // Box; Gyroid with radius 0
  double period = 1;                // Gyroid: repeats after this length in x, y and z
  double thickness = 0.1;           // Gyroid: the wall is nowhere thinner
  std::vector<ImplicitBall> balls;  // Metaballs: 1 ... kMostBalls
  // Function: any value for any finite point, the same for the same point, from many threads at once; NaN counts as
  // outside. What is thinner than 1/1024 of a ray's way through the ball may be missed, see implicit.h.
  std::function<double(const glm::dvec3&)> function;
  double steepness = 1;             // Function: |f(p) - f(q)| <= steepness |p - q|. If it is not so, holes are seen
  // Of it the factors alone count: no texture, since there are no texture coordinates. doubleSided: what lies inside is
  // seen from inside, too.
  uint32_t material = 0;            // index into DrawList::materials
  glm::dmat4 worldFromObject{1.0};  // affine; may mirror and shear. One without inverse shows nothing
};

// A ball that holds the surface, object space. Its f is positive on the ball's border and beyond.
struct ImplicitBound {
  glm::dvec3 center{0};
  double radius = 0;
};
ImplicitBound boundOf(const ImplicitSurface& surface);

// Null, or what is wrong with it: "its radius is not positive", ...
const char* wrongImplicit(const ImplicitSurface& surface);

}  // namespace obscura::raster
