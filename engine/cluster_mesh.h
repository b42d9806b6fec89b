// In: a mesh.  Out: its clusters, patches of the surface so that each is compact and faces one way.
#pragma once

#include "obscura/engine/scene.h"

namespace obscura::engine {

// Fills mesh.clusters. Vertices of equal position (bit for bit) are one vertex there. Positions may be anything,
// indices must be < positions.size(). Without memory for it the clusters stay empty: the mesh is then cut per frame.
void clusterMesh(Mesh& mesh);

}  // namespace obscura::engine
