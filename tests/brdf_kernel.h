// brdf-inl.h as a stage of its own, for the tests.
#pragma once

#include <vector>

#include "obscura/post/brdf_ref.h"
#include "obscura/raster/target.h"

namespace obscura::tests {

struct Lit {
  post::ref::Surface surface;
  glm::vec3 l;
  float nl;
};

struct Reflected {
  glm::vec3 diffuse, specular, towards;
};

std::vector<Reflected> reflectAll(post::Brdf brdf, const std::vector<Lit>& lit, raster::Target target);

// By ViewDirections, of a row.
std::vector<glm::vec3> viewDirections(const post::Projector& projector, int y, raster::Target target);

}  // namespace obscura::tests
