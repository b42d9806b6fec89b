// A tree by recursion: a trunk that divides into limbs, branches and twigs, and the places where its leaves sit.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

struct LeafSite {
  glm::dvec3 position;
  double size;  // 1: a clump as it is modelled
};

struct Tree {
  GlbMesh bark;  // everything wooden; the foot of the trunk is at the origin, y up, metres
  std::vector<LeafSite> leaves;
};

Tree makeTree(uint64_t seed);

}  // namespace obscura::apps
