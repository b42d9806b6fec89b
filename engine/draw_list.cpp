#include "obscura/engine/draw_list.h"

namespace obscura::engine {

raster::DrawList SceneDraws::of(const Scene& scene, bool displacement) {
  meshes_.clear();
  instances_.clear();
  textures_.clear();
  heights_.clear();
  for (const Mesh& m : scene.meshes) meshes_.push_back(m.view());
  for (const Instance& i : scene.instances) instances_.push_back({&meshes_[i.mesh], scene.meshes[i.mesh].material, i.worldFromObject});
  for (const Texture& t : scene.textures) textures_.push_back(t.view);
  for (const HeightMap& h : scene.heightMaps) heights_.push_back(h.view);
  if (displacement) return {instances_, scene.materials, textures_, scene.implicits, heights_};
  flat_ = scene.materials;
  for (raster::Material& m : flat_) m.heightMap.texture = -1;
  return {instances_, flat_, textures_, scene.implicits};
}

raster::DrawList castersOf(const raster::DrawList& list, std::vector<raster::Material>& materials) {
  materials.assign(list.materials.begin(), list.materials.end());
  for (raster::Material& m : materials) m.doubleSided = true;
  raster::DrawList casters = list;
  casters.materials = materials;
  return casters;
}

}  // namespace obscura::engine
