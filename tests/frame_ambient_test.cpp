// The ambient light of whole frames: by node group, by direction in the world, and with every W.
#include <catch2/catch.hpp>

#include <stdexcept>

#include "frame_checks.h"

using namespace obscura;
using namespace obscura::tests;
using engine::Aov;

namespace {

engine::FrameSettings settingsOf(const TestScene& scene) {
  engine::FrameSettings s;
  s.width = 70, s.height = 50;
  s.camera = scene.camera;
  s.ambientLight = {1, 0.8f, 0.6f};
  s.transfer.radius = 0.7f, s.transfer.bias = 0.01f, s.transfer.filterThreshold = 0.2f;
  return s;
}

// A wall across the view of a camera that looks along `view` of the world.
engine::Frame wallSeenAlong(const glm::dvec3& view, const std::optional<glm::vec3>& group) {
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  TestMesh& wall = s.addMesh();
  const glm::dvec3 up = view.y != 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0), right = glm::cross(view, up);
  const glm::vec3 r(right * 9.0), u(up * 9.0), c(view * 3.0);
  TestScene::addQuad(wall, c - r - u, c + r - u, c + r + u, c - r + u);
  s.place(wall);
  engine::Scene scene = sceneFrom(s);
  scene.instances[0].ambient = group;
  engine::FrameSettings settings = settingsOf(s);
  settings.camera = raster::perspective(0.7, 1.4, 0.1);
  settings.camera.viewFromWorld = raster::lookAt({0, 0, 0}, view, up);
  settings.ambientDirections = kSixColors;
  return frameOf(scene, settings);
}

}  // namespace

TEST_CASE("ambient frames: directions are the world's: a wall that faces +x is lit by the colour of +x") {
  for (int k = 0; k < 6; ++k) {
    glm::dvec3 view(0);
    view[k / 2] = k % 2 ? 1 : -1;  // so that the wall's normal points the other way
    const engine::Frame f = wallSeenAlong(view, std::nullopt), ofGroup = wallSeenAlong(view, glm::vec3(2, 4, 8));
    const glm::vec3 expected = kSixColors[size_t(k)];
    for (int c = 0; c < 3; ++c) {
      INFO("direction " << k << " channel " << c);
      CHECK(f.color.rgb[c].at(35, 25) == Approx(expected[c] * glm::vec3(1, 0.8f, 0.6f)[c]).margin(1e-5));
      CHECK(ofGroup.color.rgb[c].at(35, 25) == Approx(expected[c] * glm::vec3(2, 4, 8)[c]).margin(1e-5));
    }
  }
}

TEST_CASE("ambient frames: the picture alone is the one of a frame with all AOVs, by every W, also of sub-pixels") {
  for (uint32_t seed : {4u, 7u, 10u}) {
    const TestScene soup = soupScene(seed);
    const engine::Scene scene = sceneFrom(soup);
    for (int albedo = 0; albedo < 3; ++albedo)
      for (int supersample : {1, 2})
        for (bool directions : {false, true}) {
          engine::FrameSettings s = settingsOf(soup);
          s.transfer.albedo = post::TransferAlbedo(albedo);
          s.supersample = supersample;
          if (directions) s.ambientDirections = kSixColors;
          INFO("seed " << seed << " W " << albedo << " supersample " << supersample << " directions " << directions);
          s.aovs = allAovs();
          const engine::Frame all = frameOf(scene, s);
          for (Aov alone : {Aov::Color, Aov::Transfer})
            for (bool reference : {false, true}) {
              s.aovs = {alone};
              CHECK(apps::planeImage(frameOf(scene, s, {}, reference), alone).bytes == apps::planeImage(all, alone).bytes);
            }
          // Twice by one renderer: what it keeps between frames changes nothing.
          engine::Renderer renderer;
          engine::Frame frame;
          s.aovs = {Aov::Color};
          for (int k = 0; k < 2; ++k) {
            REQUIRE(renderer.render(scene, s, frame).ok());
            CHECK(apps::planeImage(frame, Aov::Color).bytes == apps::planeImage(all, Aov::Color).bytes);
          }
        }
  }
}

TEST_CASE("ambient frames: planes of ids and normals are there only if something depends on them") {
  const TestScene soup = soupScene(4);
  engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup);
  CHECK_FALSE(frameOf(scene, s).g.instance.empty());
  for (engine::Instance& i : scene.instances) i.ambient.reset();
  CHECK(frameOf(scene, s).g.instance.empty());
  s.ambient = post::Occlusion::None;
  CHECK(frameOf(scene, s).g.normal[0].empty());
  s.ambientDirections = kSixColors;
  CHECK_FALSE(frameOf(scene, s).g.normal[0].empty());
}

TEST_CASE("ambient frames: colours that are none are usage errors") {
  const TestScene soup = soupScene(4);
  engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup);
  engine::Frame frame;
  s.ambientDirections = kSixColors;
  (*s.ambientDirections)[4].y = -1;
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
  s.ambientDirections.reset();
  scene.instances[0].ambient = glm::vec3(0, std::numeric_limits<float>::quiet_NaN(), 0);
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
}
