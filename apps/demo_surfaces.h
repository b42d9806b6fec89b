// Small scenes for what is not made of triangles, and for materials.
#pragma once

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// One implicit surface of each kind on a floor of triangles, some of them half sunk in it; and a stone in one.
GlbScene makeImplicitScene();

// A floor that a 16-bit height map displaces, rolling with stones in it, and a block that stands on it.
GlbScene makeReliefScene();

// Four rows of six spheres, roughness 0 ... 1 to the right: gold, half metal, blue and black lacquer, nearer and nearer. The
// tiles below have metallic and roughness from a texture.
GlbScene makeMaterialsScene();

}  // namespace obscura::apps
