// In: a node's extras.  Out: the implicit surface that they describe.
// Private to engine/gltf*.cpp.
#pragma once

#include "obscura/engine/gltf_document.h"

namespace obscura::engine::gltf {

// `extras` is what the node's extras have as obscura_implicit, its members' types checked; path: its JSON pointer.
// Errors: a type that is not known, a length that the type needs and that is missing or not positive, no such material.
raster::ImplicitSurface readImplicit(const Document& document, const tinygltf::Value& extras, const std::string& path);

}  // namespace obscura::engine::gltf
