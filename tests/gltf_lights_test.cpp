// KHR_lights_punctual.
#include <catch2/catch.hpp>

#include <cmath>

#include "obscura/engine/gltf.h"
#include "obscura/engine/shadow_maps.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura;
using namespace obscura::tests;
using engine::SceneLight;
using engine::sceneFromGltf;
using post::LightKind;
using Json = GltfBuilder::Json;

namespace {

constexpr double kHalf = 0.70710678118654752;  // sin and cos of 45 degrees

GltfBuilder withLight(const Json& light, const Json& node = Json::object()) {
  GltfBuilder b;
  b.addTriangle();
  b.json["extensionsUsed"] = {"KHR_lights_punctual"};
  b.json["extensionsRequired"] = {"KHR_lights_punctual"};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
  Json n = node;
  n["extensions"]["KHR_lights_punctual"]["light"] = 0;
  b.addNode(n);
  return b;
}

engine::Result<engine::Scene> loaded(const GltfBuilder& b, const engine::LoadOptions& options = {}) {
  const TemporaryFolder folder;
  return sceneFromGltf(b.writeGlb(folder), options);
}

SceneLight lightOf(const GltfBuilder& b) {
  const auto scene = loaded(b);
  INFO((scene ? std::string("loaded") : scene.error().text()));
  REQUIRE(scene.ok());
  CHECK(scene->warnings.empty());
  REQUIRE(scene->lights.size() == 1);
  CHECK(engine::wrongLight(scene->lights[0]) == nullptr);
  return scene->lights[0];
}

std::string pathOfError(const GltfBuilder& b) {
  const auto scene = loaded(b);
  return scene ? "loaded" : scene.error().gltfPath;
}

}  // namespace

TEST_CASE("gltf lights: what is left out is white, one unit bright, without end, and opens by 45 degrees") {
  const SceneLight point = lightOf(withLight({{"type", "point"}}));
  CHECK(point.kind == LightKind::Point);
  CHECK(point.color == glm::vec3(1));
  CHECK(point.range == 0);
  CHECK(lightOf(withLight({{"type", "directional"}})).kind == LightKind::Directional);
  const SceneLight spot = lightOf(withLight({{"type", "spot"}, {"spot", Json::object()}}));
  CHECK(spot.kind == LightKind::Spot);
  CHECK(spot.innerCone == 0);
  CHECK(spot.outerCone == Approx(0.785398163));
}

TEST_CASE("gltf lights: the colour is multiplied by the intensity, range and cones are read") {
  const SceneLight l = lightOf(withLight({{"type", "spot"}, {"name", "lamp"}, {"color", {1, 0.5, 0}}, {"intensity", 20}, {"range", 7},
                                          {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}));
  CHECK(l.name == "lamp");
  CHECK(l.color == glm::vec3(20, 10, 0));
  CHECK(l.range == 7);
  CHECK(l.innerCone == 0.25);
  CHECK(l.outerCone == 0.5);
}

TEST_CASE("gltf lights: a light shines along its node's -z, whatever scales the nodes above it have") {
  GltfBuilder b = withLight({{"type", "spot"}, {"spot", Json::object()}}, {{"translation", {0, 0, 3}}, {"rotation", {kHalf, 0, 0, kHalf}}});
  b.json["scenes"][0]["nodes"] = {0};
  b.addNode({{"children", {1}}, {"translation", {10, 0, 0}}, {"scale", {2, 5, 3}}});
  const SceneLight l = lightOf(b);
  const glm::dvec3 place = l.position - glm::dvec3(10, 0, 9), to = l.direction - glm::dvec3(0, 1, 0);  // 90 about x turns -z to y
  for (int c = 0; c < 3; ++c) {
    CHECK(std::fabs(place[c]) < 1e-12);
    CHECK(std::fabs(to[c]) < 1e-12);
  }
}

TEST_CASE("gltf lights: values that cannot be are errors at their place") {
  const std::string at = "/extensions/KHR_lights_punctual/lights/0";
  const auto pathWith = [&](const Json& change) {
    Json light = {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}};
    light.merge_patch(change);
    return pathOfError(withLight(light));
  };
  CHECK(pathWith({{"intensity", -1}}) == at + "/intensity");
  CHECK(pathWith({{"intensity", 1e16}}) == at + "/intensity");
  CHECK(pathWith({{"color", {1, -0.1, 1}}}) == at + "/color");
  CHECK(pathWith({{"color", {1, 1e20, 1}}}) == at + "/color");
  CHECK(pathWith({{"color", {1, 1}}}) == at + "/color");
  CHECK(pathWith({{"color", "red"}}) == at + "/color");
  CHECK(pathWith({{"range", -2}}) == at + "/range");
  CHECK(pathWith({{"range", 1e300}}) == at + "/range");
  CHECK(pathWith({{"spot", {{"innerConeAngle", 0.6}}}}) == at + "/spot/innerConeAngle");
  CHECK(pathWith({{"spot", {{"innerConeAngle", -0.1}}}}) == at + "/spot/innerConeAngle");
  CHECK(pathWith({{"spot", {{"outerConeAngle", 1.6}}}}) == at + "/spot/outerConeAngle");
  CHECK(pathWith({{"spot", {{"innerConeAngle", 0}, {"outerConeAngle", 0}}}}) == at + "/spot/outerConeAngle");
  CHECK(pathWith({{"spot", nullptr}}) == at);
  CHECK(pathWith({{"type", "area"}}) == at + "/type");
  CHECK(pathWith({{"type", nullptr}}) == at);
  GltfBuilder b = withLight({{"type", "point"}});
  b.json["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 1;
  CHECK(pathOfError(b) == "/nodes/1/extensions/KHR_lights_punctual/light");
  b.json["nodes"][1]["extensions"]["KHR_lights_punctual"] = Json::object();
  CHECK(pathOfError(b) == "/nodes/1/extensions/KHR_lights_punctual");
  b = withLight({{"type", "point"}});
  b.json.erase("extensions");
  CHECK(pathOfError(b) == "/nodes/1/extensions/KHR_lights_punctual/light");
}

TEST_CASE("gltf lights: those without a direction are left out, and there are at most as many as the limit") {
  GltfBuilder b = withLight({{"type", "directional"}}, {{"scale", {1, 1, 0}}});
  const auto flat = loaded(b);
  REQUIRE(flat.ok());
  CHECK(flat->lights.empty());
  CHECK(flat->warnings == std::vector<std::string>{"lights whose transform is singular or not finite are ignored"});
  b = withLight({{"type", "point"}}, {{"scale", {0, 0, 0}}});
  engine::LoadOptions options;
  options.limits.lights = 1;
  CHECK(loaded(b, options).ok());
  Json second = {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  b.addNode(second);
  const auto many = loaded(b, options);
  REQUIRE(!many.ok());
  CHECK(many.error().gltfPath == "/nodes/2");
}
