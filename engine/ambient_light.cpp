#include "obscura/engine/ambient_light.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/engine/irradiance.h"
#include "obscura/raster/exact_math.h"

namespace obscura::engine {
namespace {

// A direction of the world, as the G-buffer's normals are turned.
glm::dvec3 inView(const glm::dmat4& viewFromWorld, const glm::dvec3& direction) {
  const glm::dvec3 turned = glm::dmat3(viewFromWorld) * direction;
  const double length = glm::length(turned);  // 1 unless the view scales
  return length > 0 ? turned / length : glm::dvec3(0);
}

}  // namespace

glm::dmat3 viewFromEnvironment(const raster::Camera& camera, double degrees) {
  const double angle = degrees * 0.017453292519943295, c = raster::exactCos(angle), s = raster::exactSin(angle);
  const glm::dvec3 axes[3] = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
  glm::dmat3 m;
  for (int k = 0; k < 3; ++k) m[k] = inView(camera.viewFromWorld, axes[k]);
  return m;
}

post::EnvironmentView environmentViewOf(const FrameSettings& s) {
  const glm::dmat3 mapFromView = glm::transpose(viewFromEnvironment(s.camera, s.environmentRotation));
  return {s.environment->cubes.view(), glm::mat3(mapFromView), float(s.environmentIntensity)};
}

bool hasAmbientGroups(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [](const Instance& i) { return i.ambient.has_value(); });
}

post::AmbientLight ambientLightOf(const Scene& scene, const FrameSettings& settings, std::vector<glm::vec3>& table) {
  post::AmbientLight light(settings.ambientLight);
  table.clear();
  if (hasAmbientGroups(scene)) {
    for (const Instance& i : scene.instances) {
      const glm::vec3 color = i.ambient.value_or(settings.environment ? post::kNoOwnLight : settings.ambientLight);
      for (int c = 0; c < 3 && i.ambient; ++c)
        if (!(color[c] >= 0 && color[c] < 1e30f))
          throw std::invalid_argument("the ambient light of instance " + std::to_string(table.size()) + " is " +
                                      std::to_string(color[c]) + ": it must be 0 or more and finite");
      table.push_back(color);
    }
    light.instances = table;
  }
  if (settings.environment)
    light.environment = quadricOf(settings.environment->harmonics, viewFromEnvironment(settings.camera, settings.environmentRotation),
                                  settings.environmentIntensity);
  light.directions = settings.ambientDirections;
  for (post::AmbientDirection& k : light.directions) k.direction = glm::vec3(inView(settings.camera.viewFromWorld, glm::dvec3(k.direction)));
  return light;
}

}  // namespace obscura::engine
