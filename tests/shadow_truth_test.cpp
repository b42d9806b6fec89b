// Shadow maps against what is not ours: rays to the sun, traced by Embree.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "obscura/apps/demo_scene.h"
#include "obscura/apps/ray_scene.h"
#include "obscura/engine/camera_choice.h"
#include "obscura/engine/frame.h"
#include "obscura/tests/scene_of_glb.h"

using namespace obscura;

namespace {

engine::Frame frameOf(const engine::Scene& scene, engine::FrameSettings settings, bool shadows) {
  settings.shadows = shadows;
  engine::Frame frame;
  REQUIRE(engine::Renderer().render(scene, settings, frame).ok());
  return frame;
}

}  // namespace

TEST_CASE("shadows: on the demo scene, of the pixels that face the sun, maps and traced rays decide alike but for less than 3 %") {
  const engine::Scene scene = tests::sceneOfGlb(apps::makeDemoScene());
  engine::FrameSettings s;
  s.width = 400, s.height = 300;
  s.camera = *engine::chooseCamera(scene, {}, s.width, s.height);
  s.ambient = post::Occlusion::None;
  s.ambientLight = glm::vec3(0);
  s.aovs = {engine::Aov::Color, engine::Aov::Depth, engine::Aov::Normal};
  engine::SceneLight sun;
  sun.direction = -glm::normalize(glm::dvec3(0.6, 1, 0.5));
  s.lights = {sun};
  const engine::Frame lit = frameOf(scene, s, true), open = frameOf(scene, s, false);

  const apps::RaySurface surface(scene, s.camera);
  const apps::RayScene rays(surface, 1);
  const glm::vec3 towards(glm::normalize(glm::dmat3(s.camera.viewFromWorld) * -sun.direction));
  const post::Projector p = post::makeProjector(s.camera, s.width, s.height);
  int facing = 0, shadowed = 0, differ = 0, mapsAlone = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const float all = open.color.rgb[1].at(x, y), part = lit.color.rgb[1].at(x, y), depth = lit.g.depth.at(x, y);
      if (!(depth < std::numeric_limits<float>::infinity() && all > 0)) continue;
      ++facing;
      const glm::vec3 at((float(x) + 0.5f - p.xCenter) * p.xInverse * depth, (float(y) + 0.5f - p.yCenter) * p.yInverse * depth, -depth);
      const glm::vec3 n(lit.g.normal[0].at(x, y), lit.g.normal[1].at(x, y), lit.g.normal[2].at(x, y)), from = at + 1e-3f * (n + towards);
      apps::RayBatch ray;
      ray.count = 1;
      for (int c = 0; c < 3; ++c) ray.origin[c][0] = from[c], ray.direction[c][0] = towards[c];
      ray.reach[0] = 1e6f;
      rays.intersect(ray);
      const bool blocked = ray.instance[0] != apps::RayBatch::kMiss, dark = part < 0.5f * all;
      shadowed += blocked;
      differ += blocked != dark;
      mapsAlone += dark && !blocked;
    }
  INFO(facing << " pixels face the sun, " << shadowed << " in shadow by rays; " << differ << " differ ("
              << 100.0 * differ / facing << " %), " << mapsAlone << " of them dark by the map alone");
  CHECK(facing > 20000);
  CHECK(shadowed > 2000);
  CHECK(differ < 0.03 * facing);
}
