#include <catch2/catch.hpp>

#include <limits>

#include "obscura/engine/gltf.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura::tests;
using obscura::engine::Mesh;
using obscura::engine::Scene;
using obscura::engine::sceneFromGltf;
using Json = GltfBuilder::Json;

namespace {

enum Mode { kPoints = 0, kLines = 1, kTriangles = 4, kStrip = 5, kFan = 6 };

Scene load(const GltfBuilder& b) {
  const TemporaryFolder folder;
  auto scene = sceneFromGltf(b.writeGlb(folder));
  INFO((scene ? std::string("loaded") : scene.error().text()));
  REQUIRE(scene.ok());
  return std::move(*scene);
}

std::string pathOfError(const GltfBuilder& b) {
  const TemporaryFolder folder;
  const auto scene = sceneFromGltf(b.writeGlb(folder));
  return scene ? "loaded" : scene.error().gltfPath;
}

// n vertices at (i, i * i, 0).
std::vector<float> parabola(int n) {
  std::vector<float> p;
  for (int i = 0; i < n; ++i) p.insert(p.end(), {float(i), float(i * i), 0});
  return p;
}

std::vector<uint32_t> indicesOf(Mode mode, int vertices) {
  GltfBuilder b;
  const int position = b.addFloats(parabola(vertices), "VEC3");
  b.addNode({{"mesh", b.addMesh({{"attributes", {{"POSITION", position}}}, {"mode", mode}})}});
  return load(b).meshes.at(0).indices;
}

}  // namespace

TEST_CASE("gltf geometry: lists, strips and fans become the triangles glTF says, all turned the same way") {
  CHECK(indicesOf(kTriangles, 6) == std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
  CHECK(indicesOf(kStrip, 5) == std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4});
  CHECK(indicesOf(kFan, 5) == std::vector<uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0});
}

TEST_CASE("gltf geometry: indices of 8, 16 and 32 bits say the same") {
  const auto indices = [](auto values, ComponentType type) {
    GltfBuilder b;
    const int position = b.addFloats(parabola(4), "VEC3"), index = b.addAccessor(values, type, "SCALAR");
    b.addNode({{"mesh", b.addMesh({{"attributes", {{"POSITION", position}}}, {"indices", index}})}});
    return load(b).meshes.at(0).indices;
  };
  const std::vector<uint32_t> expected = {0, 1, 2, 2, 1, 3};
  CHECK(indices(std::vector<uint8_t>{0, 1, 2, 2, 1, 3}, kUByte) == expected);
  CHECK(indices(std::vector<uint16_t>{0, 1, 2, 2, 1, 3}, kUShort) == expected);
  CHECK(indices(std::vector<uint32_t>{0, 1, 2, 2, 1, 3}, kUInt) == expected);
}

TEST_CASE("gltf geometry: an index out of range is an error with the primitive's path") {
  GltfBuilder b;
  b.addTriangle({{"indices", b.addAccessor<uint16_t>({0, 1, 3}, kUShort, "SCALAR")}});
  const TemporaryFolder folder;
  const auto scene = sceneFromGltf(b.writeGlb(folder));
  REQUIRE(!scene.ok());
  CHECK(scene.error().gltfPath == "/meshes/0/primitives/0/indices");
  CHECK(scene.error().message == "index 2 is 3, there are 3 vertices");
}

TEST_CASE("gltf geometry: primitives share a vertex buffer, and each keeps only the vertices it uses") {
  GltfBuilder b;
  const int n = 1000, position = b.addFloats(parabola(n), "VEC3");
  std::vector<float> normals;
  for (int i = 0; i < n; ++i) normals.insert(normals.end(), {float(i), 0, 1});
  const Json attributes = {{"POSITION", position}, {"NORMAL", b.addFloats(normals, "VEC3")}};
  // A run in the middle, scattered ones over all, and a few over a range not much longer than they are many.
  const std::vector<std::vector<uint32_t>> lists = {{500, 501, 502}, {999, 0, 500, 0, 999, 7}, {10, 16, 12}};
  Json primitives = Json::array();
  for (const auto& list : lists)
    primitives.push_back({{"attributes", attributes}, {"indices", b.addAccessor(list, kUInt, "SCALAR")}});
  b.addNode({{"mesh", b.add("meshes", {{"primitives", primitives}})}});
  const Scene scene = load(b);
  REQUIRE(scene.meshes.size() == 3);
  for (size_t m = 0; m < 3; ++m) {
    const Mesh& mesh = scene.meshes[m];
    CHECK(mesh.positions.size() == (m == 1 ? 4u : 3u));
    REQUIRE(mesh.indices.size() == lists[m].size());
    for (size_t i = 0; i < lists[m].size(); ++i) {
      const float x = float(lists[m][i]);
      CHECK(mesh.positions.at(mesh.indices[i]) == glm::vec3(x, x * x, 0));
      CHECK(mesh.normals.at(mesh.indices[i]) == glm::vec3(x, 0, 1));
    }
  }
}

