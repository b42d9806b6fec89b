// What the loader makes of accessors, seen through the meshes it builds.
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

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

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

Mesh meshWith(GltfBuilder& b, const Json& primitive) {
  b.addNode({{"mesh", b.addMesh(primitive)}});
  return load(b).meshes.at(0);
}

template <class T>
std::vector<glm::vec3> positionsFrom(ComponentType type, bool normalized, const std::vector<T>& components) {
  GltfBuilder b;
  return meshWith(b, {{"attributes", {{"POSITION", b.addAccessor(components, type, "VEC3", normalized)}}}}).positions;
}

}  // namespace

TEST_CASE("gltf accessors: every component type gives its own values") {
  const std::vector<glm::vec3> expected = {{1, 2, 3}, {-4, 5, -6}, {127, -128, 0}};
  CHECK(positionsFrom<int8_t>(kByte, false, {1, 2, 3, -4, 5, -6, 127, -128, 0}) == expected);
  CHECK(positionsFrom<int16_t>(kShort, false, {1, 2, 3, -4, 5, -6, 127, -128, 0}) == expected);
  CHECK(positionsFrom<float>(kFloat, false, {1, 2, 3, -4, 5, -6, 127, -128, 0}) == expected);
  const std::vector<glm::vec3> positive = {{1, 2, 3}, {4, 5, 6}, {200, 255, 0}};
  CHECK(positionsFrom<uint8_t>(kUByte, false, {1, 2, 3, 4, 5, 6, 200, 255, 0}) == positive);
  CHECK(positionsFrom<uint16_t>(kUShort, false, {1, 2, 3, 4, 5, 6, 200, 255, 0}) == positive);
  CHECK(positionsFrom<uint32_t>(kUInt, false, {1, 2, 3, 4, 5, 6, 200, 255, 0}) == positive);
}

TEST_CASE("gltf accessors: normalized integers end exactly at -1, 0 and 1") {
  const float third = 85.0f / 255;
  CHECK(positionsFrom<uint8_t>(kUByte, true, {0, 85, 255, 0, 0, 0, 0, 0, 0})[0] == glm::vec3(0, third, 1));
  CHECK(positionsFrom<int8_t>(kByte, true, {-128, -127, 127, 0, 0, 0, 0, 0, 0})[0] == glm::vec3(-1, -1, 1));
  CHECK(positionsFrom<uint16_t>(kUShort, true, {0, 21845, 65535, 0, 0, 0, 0, 0, 0})[0] == glm::vec3(0, third, 1));
  CHECK(positionsFrom<int16_t>(kShort, true, {-32768, -32767, 32767, 0, 0, 0, 0, 0, 0})[0] == glm::vec3(-1, -1, 1));
}

TEST_CASE("gltf accessors: strides and offsets pick interleaved elements, aligned or not") {
  for (const int offset : {0, 3}) {
    GltfBuilder b;
    std::vector<uint8_t> bytes(size_t(offset) + 3 * 28);
    for (size_t v = 0; v < 3; ++v) {
      const float vertex[6] = {float(v), float(v * v), 1, 0, 0, float(v + 1)};
      std::memcpy(&bytes[size_t(offset) + v * 28], vertex, sizeof vertex);
    }
    const int view = b.addView(bytes, 28);
    const int position = b.addAccessorOf(view, 3, kFloat, "VEC3"), normal = b.addAccessorOf(view, 3, kFloat, "VEC3");
    b.json["accessors"][size_t(position)]["byteOffset"] = offset;
    b.json["accessors"][size_t(normal)]["byteOffset"] = offset + 12;
    const Mesh mesh = meshWith(b, {{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
    CHECK(mesh.positions == std::vector<glm::vec3>{{0, 0, 1}, {1, 1, 1}, {2, 4, 1}});
    CHECK(mesh.normals == std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}});
  }
}

TEST_CASE("gltf accessors: sparse values replace elements of a bufferView, or of zeros") {
  for (const bool hasView : {true, false})
    for (const ComponentType indexType : {kUByte, kUShort, kUInt}) {
      GltfBuilder b;
      const int position = b.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
      int indices = 0;
      if (indexType == kUByte) indices = b.addView<uint8_t>({1, 2});
      if (indexType == kUShort) indices = b.addView<uint16_t>({1, 2});
      if (indexType == kUInt) indices = b.addView<uint32_t>({1, 2});
      const int values = b.addView<float>({5, 6, 7, 8, 9, 10});
      Json& accessor = b.json["accessors"][size_t(position)];
      if (!hasView) accessor.erase("bufferView");
      accessor["sparse"] = {{"count", 2},
                            {"indices", {{"bufferView", indices}, {"componentType", int(indexType)}}},
                            {"values", {{"bufferView", values}}}};
      const Mesh mesh = meshWith(b, {{"attributes", {{"POSITION", position}}}});
      CHECK(mesh.positions == std::vector<glm::vec3>{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}});
    }
}

