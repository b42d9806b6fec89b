// Small scenes made in memory, rendered and traced: what the tests of the truth share.
#pragma once

#include <catch2/catch.hpp>

#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/apps/truth.h"
#include "obscura/engine/frame.h"

namespace obscura::tests {

struct TracedScene {
  engine::Scene scene;
  engine::FrameSettings settings;
  engine::Frame frame;
  apps::TruthSettings truthSettings;
  std::optional<apps::RaySurface> surface;
  apps::Truth truth;

  TracedScene(int width, int height, int rays = 256) {
    settings.width = width, settings.height = height;
    settings.aovs = apps::truthAovs();
    truthSettings.rays = rays;
    truthSettings.threads = 2;
    scene.materials.resize(1);
    paint({0.5f, 0.5f, 0.5f});
  }
  TracedScene(const TracedScene&) = delete;

  void paint(glm::vec3 albedo) {
    scene.materials[0].baseColor = glm::vec4(albedo, 1);
    scene.materials[0].doubleSided = true;
  }
  engine::Mesh& addMesh(const glm::dmat4& worldFromObject = glm::dmat4(1)) {
    scene.instances.push_back({uint32_t(scene.meshes.size()), 0, worldFromObject});
    return scene.meshes.emplace_back();
  }
  static void addQuad(engine::Mesh& m, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const uint32_t first = uint32_t(m.positions.size());
    for (const glm::vec3& p : {a, b, c, d}) m.positions.push_back(p);
    for (const uint32_t i : {0, 1, 2, 0, 2, 3}) m.indices.push_back(first + i);
  }
  void look(glm::dvec3 eye, glm::dvec3 target, double fov) {
    settings.camera = raster::perspective(fov, double(settings.width) / settings.height, 0.001);
    settings.camera.viewFromWorld = raster::lookAt(eye, target, {0, 1, 0});
  }
  void render() {
    REQUIRE(engine::Renderer().render(scene, settings, frame).ok());
    surface.emplace(scene, settings.camera);
  }
  void trace() {
    render();
    const apps::RayScene rays(*surface, 1);
    const apps::TruthStarts starts(scene, *surface, settings, frame);
    truth = apps::traceTruth(*surface, rays, starts, frame.width, frame.height, truthSettings, [](int) {});
  }
  bool seen(int x, int y) const { return frame.g.instance.at(x, y) != raster::kNoTriangle; }
  // Of the point that the pixel sees.
  glm::dvec3 world(int x, int y) const {
    const raster::Camera& c = settings.camera;
    const double z = frame.g.depth.at(x, y);
    const glm::dvec3 view(((2.0 * x + 1) / frame.width - 1) / c.xScale * z, (1 - (2.0 * y + 1) / frame.height) / c.yScale * z, -z);
    return glm::dvec3(glm::inverse(c.viewFromWorld) * glm::dvec4(view, 1));
  }
};

}  // namespace obscura::tests
