// Implicit surfaces as extras of nodes.
#include <catch2/catch.hpp>

#include "obscura/engine/gltf.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura::tests;
using obscura::engine::sceneFromGltf;
using obscura::raster::ImplicitShape;
using Json = GltfBuilder::Json;

namespace {

obscura::engine::Result<obscura::engine::Scene> load(const Json& extras) {
  const TemporaryFolder folder;
  GltfBuilder b;
  b.add("materials", {{"name", "first"}});
  b.addNode({{"translation", {1, 2, 3}}, {"extras", extras}});
  return sceneFromGltf(b.writeGlb(folder), {});
}

obscura::engine::Result<obscura::engine::Scene> loadImplicit(const char* json) { return load({{"obscura_implicit", Json::parse(json)}}); }

}  // namespace

TEST_CASE("gltf implicit: each type is read, in its node's place, and no triangle is needed") {
  const auto sphere = loadImplicit(R"({"type": "sphere", "radius": 2, "material": 0})");
  REQUIRE(sphere.ok());
  REQUIRE(sphere->implicits.size() == 1);
  CHECK(sphere->implicits[0].shape == ImplicitShape::Sphere);
  CHECK(sphere->implicits[0].radius == 2);
  CHECK(sphere->implicits[0].material == 0);
  CHECK(sphere->implicits[0].worldFromObject[3] == glm::dvec4(1, 2, 3, 1));
  CHECK(sphere->bounds.min.y == Approx(0).margin(0.01));
  CHECK(sphere->bounds.max.z == Approx(5).margin(0.01));

  const auto box = loadImplicit(R"({"type": "box", "size": [2, 4, 6]})");
  REQUIRE(box.ok());
  CHECK(box->implicits[0].halfSize == glm::dvec3(1, 2, 3));
  CHECK(box->implicits[0].material == 1);  // the default one
  const auto torus = loadImplicit(R"({"type": "torus", "radius": 2, "tube": 0.5})");
  REQUIRE(torus.ok());
  CHECK(torus->implicits[0].tube == 0.5);
  const auto balls = loadImplicit(R"({"type": "metaballs", "balls": [{"center": [1, 2, 3], "radius": 0.5}, {"radius": 1}]})");
  REQUIRE(balls.ok());
  REQUIRE(balls->implicits[0].balls.size() == 2);
  CHECK(balls->implicits[0].balls[0].center == glm::dvec3(1, 2, 3));
  const auto gyroid = loadImplicit(R"({"type": "gyroid", "period": 0.5, "thickness": 0.1, "size": [1, 1, 1]})");
  REQUIRE(gyroid.ok());
  CHECK(gyroid->implicits[0].radius == 0);
}

TEST_CASE("gltf implicit: what cannot be is refused with its place in the file") {
  const char* wrong[] = {R"({"radius": 1})",
                         R"({"type": 3, "radius": 1})",
                         R"({"type": "cone", "radius": 1})",
                         R"({"type": "function", "radius": 1})",
                         R"({"type": "sphere"})",
                         R"({"type": "sphere", "radius": 0})",
                         R"({"type": "sphere", "radius": -1})",
                         R"({"type": "sphere", "radius": 1e300})",
                         R"({"type": "sphere", "radius": "1"})",
                         R"({"type": "sphere", "radius": 1, "material": 7})",
                         R"({"type": "box"})",
                         R"({"type": "box", "size": [1, 2]})",
                         R"({"type": "box", "size": [1, 2, 0]})",
                         R"({"type": "torus", "radius": 1})",
                         R"({"type": "metaballs"})",
                         R"({"type": "metaballs", "balls": []})",
                         R"({"type": "metaballs", "balls": [{"center": [0, 0, 0]}]})",
                         R"({"type": "metaballs", "balls": [3]})",
                         R"({"type": "gyroid", "period": 1, "thickness": 1})",
                         R"({"type": "gyroid", "period": 1, "thickness": 1, "radius": 1, "size": [1, 1, 1]})",
                         R"({"type": "gyroid", "period": 1, "thickness": 1, "radius": 0})",
                         R"({"type": "gyroid", "period": 0, "thickness": 1, "radius": 1})",
                         R"([])"};
  for (const char* json : wrong) {
    INFO(json);
    const auto scene = loadImplicit(json);
    REQUIRE(!scene.ok());
    CHECK(scene.error().gltfPath.find("/nodes/0/extras/obscura_implicit") == 0);
  }
}

TEST_CASE("gltf implicit: other extras, of any type, mean nothing") {
  for (const Json& extras : {Json(3), Json("text"), Json::array({1, 2}), Json{{"obscura", 1}}, Json(nullptr)}) {
    const auto scene = load(extras);
    REQUIRE(!scene.ok());  // there is nothing else in it
    CHECK(scene.error().message == "the scene has no triangles");
  }
}
