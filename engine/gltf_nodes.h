// In: a scene of a document.  Out: what its nodes place where.
// Private to engine/gltf*.cpp.
#pragma once

#include <optional>

#include "obscura/engine/gltf_document.h"

namespace obscura::engine::gltf {

struct Placement {
  uint32_t node, mesh;  // of the file; the mesh exists
  glm::dmat4 worldFromObject;
  std::optional<glm::vec3> ambient;  // of the node's own or its nearest ancestor's
};

struct NodeTree {
  std::vector<Placement> placements;  // in the order of the nodes, depth first; of one node by instance
  std::vector<raster::ImplicitSurface> implicits;  // likewise; without a material it is the default one
  std::vector<SceneCamera> cameras;   // likewise
  std::vector<SceneLight> lights;     // likewise
};

// Matrices are accumulated in double. Errors: a node that is reached twice (a cycle, or two parents) or too deep,
// more instances or lights than the limit; an ambient light that is no colour, or one for a node that the scene does not have.
NodeTree placeNodes(Document& document);

}  // namespace obscura::engine::gltf
