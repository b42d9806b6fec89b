// Small scenes for what is not made of triangles.
#pragma once

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// One implicit surface of each kind on a floor of triangles, some of them half sunk in it; and a stone in one.
GlbScene makeImplicitScene();

// A floor that a 16-bit height map displaces, rolling with stones in it, and a block that stands on it.
GlbScene makeReliefScene();

}  // namespace obscura::apps
