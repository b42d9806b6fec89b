// The G-buffer: what is seen in each pixel, one plane per scalar.
#pragma once

#include <cstdint>

#include "obscura/raster/draw.h"
#include "obscura/raster/plane.h"

namespace obscura::raster {

// Which planes a frame needs. The others are not allocated, and nothing is computed for them.
struct PlaneSet {
  bool depth = false, normal = false, albedo = false, emissive = false, position = false;
  bool triangle = false, instance = false, material = false;
};

// Empty pixels hold: depth infinity; normal, albedo, emissive and position 0; ids kNoTriangle.
struct GBuffer {
  int width = 0, height = 0;
  Plane<float> depth;        // zView: distance along the view axis, scene units
  Plane<float> normal[3];    // unit, camera space: x right, y up, z towards the eye
  Plane<float> albedo[3];    // linear, [0, 1]: base colour factor x texture x vertex colour; 0 where unlit
  Plane<float> emissive[3];  // linear, >= 0; the base colour where unlit
  Plane<float> position[3];  // camera space, scene units
  Plane<uint32_t> triangle;  // id, see DrawList
  Plane<uint32_t> instance;  // index into DrawList::instances
  Plane<uint32_t> material;  // index into DrawList::materials

  GBuffer() = default;
  GBuffer(int width, int height, const PlaneSet& planes);
  bool has(const PlaneSet& planes) const;  // all of these are there
};

}  // namespace obscura::raster
