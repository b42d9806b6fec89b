#include "obscura/engine/bounced_light.h"

#include <algorithm>

#include "obscura/engine/shadow_maps.h"
#include "obscura/raster/float_environment.h"

namespace obscura::engine {
namespace {

constexpr size_t kMostTexels = size_t(1) << 26;

int sizeFor(raster::Span<const SceneLight> lights) {
  int size = 1024;
  while (size > 16 && lights.size() * 6 * size_t(size) * size_t(size) > kMostTexels) size /= 2;
  return size;
}

post::LightBounds boundsOf(const Bounds& scene, const post::PunctualLight& light) {
  post::LightBounds bounds;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(glm::dvec3(corner & 1 ? scene.max.x : scene.min.x, corner & 2 ? scene.max.y : scene.min.y, corner & 4 ? scene.max.z : scene.min.z));
    const glm::vec3 q = light.lightFromView * p + light.origin;
    bounds.add({q, q});
  }
  return bounds;
}

}  // namespace

SceneShadows::SceneShadows(const Scene& scene, const raster::Settings& settings)
    : bounds_(scene.bounds), casters_(castersOf(draws_.of(scene, false), materials_)), rasterizer_(settings) {}

post::PunctualLight SceneShadows::of(const SceneLight& light, int size, std::vector<raster::Plane<float>>& maps) {
  const raster::FloatEnvironment environment;
  const raster::Camera world;  // camera space is the world
  LightViews views = viewsOf(light, world, bounds_, size);
  if (light.kind == post::LightKind::Directional && views.light.maps > 0)
    fitted(light, world, bounds_, size, boundsOf(bounds_, views.light), views);
  maps.resize(views.cameras.size());
  for (size_t k = 0; k < maps.size(); ++k) {
    rasterizer_.renderDepth(casters_, views.cameras[k], size, size, maps[k]);
    views.light.map[k].depth = &maps[k];
  }
  return views.light;
}

BouncedLight::BouncedLight(const Scene& scene, raster::Span<const SceneLight> lights, bool shadows, const raster::Settings& settings) {
  const int size = sizeFor(lights);
  SceneShadows all(scene, settings);
  for (const SceneLight& light : lights) lights_.push_back(all.of(light, shadows && light.shadows ? size : 0, maps_.emplace_back()));
}

glm::dvec3 BouncedLight::at(const glm::dvec3& point, const glm::dvec3& normal) const {
  glm::dvec3 sum(0);
  for (const post::PunctualLight& light : lights_) sum += glm::dvec3(light.color) * double(post::arrivingAt(light, glm::vec3(point), glm::vec3(normal)));
  return sum;
}

}  // namespace obscura::engine
