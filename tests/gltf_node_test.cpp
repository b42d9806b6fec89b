#include <catch2/catch.hpp>

#include <cmath>

#include "obscura/engine/gltf.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura::tests;
using obscura::engine::LoadOptions;
using obscura::engine::Scene;
using obscura::engine::SceneCamera;
using obscura::engine::sceneFromGltf;
using Json = GltfBuilder::Json;

namespace {

Scene load(const GltfBuilder& b, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  auto scene = sceneFromGltf(b.writeGlb(folder), options);
  INFO((scene ? std::string("loaded") : scene.error().text()));
  REQUIRE(scene.ok());
  return std::move(*scene);
}

std::string pathOfError(const GltfBuilder& b, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const auto scene = sceneFromGltf(b.writeGlb(folder), options);
  return scene ? "loaded" : scene.error().gltfPath;
}

glm::dvec3 moved(const glm::dmat4& m, glm::dvec3 p) { return glm::dvec3(m * glm::dvec4(p, 1)); }

double distance(glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 d = a - b;
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

SceneCamera cameraAt(const Json& node, const Json& camera) {
  GltfBuilder b;
  b.addTriangle();
  Json n = node;
  n["camera"] = b.add("cameras", camera);
  b.addNode(n);
  return load(b).cameras.at(0);
}

const Json kPerspective = {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}};
constexpr double kHalf = 0.70710678118654752;  // sin and cos of 45 degrees

}  // namespace

TEST_CASE("gltf nodes: translation, rotation and scale apply in that order, child inside parent") {
  GltfBuilder b;
  b.addTriangle();
  b.json["scenes"][0]["nodes"] = Json::array();
  b.json["nodes"][0]["scale"] = {2, 3, 4};
  b.json["nodes"][0]["translation"] = {0, 0, 5};
  b.addNode({{"children", {0}}, {"rotation", {0, 0, kHalf, kHalf}}, {"translation", {10, 0, 0}}});  // 90 about z
  const Scene scene = load(b);
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances[0].node == 0);
  CHECK(distance(moved(scene.instances[0].worldFromObject, {1, 0, 0}), {10, 2, 5}) < 1e-12);
  CHECK(distance(moved(scene.instances[0].worldFromObject, {0, 1, 0}), {7, 0, 5}) < 1e-12);
  CHECK(distance(scene.bounds.min, {7, 0, 5}) < 1e-12);
  CHECK(distance(scene.bounds.max, {10, 2, 5}) < 1e-12);
}

TEST_CASE("gltf nodes: a matrix is read by columns, and mirrors where it says so") {
  GltfBuilder b;
  b.addTriangle();
  b.json["nodes"][0]["matrix"] = {-1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 7, 8, 9, 1};
  const Scene scene = load(b);
  CHECK(moved(scene.instances.at(0).worldFromObject, {1, 1, 1}) == glm::dvec3(6, 10, 12));
  b.json["nodes"][0]["matrix"][3] = 1;
  CHECK(pathOfError(b) == "/nodes/0/matrix");
  b.json["nodes"][0]["matrix"] = {1, 2, 3};
  CHECK(pathOfError(b) == "/nodes/0/matrix");
}

TEST_CASE("gltf nodes: rotations of any length turn without scaling") {
  GltfBuilder b;
  b.addTriangle();
  b.json["nodes"][0]["rotation"] = {0, 0, 3, 3};
  CHECK(distance(moved(load(b).instances.at(0).worldFromObject, {1, 0, 0}), {0, 1, 0}) < 1e-15);
  b.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  CHECK(moved(load(b).instances.at(0).worldFromObject, {1, 2, 3}) == glm::dvec3(1, 2, 3));
}

TEST_CASE("gltf nodes: transforms are accumulated in double") {
  GltfBuilder b;
  b.addTriangle();
  b.json["scenes"][0]["nodes"] = Json::array();
  b.json["nodes"][0]["translation"] = {1e-3, 0, 0};
  const int far = b.add("nodes", {{"children", {0}}, {"translation", {1e9, 0, 0}}});
  b.addNode({{"children", {far}}, {"translation", {-1e9, 0, 0}}});
  CHECK(std::abs(load(b).instances.at(0).worldFromObject[3].x - 1e-3) < 1e-6);
}

