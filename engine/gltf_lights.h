// In: the lights of KHR_lights_punctual and the nodes that place them.  Out: lights of the scene.
// Private to engine/gltf*.cpp.
#pragma once

#include "obscura/engine/gltf_document.h"

namespace obscura::engine::gltf {

// The light's own values, all checked; user: the JSON pointer of who names it.
SceneLight readLight(const Document& document, int index, const std::string& user);

// Position and direction: a light shines along its node's -z. False: the matrix leaves none, or is not finite.
bool placeAt(const glm::dmat4& worldFromNode, SceneLight& light);

}  // namespace obscura::engine::gltf
