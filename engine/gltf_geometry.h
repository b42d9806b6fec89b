// In: a primitive of a glTF mesh.  Out: an indexed triangle list.
// Private to engine/gltf*.cpp.
#pragma once

#include <optional>

#include "obscura/engine/gltf_document.h"

namespace obscura::engine::gltf {

// What the primitive's material samples, so that nothing else is read.
struct VertexNeeds {
  int uvSource[2] = {-1, -1};  // Mesh::uvs[k] is TEXCOORD_uvSource[k]; -1: not needed
  bool tangents = false;
};

struct Geometry {
  Mesh mesh;               // without name, material and clusters
  glm::vec3 min{0}, max{0};  // of the finite positions of all triangles
  bool bounded = false;      // there are such positions
};

// Nothing, with a warning where one is due: a primitive that draws no triangle. `path` is its JSON pointer.
std::optional<Geometry> readPrimitive(Document& document, const tinygltf::Primitive& primitive, const std::string& path,
                                      const VertexNeeds& needs);

}  // namespace obscura::engine::gltf