TEST_CASE("gltf nodes: a mesh that several nodes show is stored once, its instances come depth first") {
  GltfBuilder b;
  b.addTriangle();  // node 0
  const int mesh = b.json["nodes"][0]["mesh"];
  const int inner = b.add("nodes", {{"mesh", mesh}}), outer = b.addNode({{"mesh", mesh}, {"children", {inner}}});
  b.addNode({{"mesh", mesh}, {"name", "last"}});
  const Scene scene = load(b);
  CHECK(scene.meshes.size() == 1);
  REQUIRE(scene.instances.size() == 4);
  CHECK(scene.instances[1].node == uint32_t(outer));
  CHECK(scene.instances[2].node == uint32_t(inner));
  CHECK(scene.nodeNames.at(scene.instances[3].node) == "last");
}

TEST_CASE("gltf nodes: only the chosen scene is loaded") {
  GltfBuilder b;
  b.addTriangle();
  b.addTriangle();
  b.json["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [1]}])");
  b.json["scene"] = 1;
  b.json["accessors"][0]["count"] = 1000;  // broken, but nothing shows it
  CHECK(load(b).instances.at(0).node == 1);
  LoadOptions options;
  options.scene = 0;
  CHECK(pathOfError(b, options) == "/accessors/0");
  options.scene = 2;
  const TemporaryFolder folder;
  const auto scene = sceneFromGltf(b.writeGlb(folder), options);
  REQUIRE(!scene.ok());
  CHECK(scene.error().code == obscura::engine::ErrorCode::Usage);
  b.json["scene"] = 2;
  CHECK(pathOfError(b) == "/scene");
}

TEST_CASE("gltf nodes: without a scene everything is shown, without a default the first one") {
  GltfBuilder b;
  b.addTriangle();
  b.add("nodes", {{"children", {0}}});
  b.json.erase("scene");
  CHECK(load(b).instances.size() == 1);
  b.json.erase("scenes");
  CHECK(load(b).instances.size() == 1);
}

TEST_CASE("gltf nodes: cycles, second parents and bottomless trees are errors") {
  GltfBuilder b;
  b.addTriangle();
  b.json["nodes"][0]["children"] = {0};
  CHECK(pathOfError(b) == "/nodes/0");
  b.json["nodes"][0]["children"] = {1};
  b.add("nodes", {{"children", {0}}});
  CHECK(pathOfError(b) == "/nodes/0");

  GltfBuilder diamond;
  diamond.addTriangle();
  diamond.json["scenes"][0]["nodes"] = Json::array();
  diamond.addNode({{"children", {0}}});
  CHECK(pathOfError(diamond) == "loaded");
  diamond.addNode({{"children", {0}}});
  CHECK(pathOfError(diamond) == "/nodes/0");

  GltfBuilder chain;
  chain.addTriangle();
  for (int i = 1; i < 10; ++i) chain.json["nodes"].push_back({{"children", {i - 1}}});
  chain.json["scenes"][0]["nodes"] = {9};
  LoadOptions options;
  options.limits.nodeDepth = 10;
  CHECK(pathOfError(chain, options) == "loaded");
  options.limits.nodeDepth = 9;
  CHECK(pathOfError(chain, options) == "/nodes/0");
}

TEST_CASE("gltf nodes: indices that name nothing are errors with their path") {
  for (const char* member : {"mesh", "camera"}) {
    GltfBuilder b;
    b.addTriangle();
    b.json["nodes"][0][member] = 5;
    CHECK(pathOfError(b) == std::string("/nodes/0/") + member);
    b.json["nodes"][0][member] = -1;
    CHECK(pathOfError(b) == std::string("/nodes/0/") + member);
  }
  GltfBuilder b;
  b.addTriangle();
  b.json["nodes"][0]["children"] = {9};
  CHECK(pathOfError(b) == "/nodes/0/children/0");
  b.json["scenes"][0]["nodes"] = {0, 9};
  CHECK(pathOfError(b) == "/scenes/0/nodes/1");
}

