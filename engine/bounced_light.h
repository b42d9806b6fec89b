// In:  the lights of a scene, and what of it casts shadows.
// Out: how much of them arrives at its points: the first bounce of direct light.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "obscura/engine/draw_list.h"
#include "obscura/engine/scene.h"
#include "obscura/post/direct_light.h"
#include "obscura/raster/rasterizer.h"

namespace obscura::engine {

// Shadow maps that are fitted to a whole scene, of one light after another.
class SceneShadows {
 public:
  SceneShadows(const Scene& scene, const raster::Settings& settings);
  SceneShadows(const SceneShadows&) = delete;

  // The light in world space, for post::arrivingAt(). size: texels a side of its maps, which `maps` keeps for it; 0: it has none.
  // What `maps` held before is written over. Throws std::bad_alloc.
  post::PunctualLight of(const SceneLight& light, int size, std::vector<raster::Plane<float>>& maps);

 private:
  const Bounds bounds_;
  SceneDraws draws_;
  std::vector<raster::Material> materials_;
  const raster::DrawList casters_;
  raster::Rasterizer rasterizer_;
};

// Shadow maps of all lights, fitted to the whole scene (Scene::bounds): 1024 texels a side, or less where many lights would
// need more than 256 MB. Throws std::bad_alloc.
class BouncedLight {
 public:
  BouncedLight(const Scene& scene, raster::Span<const SceneLight> lights, bool shadows, const raster::Settings& settings);
  BouncedLight(const BouncedLight&) = delete;

  // Irradiance per channel of a point with the unit normal of its surface, world space. From any thread.
  glm::dvec3 at(const glm::dvec3& point, const glm::dvec3& normal) const;

 private:
  std::vector<post::PunctualLight> lights_;
  std::vector<std::vector<raster::Plane<float>>> maps_;
};

}  // namespace obscura::engine
