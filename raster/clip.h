// In: a triangle in view space.  Out: the convex polygon of it that can be projected and snapped.
#pragma once

#include <glm/vec3.hpp>

#include "obscura/raster/view.h"

namespace obscura::raster {

// A convex polygon gains one vertex per plane; rounding may bend it, but each of the six cuts makes at most half as
// many vertices again: 3, 4, 6, 9, 13, 19, 28.
constexpr int kMaxClipped = 28;

// Cuts by near, far and the guard band (Sutherland and Hodgman). An edge is always cut from its inner to its outer
// vertex, so two triangles that share it get the same bits. Returns the number of vertices, 0 if nothing is left or
// a vertex is not finite.
int clipTriangle(const View& view, const glm::vec3 triangle[3], glm::vec3 polygon[kMaxClipped]);

// View position -> snapped vertex, exactly as the vertex stage does it. The position lies in the clipped region.
void snapVertex(const View& view, glm::vec3 position, int32_t& xSub, int32_t& ySub, float& key);

}  // namespace obscura::raster
