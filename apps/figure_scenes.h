// The scenes that several figures show.
#pragma once

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// A carved urn on a slab, all of albedo (0.6, 0.3, 0.3); about 160,000 triangles, 2 units high. Carvings are some 0.11 deep.
GlbScene makeCarvedScene();

// A corridor, and without `door` nothing else; with it, seen through an open door, which is nearer than 3 units.
GlbScene makeCorridorScene(bool door);

}  // namespace obscura::apps
