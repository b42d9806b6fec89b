// Small scenes made in memory, rendered and traced: what the tests of the truth share.
#pragma once

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/apps/environment_truth.h"
#include "obscura/apps/truth.h"
#include "obscura/engine/ambient_light.h"
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
  // The environment's planes behind those that are there.
  void traceEnvironment(const engine::EnvironmentMap& map, double rotation = 0, double intensity = 1) {
    raster::Parallel parallel(2);
    const apps::RayScene rays(*surface, 1);
    const apps::TruthStarts starts(scene, *surface, settings, frame);
    const apps::EnvironmentSampler sampler(map, engine::viewFromEnvironment(settings.camera, rotation), intensity, parallel);
    apps::append(truth, apps::traceEnvironment(*surface, rays, starts, sampler, frame.width, frame.height, truthSettings, [](int) {}));
  }
  bool seen(int x, int y) const { return frame.g.instance.at(x, y) != raster::kNoTriangle; }
  glm::dvec3 normal(int x, int y) const {  // world space
    glm::dvec3 n;
    for (int c = 0; c < 3; ++c) n[c] = frame.g.normal[c].at(x, y);
    return glm::transpose(glm::dmat3(settings.camera.viewFromWorld)) * n;
  }
  // Of the point that the pixel sees.
  glm::dvec3 world(int x, int y) const {
    const raster::Camera& c = settings.camera;
    const double z = frame.g.depth.at(x, y);
    const glm::dvec3 view(((2.0 * x + 1) / frame.width - 1) / c.xScale * z, (1 - (2.0 * y + 1) / frame.height) / c.yScale * z, -z);
    return glm::dvec3(glm::inverse(c.viewFromWorld) * glm::dvec4(view, 1));
  }
};

// The traced plane has no bias against `expected`, and errs as much as it says.
inline void checkAgainst(const TracedScene& t, apps::TruthQuantity q, double biasLimit, const std::function<double(int, int)>& expected) {
  double n = 0, bias = 0, squares = 0, stated = 0;
  for (int y = 0; y < t.frame.height; ++y)
    for (int x = 0; x < t.frame.width; ++x) {
      const double e = expected(x, y);
      if (!t.seen(x, y) || e < 0) continue;
      const double d = t.truth[q].at(x, y) - e, s = t.truth.error[size_t(q)].at(x, y);
      ++n, bias += d, squares += d * d, stated += s * s;
    }
  REQUIRE(n > 100);
  INFO("quantity " << int(q) << " bias " << bias / n << " rms " << std::sqrt(squares / n) << " stated " << std::sqrt(stated / n));
  CHECK(std::fabs(bias / n) < biasLimit);
  CHECK(std::sqrt(squares / n) < 1.2 * std::sqrt(stated / n) + biasLimit);
  CHECK(std::sqrt(squares / n) > 0.8 * std::sqrt(stated / n) - 1e-6);
}

inline void addBox(engine::Mesh& m, glm::vec3 lo, glm::vec3 hi) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      glm::vec3 p[4];
      for (int k = 0; k < 4; ++k) {
        p[k][axis] = upper ? hi[axis] : lo[axis];
        p[k][(axis + 1) % 3] = (k == 1 || k == 2) == upper ? hi[(axis + 1) % 3] : lo[(axis + 1) % 3];
        p[k][(axis + 2) % 3] = k >= 2 ? hi[(axis + 2) % 3] : lo[(axis + 2) % 3];
      }
      TracedScene::addQuad(m, p[0], p[1], p[2], p[3]);
    }
}

inline void addBall(engine::Mesh& m, glm::dvec3 center, double radius, int n) {
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= 2 * n; ++i) {
      const double theta = 3.14159265358979323846 * j / n, phi = 3.14159265358979323846 * (i % (2 * n)) / n;
      m.normals.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      m.positions.emplace_back(center + glm::dvec3(m.normals.back()) * radius);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const uint32_t a = uint32_t(j * (2 * n + 1) + i), c = a + uint32_t(2 * n + 1);
      for (const uint32_t k : {a, a + 1, c + 1, a, c + 1, c}) m.indices.push_back(k);
    }
}

}  // namespace obscura::tests
