// The meshes that the scenes of the figures are made of; y up, around the origin.
#pragma once

#include <functional>

#include <glm/vec3.hpp>

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// A grid of columns x rows cells over (u, v) in [0, 1]^2, smooth; counter-clockwise (seen from outside) where u runs to the
// right and v downwards. closed: u = 0 and u = 1 meet. Edges may shrink to a point.
GlbMesh makeSurface(const char* name, int columns, int rows, bool closed, const std::function<glm::dvec3(double u, double v)>& at);

GlbMesh makeBall(double radius, int columns);  // with half as many rows
GlbMesh makeBox(glm::dvec3 half);              // 12 triangles, sharp edges
// A rectangle, its corners counter-clockwise seen from its front.
GlbMesh makeQuad(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d);

// Turns around the y axis: at (radius, height) for v from 0, on top, to 1.
GlbMesh makeTurned(const char* name, int columns, int rows, const std::function<glm::dvec2(double v)>& profile);

}  // namespace obscura::apps
