// A small scene for direct lights and their shadows.
#pragma once

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// A courtyard: a floor between two walls, a red one and one with columns before it, a tree, stones and balls; a low sun, a
// lamp among the balls and a spot from above.
GlbScene makeLightsScene();

}  // namespace obscura::apps
