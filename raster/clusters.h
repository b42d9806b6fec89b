// Clusters: short runs of neighbouring triangles that are culled, transformed and set up together.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/raster/span.h"

namespace obscura::raster {

// The vertices of a cluster are stored once more, contiguous and as structure of arrays, so that a cluster is
// transformed with plain vector loads; its triangles name them by one byte each.
struct Cluster {
  glm::vec3 center{0};      // bounding sphere of the finite vertices, object space
  float radius = 0;         // rounded up; may be infinite
  glm::vec3 coneAxis{0};    // unit; every plane's normal n has dot(n, coneAxis) >= coneCos |n|, n = 0 included
  float coneCos = -1;       // 2^-16 below the exact value, > 0; or -1: no cone (normals all around, or not finite)
  uint32_t firstVertex = 0, vertexCount = 0;      // into Clusters::x, y, z; firstVertex is a multiple of 16
  uint32_t firstTriangle = 0, triangleCount = 0;  // into the per-triangle arrays; a multiple of 16
};

// Acceleration data of one mesh. Triangles keep their number in the mesh (`triangle`), which is what the
// visibility buffer records and what breaks ties, so clustering cannot change an image.
struct Clusters {
  static constexpr uint32_t kMaxVertices = 128, kMaxTriangles = 128;
  std::vector<Cluster> clusters;
  std::vector<float> x, y, z;                    // padded per cluster to 16, with its first vertex
  std::vector<uint32_t> corners;                 // cluster-local vertices, one byte each, corner 0 lowest; padded
  std::vector<uint32_t> triangle;                // number of the triangle in the mesh; padding repeats the first,
                                                 // its corners and its plane are 0
  // Facing: n = (v1 - v0) x (v2 - v0), rounded to float from double, and dot(n, v0 - center) in float. Infinite where that
  // overflows, NaN where a vertex is not finite or n is so short that products with it could underflow.
  std::vector<float> planeX, planeY, planeZ, planeW;
  uint32_t triangleCount = 0;
  glm::vec3 center{0};  // sphere around all clusters' spheres
  float radius = 0;     // rounded up; may be infinite
  bool empty() const { return clusters.empty(); }
};

// In:  positions (finite or not) and indices of a mesh, three per triangle, and how to cut it: `order` lists all triangles (a list that is not a permutation of them counts as empty: as they come),
//      `counts` the triangles of each cluster (past its end: as many as fit). A cluster that would exceed
//      kMaxTriangles or kMaxVertices is split.
// Out: the clusters; every triangle is in exactly one. Throws std::invalid_argument, naming the value, if an index is not
//      below positions.size(), and std::bad_alloc when there is no memory.
Clusters buildClusters(Span<const glm::vec3> positions, Span<const uint32_t> indices, Span<const uint32_t> order = {},
                       Span<const uint32_t> counts = {});

}  // namespace obscura::raster
