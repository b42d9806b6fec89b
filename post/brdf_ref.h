// Scalar twin of brdf-inl.h: the formulas of brdf.h, a surface at a time.
#pragma once

#include <glm/vec3.hpp>

#include "obscura/post/brdf.h"
#include "obscura/post/projector.h"

namespace obscura::post::ref {

// Towards the eye from what a pixel sees: unit, in the space of the G-buffer's normals.
glm::vec3 viewDirection(const Projector& projector, int x, int y);

struct Surface {
  glm::vec3 base{0};  // as in the G-buffer, like the next three
  float metallic = 0, roughness = 1;
  glm::vec3 n{0, 0, 1}, v{0, 0, 1};  // v of viewDirection()
};

struct Reflectance {
  glm::vec3 diffuse, specular;  // R_A(v) is their sum
};
Reflectance ambientReflectance(Brdf brdf, const Surface& surface);

// f(l, v), 1 / sr: without the cosine at the light. l unit, nl = n.l > 0.
glm::vec3 reflection(Brdf brdf, const Surface& surface, const glm::vec3& l, float nl);

}  // namespace obscura::post::ref
