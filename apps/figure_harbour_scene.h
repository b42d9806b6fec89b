// The scene of the harbour.
#pragma once

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// About 30 units wide, y up, the water at y = 0. Nodes: "water", "goods" (crates and barrels), and others.
GlbScene makeHarbourScene();

}  // namespace obscura::apps
