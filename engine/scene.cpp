#include "obscura/engine/scene.h"

namespace obscura::engine {

raster::MeshView Mesh::view() const {
  raster::MeshView v;
  v.positions = positions;
  v.normals = normals;
  v.tangents = tangents;
  v.uvs[0] = uvs[0];
  v.uvs[1] = uvs[1];
  v.colors = colors;
  v.indices = indices;
  if (!clusters.empty()) v.clusters = &clusters;
  return v;
}

}  // namespace obscura::engine
