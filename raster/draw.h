// What a frame draws: instances of meshes, their materials and textures. Spans of somebody else's memory.
#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>

#include "obscura/raster/implicit_surface.h"
#include "obscura/raster/material.h"
#include "obscura/raster/mesh.h"
#include "obscura/raster/span.h"

namespace obscura::raster {

struct Instance {
  const MeshView* mesh = nullptr;
  uint32_t material = 0;                // index into DrawList::materials
  glm::dmat4 worldFromObject{1.0};      // affine; may mirror, shear or flatten
};

// Triangle ids count through the instances in this order: the k-th triangle of instance i has the id
// (triangles of the instances before i) + k. On equal depth the smaller id is seen. Implicit surfaces go on counting: the
// k-th has the id (all triangles) + k, and in the instance plane (all instances) + k.
struct DrawList {
  Span<const Instance> instances;
  Span<const Material> materials;
  Span<const TextureView> textures;
  Span<const ImplicitSurface> implicits = {};
  Span<const HeightView> heights = {};
};

constexpr uint32_t kNoTriangle = 0xFFFFFFFFu;  // in the id planes: nothing was drawn there

}  // namespace obscura::raster
