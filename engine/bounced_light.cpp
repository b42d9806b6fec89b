#include "obscura/engine/bounced_light.h"

#include <algorithm>

#include "obscura/engine/draw_list.h"
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

BouncedLight::BouncedLight(const Scene& scene, raster::Span<const SceneLight> lights, bool shadows, const raster::Settings& settings) {
  const raster::FloatEnvironment environment;
  const raster::Camera world;  // camera space is the world
  const int size = sizeFor(lights);
  SceneDraws draws;
  std::vector<raster::Material> materials;
  const raster::DrawList casters = castersOf(draws.of(scene, false), materials);
  raster::Rasterizer rasterizer(settings);
  size_t count = 0;
  std::vector<LightViews> views;
  for (const SceneLight& light : lights) {
    views.push_back(viewsOf(light, world, scene.bounds, shadows && light.shadows ? size : 0));
    if (light.kind == post::LightKind::Directional && views.back().light.maps > 0)
      fitted(light, world, scene.bounds, size, boundsOf(scene.bounds, views.back().light), views.back());
    count += views.back().cameras.size();
  }
  maps_.resize(count);
  size_t next = 0;
  for (LightViews& v : views) {
    for (size_t k = 0; k < v.cameras.size(); ++k) {
      rasterizer.renderDepth(casters, v.cameras[k], size, size, maps_[next]);
      v.light.map[k].depth = &maps_[next++];
    }
    lights_.push_back(v.light);
  }
}

glm::dvec3 BouncedLight::at(const glm::dvec3& point, const glm::dvec3& normal) const {
  glm::dvec3 sum(0);
  for (const post::PunctualLight& light : lights_) sum += glm::dvec3(light.color) * double(post::arrivingAt(light, glm::vec3(point), glm::vec3(normal)));
  return sum;
}

}  // namespace obscura::engine
