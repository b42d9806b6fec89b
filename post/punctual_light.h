// Lights without extent as the camera of a frame sees them, and their shadow maps.
#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "obscura/post/projector.h"
#include "obscura/raster/plane.h"

namespace obscura::post {

enum class LightKind : uint8_t { Directional, Point, Spot };

// What a light sees first, by Rasterizer::renderDepth. The texel of a point (x, y, w) of its space, x right, y up, w along
// the view axis, is (x / w, y / w) or (x, y) times the projector's scale plus its centre.
struct ShadowMap {
  const raster::Plane<float>* depth = nullptr;  // w, infinity where there is nothing; null: nothing casts a shadow there
  Projector projector;
};

// Light space has its origin at the light (a directional one: where its shadow map says) and the world's lengths:
//   one map    x right, y up, w along the map's view axis
//   six maps   any three axes; map 2 a looks along axis a, 2 a + 1 against it. Its x and y are the axes a + 2, a + 1, and for
//              the other a + 1, a + 2 (modulo 3). A point belongs to the map of its largest coordinate.
struct PunctualLight {
  LightKind kind = LightKind::Directional;
  glm::vec3 color{1};             // linear; lux (directional) or candela, 0 ... 10^15
  glm::vec3 place{0, 0, 1};       // camera space, z towards the eye: unit, towards the light (directional), or where it is
  glm::mat3 lightFromView{1};     // light space from camera space: lightFromView p + origin
  glm::mat3 lightFromNormal{1};   // alike for unit normals
  glm::vec3 origin{0};
  float worldFromView = 1;        // how long a length of camera space is in the world
  // Falloff of KHR_lights_punctual: max(0, 1 - (d / range)^4) / d^2, and for spots s^2 with
  // s = clamp(cos(angle to the axis) coneScale + coneOffset, 0, 1).
  float range = 0;                // 0: without end
  glm::vec3 axis{0, 0, 1};        // light space, unit, where a spot shines to
  float coneScale = 0, coneOffset = 1;
  int maps = 0;                   // 0, 1 or 6
  ShadowMap map[6];
};

}  // namespace obscura::post
