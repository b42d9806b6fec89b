// In: a scene.  Out: what raster draws of it.
#pragma once

#include <vector>

#include "obscura/engine/scene.h"
#include "obscura/raster/draw.h"

namespace obscura::engine {

// Keeps what the list points to, the scene's own memory besides.
class SceneDraws {
 public:
  // displacement: false: without height maps.
  raster::DrawList of(const Scene& scene, bool displacement);
  raster::Span<const raster::HeightView> heights() const { return heights_; }

 private:
  std::vector<raster::MeshView> meshes_;
  std::vector<raster::Instance> instances_;
  std::vector<raster::TextureView> textures_;
  std::vector<raster::HeightView> heights_;
  std::vector<raster::Material> flat_;
};

// The same, as it casts shadows: whatever their material, surfaces do so on both sides, so that a wall of one side holds the
// light off as well. `materials` keeps what the list points to.
raster::DrawList castersOf(const raster::DrawList& list, std::vector<raster::Material>& materials);

}  // namespace obscura::engine