TEST_CASE("gltf cameras: the node's scale and mirroring are taken out, its place and view are kept") {
  for (const Json& scale : {Json({2, 3, 4}), Json({-1, 1, 1}), Json({1, -5, 1})}) {
    const SceneCamera c = cameraAt({{"translation", {1, 2, 3}}, {"rotation", {0, kHalf, 0, kHalf}}, {"scale", scale}},
                                   kPerspective);
    const glm::dvec3 eye = moved(c.worldFromView, {0, 0, 0});
    CHECK(eye == glm::dvec3(1, 2, 3));
    CHECK(distance(moved(c.worldFromView, {0, 0, -1}) - eye, {-1, 0, 0}) < 1e-12);  // turned by 90 degrees about y
    const glm::dvec3 x = moved(c.worldFromView, {1, 0, 0}) - eye, y = moved(c.worldFromView, {0, 1, 0}) - eye;
    CHECK(distance(y, {0, scale[1] > 0 ? 1 : -1, 0}) < 1e-12);
    CHECK(std::abs(distance(x, {0, 0, 0}) - 1) < 1e-12);
    CHECK(distance(glm::cross(x, y), moved(c.worldFromView, {0, 0, 1}) - eye) < 1e-12);
  }
}

TEST_CASE("gltf cameras: perspective with and without an end, orthographic") {
  const SceneCamera open = cameraAt({{"name", "eye"}}, kPerspective);
  CHECK(open.name == "eye");
  CHECK(open.projection == obscura::raster::Projection::Perspective);
  CHECK(open.yFov == 0.7);
  CHECK(open.zNear == 0.1);
  CHECK(open.zFar == 0);
  CHECK(open.aspect == 0);
  const SceneCamera closed = cameraAt(Json::object(), Json::parse(
      R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 1, "zfar": 9, "aspectRatio": 1.5}})"));
  CHECK(closed.zFar == 9);
  CHECK(closed.aspect == 1.5);
  const SceneCamera flat = cameraAt(Json::object(), Json::parse(
      R"({"type": "orthographic", "orthographic": {"xmag": 4, "ymag": -3, "znear": 0, "zfar": 9}})"));
  CHECK(flat.projection == obscura::raster::Projection::Orthographic);
  CHECK(flat.xMag == 4);
  CHECK(flat.yMag == 3);
  CHECK(flat.zNear == 0);
}

TEST_CASE("gltf cameras: lenses that cannot be are errors, those without a direction are left out") {
  const auto broken = [](const char* type, const char* member, double value) {
    GltfBuilder b;
    b.addTriangle();
    Json camera = Json::parse(R"({"type": "", "perspective": {"yfov": 1, "znear": 1},
                                  "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}})");
    camera["type"] = type;
    camera[type][member] = value;
    b.addNode({{"camera", b.add("cameras", camera)}});
    return pathOfError(b);
  };
  CHECK(broken("perspective", "yfov", 0) == "/cameras/0/perspective/yfov");
  CHECK(broken("perspective", "yfov", 3.2) == "/cameras/0/perspective/yfov");
  CHECK(broken("perspective", "znear", 0) == "/cameras/0/perspective/znear");
  CHECK(broken("perspective", "zfar", 1) == "/cameras/0/perspective/zfar");
  CHECK(broken("orthographic", "xmag", 0) == "/cameras/0/orthographic/xmag");
  CHECK(broken("orthographic", "zfar", 0) == "/cameras/0/orthographic/zfar");

  GltfBuilder b;
  b.addTriangle();
  b.addNode({{"camera", b.add("cameras", kPerspective)}, {"scale", {1, 1, 0}}});
  const Scene scene = load(b);
  CHECK(scene.cameras.empty());
  CHECK(scene.warnings.size() == 1);
}

TEST_CASE("gltf instancing: every instance is the node's transform times its own") {
  GltfBuilder b;
  b.addTriangle();
  const std::vector<int16_t> turns = {0, 0, 0, 32767, 0, 0, 32767, 0};  // none, 180 degrees about z
  b.json["nodes"][0]["translation"] = {100, 0, 0};
  b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", b.addFloats({1, 0, 0, 0, 2, 0}, "VEC3")},
      {"ROTATION", b.addAccessor(turns, kShort, "VEC4", true)},
      {"SCALE", b.addFloats({1, 1, 1, 3, 3, 3}, "VEC3")},
      {"_ID", 77}};
  const Scene scene = load(b);
  CHECK(scene.meshes.size() == 1);
  REQUIRE(scene.instances.size() == 2);
  CHECK(moved(scene.instances[0].worldFromObject, {1, 0, 0}) == glm::dvec3(102, 0, 0));
  CHECK(moved(scene.instances[1].worldFromObject, {1, 0, 0}) == glm::dvec3(97, 2, 0));
  CHECK(scene.warnings.empty());
}

