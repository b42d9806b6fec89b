// In:  albedo, emission, depth; O or W.
// Out: linear colour, Lr = a W La + emission (long paper, equation 2).
#pragma once

#include <glm/vec3.hpp>

#include "obscura/post/depth_filter.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/target.h"

namespace obscura::post {

enum class Occlusion : uint8_t { None, Obscurance, Transfer };  // what modulates the ambient light: 1, O or W

struct LightInput {
  const raster::GBuffer* g = nullptr;  // depth and albedo; emission where the scene has any
  const Transfer* transfer = nullptr;  // may be null for Occlusion::None
  Occlusion occlusion = Occlusion::Transfer;
  glm::vec3 ambient{1};                // La, linear
  glm::vec3 background{0};             // linear; where nothing was drawn
};

struct LinearColor {
  raster::Plane<float> rgb[3];
};

LinearColor makeLinearColor(int width, int height, LinearColor used = {});

void light(const LightInput& in, int y0, int y1, LinearColor& out, raster::Target target);
void lightRef(const LightInput& in, int y0, int y1, LinearColor& out);  // the scalar twin

}  // namespace obscura::post
