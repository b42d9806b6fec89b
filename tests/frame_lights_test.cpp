// Direct lights and their shadows in whole frames.
#include <catch2/catch.hpp>

#include <cmath>

#include <glm/geometric.hpp>

#include "frame_checks.h"
#include "obscura/engine/aov.h"
#include "obscura/raster/exact_math.h"
#include "obscura/raster/parallel.h"

using namespace obscura;
using namespace obscura::tests;
using engine::SceneLight;
using post::LightKind;

namespace {

constexpr float kPi = 3.14159265f;

SceneLight sun(const glm::dvec3& towards, const glm::vec3& color = glm::vec3(kPi)) {
  SceneLight l;
  l.direction = -glm::normalize(towards);
  l.color = color;
  return l;
}

SceneLight lamp(LightKind kind, const glm::dvec3& position, const glm::dvec3& target, const glm::vec3& color) {
  SceneLight l;
  l.kind = kind;
  l.position = position;
  l.direction = glm::normalize(target - position);
  l.color = color;
  return l;
}

void setBounds(engine::Scene& s, double size) { s.bounds = {glm::dvec3(-size), glm::dvec3(size), false}; }

// A soup with one light of each kind.
engine::Scene litSoup(uint32_t seed, engine::FrameSettings& f) {
  const TestScene from = soupScene(seed);
  engine::Scene s = sceneFrom(from);
  setBounds(s, 12);
  f.camera = from.camera;
  f.width = from.width, f.height = from.height;
  f.shadowSize = 64;
  f.brdf = post::Brdf(seed % 4);
  f.transfer.radius = 0.8f;
  f.aovs = {engine::Aov::Color};
  f.display = true;
  const glm::dmat4 world = glm::inverse(from.camera.viewFromWorld);
  const glm::dvec3 eye(world[3]), ahead = eye - 5.0 * glm::dvec3(world[2]);
  s.lights = {sun({1, 2, 3}, {2, 1, 0.5f}), lamp(LightKind::Point, eye + glm::dvec3(1, 1, 0), ahead, {5, 9, 20})};
  s.lights[1].range = 9;
  f.lights = {lamp(LightKind::Spot, eye + glm::dvec3(0, 2, 0), ahead, {60, 40, 40}), lamp(LightKind::Spot, ahead + glm::dvec3(0, 3, 0), ahead, {9, 1, 4})};
  f.lights[1].outerCone = 1.5;  // six maps
  return s;
}

float brightness(const engine::Frame& f, int x, int y) { return f.color.rgb[1].at(x, y); }

// Boxes, spheres, planes: white and Lambertian, without ambient light.
struct Stage {
  engine::Scene scene;
  engine::FrameSettings frame;

  Stage() {
    scene.materials.resize(2);
    scene.materials[0].baseColor = scene.materials[1].baseColor = {1, 1, 1, 1};
    scene.materials[1].doubleSided = true;
    setBounds(scene, 20);
    frame.width = 120, frame.height = 90;
    frame.ambientLight = glm::vec3(0);
    frame.brdf = post::Brdf::Lambert;
    frame.shadowSize = 256;
    frame.aovs = {engine::Aov::Color, engine::Aov::Instance, engine::Aov::Normal};
  }
  void look(const glm::dvec3& eye, const glm::dvec3& target) {
    frame.camera = raster::perspective(0.8, 4.0 / 3, 0.05);
    frame.camera.viewFromWorld = raster::lookAt(eye, target, {0, 1, 0});
  }
  void add(engine::Mesh mesh, uint32_t material = 0) {
    mesh.material = material;
    scene.instances.push_back({uint32_t(scene.meshes.size()), 0, glm::dmat4(1)});
    scene.meshes.push_back(std::move(mesh));
  }
  void addQuad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, uint32_t material = 0) {
    engine::Mesh m;
    m.positions = {a, b, c, d};
    m.indices = {0, 1, 2, 0, 2, 3};
    add(std::move(m), material);
  }
  void addFloor(float size = 10) { addQuad({-size, 0, size}, {size, 0, size}, {size, 0, -size}, {-size, 0, -size}); }
  // smooth: with interpolated normals.
  void addSphere(glm::vec3 center, float radius, int parts, bool smooth) {
    engine::Mesh m;
    for (int i = 0; i <= parts; ++i)
      for (int k = 0; k <= 2 * parts; ++k) {
        const double a = 3.141592653589793 * i / parts, b = 3.141592653589793 * k / parts;
        const glm::vec3 n(float(raster::exactSin(a) * raster::exactCos(b)), float(raster::exactCos(a)), float(raster::exactSin(a) * raster::exactSin(b)));
        m.positions.push_back(center + radius * n);
        if (smooth) m.normals.push_back(n);
        if (i == parts || k == 2 * parts) continue;
        const uint32_t at = uint32_t(i * (2 * parts + 1) + k), below = at + uint32_t(2 * parts + 1);
        for (uint32_t v : {at, at + 1, below, at + 1, below + 1, below}) m.indices.push_back(v);
      }
    add(std::move(m));
  }
};

