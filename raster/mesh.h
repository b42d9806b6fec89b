// What a mesh is to the rasterizer: spans of vertices and indices, nothing owned.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "obscura/raster/clusters.h"
#include "obscura/raster/span.h"

namespace obscura::raster {

// Triangles that share one material. All attribute spans but `positions` may be empty; those that are not
// have one element per vertex. Any value may be NaN or infinite: the triangles concerned are dropped and
// counted, or the attribute counts as 0. Nothing is copied: the memory must stay until the frame is done.
struct MeshView {
  Span<const glm::vec3> positions;    // object space, right-handed
  Span<const glm::vec3> normals;      // object space; need not be unit. Empty: the triangle's plane (flat)
  Span<const glm::vec4> tangents;     // xyz, w = +-1 the bitangent's sign. Empty: from the uv's gradients
  Span<const glm::vec2> uvs[2];       // texture coordinates, v downwards as in glTF
  Span<const glm::vec4> colors;       // linear RGBA factors
  Span<const uint32_t> indices;       // three per triangle, counter-clockwise seen from outside
  const Clusters* clusters = nullptr; // acceleration data of exactly these triangles; null: made per frame

  uint32_t triangleCount() const { return uint32_t(indices.size() / 3); }
};

}  // namespace obscura::raster
