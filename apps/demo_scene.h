// The scene that `./demo` shows: a tree with stones on uneven ground, after the figures of the papers.
#pragma once

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// Some 120,000 triangles as drawn, nine materials, most meshes shared by many nodes; units are metres. The same bytes
// on every machine: its numbers come from integers, + - * / sqrt and raster/exact_math.h.
GlbScene makeDemoScene();

}  // namespace obscura::apps
