// The extended ambient term in an environment's light: what is open, what arrives, what surfaces send each other; closed cases.
#include <catch2/catch.hpp>

#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/engine/ambient_light.h"
#include "obscura/engine/extended_ambient.h"
#include "obscura/engine/outside_light.h"
#include "room_scene.h"

using namespace obscura;
using namespace obscura::tests;
using engine::OutsidePart;
using Directions = std::vector<post::AmbientDirection>;

namespace {

constexpr double kY0 = 0.28209479177387814, kY1 = 0.4886025119029199;

// Radiance `everywhere` + `gradient` * (d . to).
engine::Environment environment(const glm::dvec3& everywhere, const glm::dvec3& gradient = glm::dvec3(0), const glm::dvec3& to = {0, 1, 0}) {
  engine::Environment e;
  e.harmonics[0] = everywhere / kY0;
  e.harmonics[1] = gradient * to.y / kY1, e.harmonics[2] = gradient * to.z / kY1, e.harmonics[3] = gradient * to.x / kY1;
  return e;
}

engine::Scene bounded(engine::Scene scene, double size = 2) {
  scene.bounds = {glm::dvec3(-size), glm::dvec3(size), false};
  return scene;
}

std::vector<OutsidePart> partsOf(const engine::Scene& scene, const engine::Environment& e, int threads = 1, double rotation = 0) {
  return engine::outsideParts(scene, engine::spreadDirections(6), e.harmonics, engine::viewFromEnvironment({}, rotation), {threads});
}

Directions lightOf(const engine::Scene& scene, const engine::Environment& e, int classes = 6, const Directions& factors = {}) {
  const auto light = engine::extendedEnvironment(scene, {e}, {1}, nullptr, classes, factors);
  REQUIRE(light.ok());
  return *light;
}

// La(n), as pixels have it.
glm::vec3 lightAt(const glm::vec3& n, const engine::Environment& e, const Directions& directions) {
  raster::PlaneSet planes;
  planes.depth = planes.normal = planes.albedo = true;
  raster::GBuffer g(1, 1, planes);
  g.depth.at(0, 0) = 1;
  for (int c = 0; c < 3; ++c) g.normal[c].at(0, 0) = n[c], g.albedo[c].at(0, 0) = 1;
  post::AmbientLight la;
  la.environment = engine::quadricOf(e.harmonics, glm::dmat3(1), 1);
  la.directions = directions;
  post::LinearColor out = post::makeLinearColor(1, 1);
  post::lightRef({&g, nullptr, post::Occlusion::None, la, glm::vec3(0)}, 0, 1, out);
  return {out.rgb[0].at(0, 0), out.rgb[1].at(0, 0), out.rgb[2].at(0, 0)};
}

std::vector<glm::vec3> someNormals() {
  std::vector<glm::vec3> all;
  for (const glm::dvec3& n : engine::spreadDirections(50)) all.push_back(glm::vec3(n));
  return all;
}

// The room without its ceiling.
engine::Scene openRoom(const glm::vec3& albedo) {
  Builder b = room(albedo, albedo, albedo);
  b.scene.instances.erase(b.scene.instances.begin() + 3);
  return bounded(std::move(b.scene));
}

}  // namespace

TEST_CASE("extended environment: without surfaces the environment is what arrives, to the bit, with any number of classes") {
  const engine::Environment e = environment({0.7, 1.1, 0.3}, {0.2, 0.1, 0.3}, glm::normalize(glm::dvec3(1, 2, 2)));
  for (int classes : {4, 6, 9, 20}) {
    const Directions none = lightOf({}, e, classes);
    for (const glm::vec3& n : someNormals()) CHECK(lightAt(n, e, none) == lightAt(n, e, {}));
  }
}

TEST_CASE("extended environment: white furnace: white things in constant light get that, however they hide each other") {
  const engine::Environment e = environment({0.5, 1, 2});
  Builder b;
  b.addQuad({-2, -2, 2}, {2, -2, 2}, {2, -2, -2}, {-2, -2, -2}, glm::vec3(1));
  b.addQuad({-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}, glm::vec3(1));
  b.add(ball(1.2), glm::vec3(1));
  const engine::Scene scene = bounded(b.scene);
  CHECK(partsOf(scene, e)[2].open < 0.9);  // the floor's view is not free
  for (int classes : {6, 14})
    for (const engine::Scene& s : {scene, openRoom(glm::vec3(1))}) {
      const Directions light = lightOf(s, e, classes);
      for (const glm::vec3& n : someNormals())
        for (int c = 0; c < 3; ++c) CHECK(lightAt(n, e, light)[c] == Approx(0.5 * (1 << c)).epsilon(1e-5));
    }
}