// Pixels whose brightness is not that of the same frame without shadows; `visit`: which of them are looked at.
template <class Which>
int shadowed(const Stage& s, const Which& which, int& looked) {
  engine::FrameSettings open = s.frame;
  open.shadows = false;
  const engine::Frame with = frameOf(s.scene, s.frame), without = frameOf(s.scene, open);
  int darker = 0;
  looked = 0;
  for (int y = 0; y < s.frame.height; ++y)
    for (int x = 0; x < s.frame.width; ++x) {
      if (with.g.instance.at(x, y) == raster::kNoTriangle || !which(with, x, y)) continue;
      ++looked;
      darker += brightness(with, x, y) != brightness(without, x, y);
    }
  return darker;
}

glm::vec3 normalAt(const engine::Frame& f, int x, int y) { return {f.g.normal[0].at(x, y), f.g.normal[1].at(x, y), f.g.normal[2].at(x, y)}; }

}  // namespace

TEST_CASE("lights: threads, targets, tiles and skipping change no bit of a lit frame, and the scalar twins agree") {
  raster::withThreads(4, [] {
    for (uint32_t seed : {2u, 15u}) {
      engine::FrameSettings f;
      const engine::Scene s = litSoup(seed, f);
      if (seed == 15) f.transfer.albedo = post::TransferAlbedo::Radiance;
      const engine::Frame expected = frameOf(s, f, {}, true);
      CHECK(expected.lightStatistics.shadowMaps > 3);
      int run = 0;
      for (raster::Target target : raster::supportedTargets())
        for (bool skip : {true, false}) {
          const int tile = 16 << run % 3, threads = 1 + run % 4;
          ++run;
          INFO("seed " << seed << " target " << raster::targetName(target) << " tile " << tile << " threads " << threads << " skip " << skip);
          const engine::Frame found = frameOf(s, f, {threads, target, tile, skip});
          for (int c = 0; c < 3; ++c) CHECK(firstDifference("color", found.color.rgb[c], expected.color.rgb[c]) == "");
        }
    }
  });
}

TEST_CASE("lights: a crop has the pixels of the whole lit frame, with borders, sub-pixels and radiance") {
  for (int variant = 0; variant < 4; ++variant) {
    engine::FrameSettings f;
    const engine::Scene s = litSoup(7, f);
    if (variant == 1) f.border = 9;
    if (variant == 2) f.supersample = 2;
    if (variant == 3) f.transfer.albedo = post::TransferAlbedo::Radiance, f.border = 5;
    if (variant == 1) f.ambient = post::Occlusion::None;
    const engine::Frame whole = frameOf(s, f);
    for (const raster::Window w : {raster::Window{0, 0, 20, 15}, raster::Window{23, 11, 17, 22}}) {
      engine::FrameSettings part = f;
      part.crop = w;
      const engine::Frame found = frameOf(s, part);
      int different = 0;
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < w.height; ++y)
          for (int x = 0; x < w.width; ++x) different += found.color.rgb[c].at(x, y) != whole.color.rgb[c].at(w.x + x, w.y + y);
      CAPTURE(variant, w.x);
      CHECK(different == 0);
    }
  }
}