TEST_CASE("gltf instancing: counts and types must agree, and stay within the limit") {
  GltfBuilder b;
  b.addTriangle();
  const int two = b.addFloats({1, 0, 0, 0, 2, 0}, "VEC3"), one = b.addFloats({1, 1, 1}, "VEC3");
  Json& attributes = b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  const std::string path = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
  attributes = {{"TRANSLATION", two}, {"SCALE", one}};
  CHECK(pathOfError(b) == path + "/SCALE");
  attributes = {{"ROTATION", two}};
  CHECK(pathOfError(b) == path + "/ROTATION");
  attributes = {{"_OTHER", two}};
  CHECK(pathOfError(b) == path);
  attributes = {{"TRANSLATION", two}};
  LoadOptions options;
  options.limits.instances = 1;
  CHECK(pathOfError(b, options) == "/nodes/0");
  options.limits.instances = 2;
  options.limits.instancedTriangles = 1;
  CHECK(pathOfError(b, options) == "");
}

TEST_CASE("gltf nodes: a skinned mesh is shown at rest, by its node, with one warning") {
  GltfBuilder b;
  b.addTriangle();
  b.json["nodes"][0]["skin"] = 0;
  b.json["nodes"][0]["translation"] = {5, 0, 0};
  b.json["skins"] = Json::parse(R"([{"joints": [0]}])");
  const Scene scene = load(b);
  CHECK(scene.warnings.size() == 1);
  CHECK(moved(scene.instances.at(0).worldFromObject, {0, 0, 0}) == glm::dvec3(5, 0, 0));
}

TEST_CASE("gltf nodes: an ambient light is that of the nearest ancestor that has one") {
  GltfBuilder b;
  b.addTriangle();  // node 0
  const Json mesh = b.json["nodes"][0]["mesh"];
  b.json["scenes"][0]["nodes"] = Json::array();
  b.addNode({{"name", "hall"}, {"children", {0, 2}}, {"extras", {{"obscura_ambient", {1, 2, 3}}, {"other", "x"}}}});  // 1
  b.json["nodes"].push_back({{"name", "niche"}, {"mesh", mesh}, {"extras", {{"obscura_ambient", {0, 0.5, 0}}}}});      // 2
  b.addNode({{"name", "yard"}, {"mesh", mesh}, {"extras", "anything"}});                                               // 3
  const Scene scene = load(b);
  REQUIRE(scene.instances.size() == 3);
  CHECK(scene.instances[0].ambient == glm::vec3(1, 2, 3));
  CHECK(scene.instances[1].ambient == glm::vec3(0, 0.5f, 0));
  CHECK_FALSE(scene.instances[2].ambient.has_value());

  LoadOptions options;
  options.ambient = {{"hall", glm::vec3(7)}, {"yard", glm::vec3(8)}};
  const Scene given = load(b, options);
  CHECK(given.instances[0].ambient == glm::vec3(7));
  CHECK(given.instances[1].ambient == glm::vec3(0, 0.5f, 0));
  CHECK(given.instances[2].ambient == glm::vec3(8));

  options.ambient = {{"attic", glm::vec3(1)}};
  const TemporaryFolder folder;
  const auto missing = sceneFromGltf(b.writeGlb(folder), options);
  REQUIRE_FALSE(missing.ok());
  CHECK(missing.error().code == obscura::engine::ErrorCode::Usage);
  CHECK(missing.error().text().find("attic") != std::string::npos);
}

TEST_CASE("gltf nodes: an ambient light that is no colour is an error at its place") {
  for (const Json& wrong : {Json({1, 2}), Json({1, 2, 3, 4}), Json("white"), Json({1, "2", 3}), Json({1, -1, 3}), Json({1, 1e31, 3}),
                            Json({1, nullptr, 3}), Json(0.5)}) {
    GltfBuilder b;
    b.addTriangle();
    b.json["nodes"][0]["extras"] = {{"obscura_ambient", wrong}};
    INFO(wrong.dump());
    CHECK(pathOfError(b).find("/nodes/0/extras/obscura_ambient") == 0);
  }
}