TEST_CASE("gltf accessors: indices may be sparse, over zeros too") {
  GltfBuilder b;
  const int indices = b.addAccessor<uint16_t>({0, 0, 0}, kUShort, "SCALAR");
  Json& accessor = b.json["accessors"][size_t(indices)];
  accessor.erase("bufferView");
  accessor["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", b.addView<uint8_t>({1, 2})}, {"componentType", 5121}}},
                        {"values", {{"bufferView", b.addView<uint16_t>({2, 1})}}}};
  const Mesh mesh = meshWith(b, {{"attributes", {{"POSITION", b.addFloats(kTriangle, "VEC3")}}}, {"indices", indices}});
  CHECK(mesh.indices == std::vector<uint32_t>{0, 2, 1});
}

TEST_CASE("gltf accessors: vertex colours are RGB or RGBA of bytes, shorts or floats") {
  const std::vector<glm::vec4> expected = {{1, 0, 0.2f, 1}, {0, 1, 0.4f, 1}, {0.2f, 0.2f, 1, 1}};
  const auto colors = [](auto components, ComponentType type, const char* shape, bool normalized) {
    GltfBuilder b;
    const int position = b.addFloats(kTriangle, "VEC3"), view = b.addView(components);
    const int color = b.addAccessorOf(view, 3, type, shape, normalized);
    return meshWith(b, {{"attributes", {{"POSITION", position}, {"COLOR_0", color}}}}).colors;
  };
  const std::vector<float> rgb = {1, 0, 0.2f, 0, 1, 0.4f, 0.2f, 0.2f, 1};
  CHECK(colors(rgb, kFloat, "VEC3", false) == expected);
  CHECK(colors(std::vector<uint8_t>{255, 0, 51, 0, 255, 102, 51, 51, 255}, kUByte, "VEC3", true) == expected);
  CHECK(colors(std::vector<uint16_t>{65535, 0, 13107, 0, 65535, 26214, 13107, 13107, 65535}, kUShort, "VEC3", true) ==
        expected);
  CHECK(colors(std::vector<uint8_t>{255, 0, 51, 255, 0, 255, 102, 255, 51, 51, 255, 255}, kUByte, "VEC4", false) ==
        expected);
}

TEST_CASE("gltf accessors: bounds are checked to the byte") {
  for (const int excess : {0, 1}) {
    GltfBuilder b;
    b.addTriangle();
    b.json["bufferViews"][0]["byteLength"] = 36 - excess;
    CHECK(pathOfError(b) == (excess ? "/accessors/0" : "loaded"));
    GltfBuilder c;
    c.addTriangle();
    c.json["bufferViews"][0]["byteOffset"] = excess;
    CHECK(pathOfError(c) == (excess ? "/bufferViews/0" : "loaded"));
    GltfBuilder d;
    d.addTriangle();
    d.json["accessors"][0]["byteOffset"] = excess;
    CHECK(pathOfError(d) == (excess ? "/accessors/0" : "loaded"));
  }
}

TEST_CASE("gltf accessors: sizes that overflow are errors, not wrapped") {
  const std::vector<uint64_t> huge = {uint64_t(1) << 31, uint64_t(1) << 32, (uint64_t(1) << 53), ~uint64_t(0)};
  for (const uint64_t size : huge)
    for (const char* member : {"count", "byteOffset"}) {
      GltfBuilder b;
      b.addTriangle();
      b.json["accessors"][0][member] = size;
      CHECK(pathOfError(b).find("/accessors/0") == 0);
    }
  for (const uint64_t size : huge)
    for (const char* member : {"byteLength", "byteOffset"}) {
      GltfBuilder b;
      b.addTriangle();
      b.json["bufferViews"][0][member] = size;
      CHECK(pathOfError(b).find("/bufferViews/0") == 0);
    }
  for (const char* index : {"indices", "material"}) {
    GltfBuilder b;
    b.add("materials", Json::object());
    b.addTriangle({{index, uint64_t(1) << 32}});  // 0, if it were cut to 32 bits
    CHECK(pathOfError(b) == std::string("/meshes/0/primitives/0/") + index);
  }
}

TEST_CASE("gltf accessors: a billion elements without data are refused before they are made") {
  GltfBuilder b;
  b.addTriangle();
  b.json["accessors"][0].erase("bufferView");
  b.json["accessors"][0]["count"] = 1000000000;
  CHECK(pathOfError(b) == "/accessors/0");
}

TEST_CASE("gltf accessors: sparse indices beyond the end are errors") {
  GltfBuilder b;
  b.addTriangle();
  const int indices = b.addView<uint8_t>({3}), values = b.addView<float>({0, 0, 0});
  b.json["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", values}}}};
  CHECK(pathOfError(b) == "/accessors/0/sparse/indices");
  b.json["accessors"][0]["sparse"]["count"] = 4;
  CHECK(pathOfError(b) == "/accessors/0/sparse/count");
}