TEST_CASE("lights: without any ambient light the picture is what the lights show, black in shadow") {
  Stage s;
  s.addFloor();
  s.addQuad({-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}, 1);  // floats above the middle
  s.look({0, 7, 7}, {0, 0, 0});
  s.frame.lights = {sun({0, 1, 0})};
  const engine::Frame f = frameOf(s.scene, s.frame);
  CHECK(f.lightStatistics.shadowMaps == 1);
  int lit = 0, dark = 0, wrong = 0;
  for (int y = 0; y < s.frame.height; ++y)
    for (int x = 0; x < s.frame.width; ++x) {
      if (f.g.instance.at(x, y) != 0) continue;
      const glm::dvec4 p = glm::inverse(s.frame.camera.viewFromWorld) *
                           glm::dvec4((x + 0.5 - 60) / 60 / double(s.frame.camera.xScale) * double(f.g.depth.at(x, y)),
                                      -(y + 0.5 - 45) / 45 / double(s.frame.camera.yScale) * double(f.g.depth.at(x, y)), -double(f.g.depth.at(x, y)), 1);
      const double inside = 1 - std::max(std::fabs(p.x), std::fabs(p.z)), texel = 20.0 / 252 * 1.5;
      if (std::fabs(inside) < texel) continue;
      (inside > 0 ? dark : lit) += 1;
      wrong += std::fabs(brightness(f, x, y) - (inside > 0 ? 0.0f : 1.0f)) > 1e-5f;
    }
  CHECK(lit > 500);
  CHECK(dark > 50);
  CHECK(wrong == 0);
}

TEST_CASE("shadows: a plane is free of acne at every angle of light and view, for all kinds of lights") {
  for (const glm::dvec3& towards : {glm::dvec3(0, 1, 0), glm::dvec3(1, 1, 0.3), glm::dvec3(3, 1, 1), glm::dvec3(-8, 1, 3), glm::dvec3(0.3, 0.03, 1)})
    for (const glm::dvec3& eye : {glm::dvec3(0, 6, 6), glm::dvec3(3, 0.4, 6)})
      for (LightKind kind : {LightKind::Directional, LightKind::Point, LightKind::Spot}) {
        Stage s;
        s.addFloor();
        s.look(eye, {0, 0, 0});
        const glm::dvec3 at = 4.0 * glm::normalize(towards);
        s.frame.lights = {kind == LightKind::Directional ? sun(towards) : lamp(kind, at, {0, 0, 0}, glm::vec3(9))};
        int looked = 0;
        CAPTURE(towards.x, towards.y, eye.y, int(kind));
        CHECK(shadowed(s, [](const engine::Frame&, int, int) { return true; }, looked) == 0);
        CHECK(looked > 1000);
      }
}

TEST_CASE("shadows: a sphere is free of acne up to its terminator, facetted or with interpolated normals") {
  for (bool smooth : {false, true})
    for (int parts : {12, 60}) {
      Stage s;
      s.addSphere({0, 0, 0}, 1, parts, smooth);
      s.look({0, 0, 3.2}, {0, 0, 0});
      s.frame.lights = {sun({1, 1, 0.5})};
      const glm::vec3 towards = glm::normalize(glm::vec3(1, 1, 0.5f));
      // Facets turn by 180 degrees / parts; beyond that from the terminator none faces away.
      const float least = float(raster::exactSin(3.14159 * 1.5 / parts));
      int looked = 0;
      CAPTURE(smooth, parts);
      CHECK(shadowed(s, [&](const engine::Frame& f, int x, int y) { return glm::dot(normalAt(f, x, y), towards) > least; }, looked) == 0);
      CHECK(looked > 1000);
    }
}

TEST_CASE("shadows: they begin where things touch: within two texels of a wall its shadow is full") {
  Stage s;
  s.addFloor();
  s.addQuad({0, 0, -5}, {0, 3, -5}, {0, 3, 5}, {0, 0, 5}, 1);
  s.look({-2, 3, 0}, {-0.5, 0, 0});
  s.frame.camera = raster::perspective(0.3, 4.0 / 3, 0.05);
  s.frame.camera.viewFromWorld = raster::lookAt({-4, 3, 0}, {-0.2, 0, 0}, {0, 1, 0});
  s.frame.lights = {sun({1, 1, 0})};  // the floor at x < 0 lies in the wall's shadow
  const engine::Frame f = frameOf(s.scene, s.frame);
  int floor = 0, bright = 0;
  for (int y = 0; y < s.frame.height; ++y)
    for (int x = 0; x < s.frame.width; ++x) {
      if (f.g.instance.at(x, y) != 0) continue;
      const double depth = double(f.g.depth.at(x, y));
      const glm::dvec4 p = glm::inverse(s.frame.camera.viewFromWorld) *
                           glm::dvec4((x + 0.5 - 60) / 60 / double(s.frame.camera.xScale) * depth, -(y + 0.5 - 45) / 45 / double(s.frame.camera.yScale) * depth, -depth, 1);
      if (p.x > 0) continue;
      ++floor;
      bright += p.x < -0.05 && brightness(f, x, y) > 0;
    }
  CHECK(floor > 500);
  CHECK(bright == 0);
}

