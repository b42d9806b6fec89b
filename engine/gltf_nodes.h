// In: a scene of a document.  Out: what its nodes place where.
// Private to engine/gltf*.cpp.
#pragma once

#include "obscura/engine/gltf_document.h"

namespace obscura::engine::gltf {

struct Placement {
  uint32_t node, mesh;  // of the file; the mesh exists
  glm::dmat4 worldFromObject;
};

struct NodeTree {
  std::vector<Placement> placements;  // in the order of the nodes, depth first; of one node by instance
  std::vector<SceneCamera> cameras;   // likewise
};

// Matrices are accumulated in double. Errors: a node that is reached twice (a cycle, or two parents) or too deep,
// more instances than the limit.
NodeTree placeNodes(Document& document);

}  // namespace obscura::engine::gltf