TEST_CASE("gltf geometry: points and lines are left out with one warning, what is incomplete with another") {
  GltfBuilder b;
  const Json attributes = {{"POSITION", b.addFloats(parabola(4), "VEC3")}};
  Json primitives = Json::array();
  for (const int mode : {0, 1, 2, 3, 4}) primitives.push_back({{"attributes", attributes}, {"mode", mode}});
  primitives.push_back({{"attributes", {{"NORMAL", attributes["POSITION"]}}}});
  b.addNode({{"mesh", b.add("meshes", {{"primitives", primitives}})}});
  const Scene scene = load(b);
  REQUIRE(scene.meshes.size() == 1);
  CHECK(scene.meshes[0].name == "/primitive 4");
  CHECK(scene.meshes[0].indices == std::vector<uint32_t>{0, 1, 2});
  CHECK(scene.warnings == std::vector<std::string>{"points and lines are not drawn",
                                                   "triangles that are not complete are not drawn",
                                                   "primitives without POSITION are not drawn"});
}

TEST_CASE("gltf geometry: morph targets are left out with one warning") {
  GltfBuilder b;
  const int delta = b.addFloats({9, 9, 9, 9, 9, 9, 9, 9, 9}, "VEC3");
  const Json targets = Json::array({{{"POSITION", delta}}, {{"POSITION", delta}}});
  b.addTriangle({{"targets", targets}});
  b.addTriangle({{"targets", targets}});
  const Scene scene = load(b);
  CHECK(scene.warnings.size() == 1);
  CHECK(scene.meshes.at(0).positions.at(1) == glm::vec3(1, 0, 0));
}

TEST_CASE("gltf geometry: positions that are not finite are kept, and do not reach the bounds") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  GltfBuilder b;
  const int position = b.addFloats({0, 0, 0, 1, 0, 0, 0, 2, 0, nan, 0, 0, inf, 5, 5, 1, 1, -inf}, "VEC3");
  b.addNode({{"mesh", b.addMesh({{"attributes", {{"POSITION", position}}}})}});
  const Scene scene = load(b);
  CHECK(scene.meshes.at(0).positions.size() == 6);
  CHECK_FALSE(scene.bounds.empty);
  CHECK(scene.bounds.min == glm::dvec3(0));
  CHECK(scene.bounds.max == glm::dvec3(1, 2, 0));

  const int nowhere = b.addFloats(std::vector<float>(9, nan), "VEC3");
  b.addNode({{"mesh", b.addMesh({{"attributes", {{"POSITION", nowhere}}}})}});
  CHECK(load(b).bounds.max == glm::dvec3(1, 2, 0));
  b.json["scenes"][0]["nodes"] = {1};
  CHECK(load(b).bounds.empty);
}

TEST_CASE("gltf geometry: vertices that no triangle uses are not in the bounds") {
  GltfBuilder b;
  const int position = b.addFloats({0, 0, 0, 99, 99, 99, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int indices = b.addAccessor<uint8_t>({0, 2, 3, 0, 3, 2}, kUByte, "SCALAR");
  b.addNode({{"mesh", b.addMesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}})}});
  CHECK(load(b).bounds.max == glm::dvec3(1, 1, 0));
}

TEST_CASE("gltf geometry: an attribute of another length or shape is an error") {
  GltfBuilder b;
  b.addTriangle({{"attributes", {{"NORMAL", b.addFloats({0, 0, 1, 0, 0, 1}, "VEC3")}}}});
  CHECK(pathOfError(b) == "/meshes/0/primitives/0/attributes/NORMAL");
  GltfBuilder c;
  c.addTriangle({{"attributes", {{"NORMAL", c.addFloats({0, 0, 1, 0, 0, 1}, "VEC2")}}}});
  CHECK(pathOfError(c) == "/meshes/0/primitives/0/attributes/NORMAL");
  GltfBuilder d;
  d.addTriangle({{"attributes", {{"COLOR_0", d.addFloats(std::vector<float>(12), "MAT2")}}}});
  CHECK(pathOfError(d) == "/meshes/0/primitives/0/attributes/COLOR_0");
  GltfBuilder e;
  e.addTriangle({{"indices", e.addFloats({0, 1, 2}, "SCALAR")}});
  CHECK(pathOfError(e) == "/meshes/0/primitives/0/indices");
  GltfBuilder f;
  f.addTriangle({{"mode", 7}});
  CHECK(pathOfError(f) == "/meshes/0/primitives/0/mode");
}

TEST_CASE("gltf geometry: every mesh is clustered") {
  GltfBuilder b;
  b.addTriangle();
  const Scene scene = load(b);
  CHECK(scene.meshes.at(0).clusters.triangleCount == 1);
  CHECK(scene.meshes.at(0).view().clusters == &scene.meshes.at(0).clusters);
  CHECK(scene.meshes.at(0).view().triangleCount() == 1);
}