TEST_CASE("shadows: nothing is rendered for lights that reach no pixel, and of a point light's six maps only those that are needed") {
  Stage s;
  s.addFloor(2);
  s.look({0, 3, 4}, {0, 0, 0});
  const auto statistics = [&](const SceneLight& light) {
    s.frame.lights = {light};
    return frameOf(s.scene, s.frame).lightStatistics;
  };
  CHECK(statistics(sun({0, -1, 0.2})).unseen == 1);  // from below
  CHECK(statistics(sun({0, -1, 0.2})).shadowMaps == 0);
  SceneLight point = lamp(LightKind::Point, {0, 5, 0}, {0, 0, 0}, glm::vec3(5));
  CHECK(statistics(point).shadowMaps == 1);  // the floor lies below it
  point.position = {0, 0.5, 0};
  CHECK(statistics(point).shadowMaps == 5);
  point.range = 0.4;
  CHECK(statistics(point).shadowMaps == 0);
  SceneLight spot = lamp(LightKind::Spot, {0, 1, 0}, {0, 9, 0}, glm::vec3(5));
  CHECK(statistics(spot).unseen == 1);
  spot.direction = {0, -1, 0};
  CHECK(statistics(spot).shadowMaps == 1);
  s.frame.shadows = false;
  CHECK(statistics(spot).shadowMaps == 0);
}

TEST_CASE("lights: those of the scene can be left out, values that cannot be are refused") {
  Stage s;
  s.addFloor();
  s.look({0, 6, 6}, {0, 0, 0});
  s.scene.lights = {sun({0, 1, 0})};
  CHECK(brightness(frameOf(s.scene, s.frame), 60, 45) == Approx(1));
  s.frame.sceneLights = false;
  CHECK(brightness(frameOf(s.scene, s.frame), 60, 45) == 0);
  engine::Renderer renderer;
  engine::Frame frame;
  const auto refused = [&](const auto& change) {
    engine::FrameSettings f = s.frame;
    f.lights = {sun({0, 1, 0})};
    change(f);
    return !renderer.render(s.scene, f, frame).ok();
  };
  CHECK(!refused([](engine::FrameSettings&) {}));
  CHECK(refused([](engine::FrameSettings& f) { f.shadowSize = 15; }));
  CHECK(refused([](engine::FrameSettings& f) { f.shadowSize = 8193; }));
  CHECK(refused([](engine::FrameSettings& f) { f.lights[0].color.x = -1; }));
  CHECK(refused([](engine::FrameSettings& f) { f.lights[0].color.x = std::numeric_limits<float>::quiet_NaN(); }));
  CHECK(refused([](engine::FrameSettings& f) { f.lights[0].direction = glm::dvec3(0); }));
  CHECK(refused([](engine::FrameSettings& f) { f.lights[0].range = -1; }));
  CHECK(refused([](engine::FrameSettings& f) { f.lights[0].outerCone = 2; }));
}

TEST_CASE("lights: with stored radiance a floor in the sun gets redder beside a wall that the sun lights, and not beside one in shadow") {
  Stage s;
  s.scene.materials[0].baseColor = {0.8f, 0.8f, 0.8f, 1};
  s.scene.materials.push_back(s.scene.materials[0]);
  s.scene.materials[2].baseColor = {0.9f, 0.05f, 0.05f, 1};
  s.addFloor();
  s.addQuad({0, 0, 5}, {0, 3, 5}, {0, 3, -5}, {0, 0, -5}, 2);  // faces -x
  s.look({-3, 3, 0}, {-0.5, 0, 0});
  s.frame.transfer.albedo = post::TransferAlbedo::Radiance;
  s.frame.transfer.radius = 1;
  s.frame.transfer.samples = 16;
  // How red the floor near the wall is, against the floor far from it.
  const auto redness = [&](const glm::dvec3& towards) {
    s.frame.lights = {sun(towards)};
    const engine::Frame f = frameOf(s.scene, s.frame);
    double most = 0;
    for (int y = 0; y < s.frame.height; ++y)
      for (int x = 0; x < s.frame.width; ++x)
        if (f.g.instance.at(x, y) == 0) most = std::max(most, double(f.color.rgb[0].at(x, y) - f.color.rgb[1].at(x, y)));
    return most;
  };
  CHECK(redness({-1, 1, 0}) > 0.05);
  CHECK(redness({0.01, 1, 0}) < 1e-4);
}