TEST_CASE("extended environment: nothing of it comes through the walls of a closed room, from wherever it shines") {
  const engine::Environment e = environment(glm::dvec3(1), {0.9, 0.5, 0.1}, glm::normalize(glm::dvec3(1, 2, 2)));
  const engine::Scene black = bounded(room(glm::vec3(0), glm::vec3(0), glm::vec3(0)).scene);
  for (const OutsidePart& p : partsOf(black, e)) {
    CHECK(p.open == 0);
    CHECK(p.passed == glm::dvec3(0));
  }
  const Directions dark = lightOf(black, e);
  for (const glm::vec3& n : someNormals()) CHECK(lightAt(n, e, dark) == glm::vec3(0));
  // With a lamp it is the light of the room without an environment.
  Builder lit = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f));
  lit.scene.materials[3].emissive = glm::vec3(2);
  lit.scene = bounded(std::move(lit.scene));
  raster::Parallel parallel(1);
  const auto alone = engine::extendedAmbient(lit.scene, std::nullopt, parallel);
  const Directions both = lightOf(lit.scene, e);
  for (size_t k = 0; k < 6; ++k)
    for (int c = 0; c < 3; ++c) CHECK(both[k].added[c] == Approx((*alone)[k].color[c]));
}

TEST_CASE("extended environment: what is open is the form factor of the opening: a cube without a lid") {
  const std::vector<OutsidePart> parts = partsOf(openRoom(glm::vec3(0.5f)), environment(glm::dvec3(1)));
  CHECK(parts[2].open == Approx(0.19982).margin(0.02));               // floor to lid, opposite squares
  for (size_t k : {0, 1, 4, 5}) CHECK(parts[k].open == Approx(0.20004).margin(0.02));
  for (const OutsidePart& p : parts) CHECK(p.passed.x == Approx(p.open));
  // A ball sees nothing of itself.
  Builder b;
  b.add(ball(1), glm::vec3(1));
  for (const OutsidePart& p : partsOf(bounded(b.scene, 1), environment(glm::dvec3(1)))) CHECK(p.open > 0.99);
}

TEST_CASE("extended environment: light from above falls through the opening, that from below does not, and it turns with the map") {
  const engine::Environment e = environment(glm::dvec3(0.5), {0.5, 0, -0.5});  // red from above, blue from below
  const std::vector<OutsidePart> parts = partsOf(openRoom(glm::vec3(0)), e);
  CHECK(parts[0].passed.x > 1.2 * parts[0].passed.y);
  CHECK(parts[0].passed.y > 1.2 * parts[0].passed.z);
  const Directions light = lightOf(openRoom(glm::vec3(0)), e);
  for (size_t k = 0; k < 6; ++k) CHECK(light[k].added == glm::vec3(0));  // black walls send nothing on
  // A wall at +x holds off what comes from there, and half a turn brings that to the other side.
  Builder b;
  b.addQuad({1, -2, -2}, {1, -2, 2}, {1, 2, 2}, {1, 2, -2}, glm::vec3(0));  // faces -x
  b.addQuad({-2, -2, 2}, {1, -2, 2}, {1, -2, -2}, {-2, -2, -2}, glm::vec3(0));
  const engine::Environment side = environment(glm::dvec3(1), glm::dvec3(1), {1, 0, 0});
  const double from = partsOf(bounded(b.scene), side)[2].passed.x, turned = partsOf(bounded(b.scene), side, 1, 180)[2].passed.x;
  CHECK(from + 0.1 < turned);
}

TEST_CASE("extended environment: in a room that opens towards the light, the red wall lights what faces it, and not itself") {
  Builder b = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f));
  b.scene.instances.erase(b.scene.instances.begin() + 3);
  const engine::Environment e = environment(glm::dvec3(1));
  for (int classes : {6, 20}) {
    const Directions light = lightOf(bounded(b.scene), e, classes);
    const glm::vec3 left = lightAt({-1, 0, 0}, e, light), right = lightAt({1, 0, 0}, e, light);  // the red wall is at the left
    CHECK(left.r > 1.005f * left.g);
    CHECK(right.g > 1.005f * right.r);
    for (int c = 0; c < 3; ++c) CHECK((left[c] > 0.1f && left[c] < 1));
  }
}

