// In:  a scene.
// Out: its shapes under nothing but an even ambient light, in their own colours or all of one.
#pragma once

#include <glm/vec3.hpp>

#include "obscura/engine/scene.h"

namespace obscura::apps {

// No lights, no emission (what is unlit is black), no node group with an ambient light of its own.
void removeLights(engine::Scene& scene);

// Every surface has this albedo, linear, [0, 1]; what alpha masks cut out stays cut out.
void paint(engine::Scene& scene, glm::vec3 albedo);

}  // namespace obscura::apps