TEST_CASE("extended environment: threads change no bit, and frames have one digest for threads, targets and the twins") {
  Builder b = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f));
  b.scene.instances.erase(b.scene.instances.begin() + 3);
  b.scene.materials[0].emissive = {0.1f, 0, 0};
  b.add(ball(0.8), glm::vec3(0.95f));
  engine::Scene scene = bounded(b.scene);
  const auto e = std::make_shared<const engine::Environment>(environment({0.7, 1.1, 0.3}, {0.2, 0.1, 0.3}, {0, 0.6, 0.8}));
  engine::FrameSettings s;
  s.width = 61, s.height = 41;
  s.camera = raster::perspective(1.0, 1.5, 0.01);
  s.camera.viewFromWorld = raster::lookAt({0.2, 0.3, 1.9}, {0, 0, 0}, {0, 1, 0});
  s.transfer.radius = 0.5f, s.transfer.bias = 0.01f, s.transfer.filterThreshold = 0.1f;
  s.environment = e;
  s.environmentRotation = 40;
  s.environmentIntensity = 1.5;
  const auto light = [&](int threads) { return *engine::extendedEnvironment(scene, {*e, 40, 1.5}, {threads}, nullptr, 14, engine::cubeOf(kSixColors)); };
  s.ambientDirections = light(1);
  for (int threads : {2, 3, 8}) {
    const Directions found = light(threads);
    for (size_t k = 0; k < found.size(); ++k) CHECK((found[k].color == s.ambientDirections[k].color && found[k].added == s.ambientDirections[k].added));
  }
  const engine::Frame expected = frameOf(scene, s, {}, true);
  for (raster::Target target : raster::supportedTargets())
    for (int threads : {1, 3}) {
      const engine::Frame found = frameOf(scene, s, {threads, target});
      for (int c = 0; c < 3; ++c) REQUIRE(firstDifference("color", found.color.rgb[c], expected.color.rgb[c]) == "");
    }
}

TEST_CASE("extended ambient: factors by direction are on the light from outside, and so on what it makes of walls") {
  const engine::Scene scene = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f)).scene;
  raster::Parallel parallel(1);
  const auto with = [&](const std::optional<glm::dvec3>& light, const std::array<glm::vec3, 6>& factors) {
    const auto found = engine::extendedAmbient(scene, light, parallel, nullptr, 6, engine::cubeOf(factors));
    REQUIRE(found.ok());
    return *found;
  };
  const std::array<glm::vec3, 6> ones{glm::vec3(1), glm::vec3(1), glm::vec3(1), glm::vec3(1), glm::vec3(1), glm::vec3(1)};
  const auto plain = engine::extendedAmbient(scene, glm::dvec3(0.6), parallel), scaled = engine::extendedAmbient(scene, std::nullopt, parallel);
  const Directions one = with(glm::dvec3(0.6), ones), free = with(std::nullopt, ones);
  for (size_t k = 0; k < 6; ++k) CHECK((one[k].color == (*plain)[k].color && free[k].color == (*scaled)[k].color));
  std::array<glm::vec3, 6> above = ones;  // light from above alone: on what faces up
  for (size_t k : {0, 1, 3, 4, 5}) above[k] = glm::vec3(0);
  const Directions lit = with(glm::dvec3(1), above);
  CHECK(lit[2].color.x > 1);
  CHECK(lit[3].color.x > 0.1f);  // the ceiling has what the floor sends
  CHECK(lit[3].color.x < 0.3f);
  above[2] = glm::vec3(0);  // none at all
  for (const post::AmbientDirection& k : with(std::nullopt, above)) CHECK(k.color == glm::vec3(0));
}

TEST_CASE("extended environment: light beyond what floats hold is bad input, and closed white rooms are finite") {
  Builder b = room(glm::vec3(1), glm::vec3(1), glm::vec3(1));
  b.scene.materials[2].emissive = glm::vec3(1);
  for (const post::AmbientDirection& k : lightOf(bounded(b.scene), environment(glm::dvec3(1)))) CHECK((k.added.x > 1 && k.added.x < 100));
  b.scene.materials[2].emissive = glm::vec3(3e37f);
  CHECK(engine::extendedEnvironment(bounded(b.scene), {environment(glm::dvec3(1))}, {1}).error().code == engine::ErrorCode::BadInput);
}
