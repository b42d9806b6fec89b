// Containers, files and URIs; hostile and broken ones.
#include <catch2/catch.hpp>

#include <filesystem>

#include "obscura/engine/gltf.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura::tests;
using obscura::engine::Error;
using obscura::engine::ErrorCode;
using obscura::engine::LoadOptions;
using obscura::engine::Scene;
using obscura::engine::sceneFromGltf;
using Json = GltfBuilder::Json;

namespace {

GltfBuilder triangle() {
  GltfBuilder b;
  b.addTriangle();
  return b;
}

std::string writeText(const TemporaryFolder& folder, const std::string& text, const std::string& name = "scene.gltf") {
  writeBytes(folder / name, {text.begin(), text.end()});
  return folder / name;
}

Error errorOf(const std::string& path, const LoadOptions& options = {}) {
  const auto scene = sceneFromGltf(path, options);
  REQUIRE(!scene.ok());
  CHECK(scene.error().code == ErrorCode::BadInput);
  CHECK(scene.error().message.find('\n') == std::string::npos);
  CHECK(!scene.error().file.empty());
  return scene.error();
}

std::string pathOfError(const GltfBuilder& b, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const auto scene = sceneFromGltf(b.writeGlb(folder), options);
  return scene ? "loaded" : scene.error().gltfPath;
}

}  // namespace

TEST_CASE("gltf files: a .glb, a data URI and an external buffer give the same scene") {
  const TemporaryFolder folder;
  const GltfBuilder b = triangle();
  writeBytes(folder / "a b.bin", b.binary);
  for (const std::string& path : {b.writeGlb(folder), b.writeGltf(folder), writeText(folder, b.gltf("a%20b.bin"), "c"),
                                  b.writeGlb(folder, "named.gltf"), b.writeGltf(folder, "named.glb")}) {
    const auto scene = sceneFromGltf(path);
    REQUIRE(scene.ok());
    CHECK((*scene).meshes.at(0).positions == std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK((*scene).warnings.empty());
  }
}

TEST_CASE("gltf files: base64 of every length comes back") {
  for (size_t n = 36; n < 40; ++n) {
    GltfBuilder b = triangle();
    b.binary.resize(n, 0x5A);
    const TemporaryFolder folder;
    CHECK(sceneFromGltf(b.writeGltf(folder)).ok());
    b.json["bufferViews"][0]["byteLength"] = n + 1;
    CHECK(errorOf(b.writeGltf(folder)).gltfPath == "/bufferViews/0");
  }
  GltfBuilder all;
  all.addTriangle();
  std::vector<float> values;
  for (int i = 0; i < 256 * 3; ++i) values.push_back(float(i * 7919 % 65521) / 3);  // every digit occurs
  all.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = all.addFloats(values, "VEC3");
  const TemporaryFolder folder;
  const auto text = sceneFromGltf(all.writeGltf(folder)), binary = sceneFromGltf(all.writeGlb(folder));
  REQUIRE(text.ok());
  REQUIRE(binary.ok());
  CHECK((*text).meshes[0].positions == (*binary).meshes[0].positions);
}

TEST_CASE("gltf files: bad base64, unknown schemes and paths out of the folder are refused") {
  const TemporaryFolder folder;
  const GltfBuilder b = triangle();
  std::filesystem::create_directory(folder / "inner");
  writeBytes(folder / "outside.bin", b.binary);
  writeBytes(folder / "inner/inside.bin", b.binary);
  const auto load = [&](const std::string& uri) {
    return sceneFromGltf(writeText(folder, b.gltf(uri), "inner/s.gltf"));
  };
  CHECK(load("inside.bin").ok());
  CHECK(load("data:;base64," + std::string(48, 'A')).ok());
  CHECK(load("./x/../inside.bin").ok() == false);  // lexically inside, but there is no x
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"), std::string("x/../../outside.bin"),
        (folder / "outside.bin"), "file://" + (folder / "outside.bin"), std::string("http://example.com/x.bin"),
        std::string(""), std::string("a%00b"), std::string("a%2"), std::string("."), std::string("nowhere.bin"),
        std::string("data:,abc"), std::string("data:;base64"), std::string("data:;base64,") + std::string(49, 'A'),
        std::string("data:;base64,") + std::string(47, 'A') + "*", "data:;base64,*" + std::string(47, 'A'),
        std::string("data:;base64,AAA=") + std::string(44, 'A')}) {
    INFO(uri);
    const auto scene = load(uri);
    REQUIRE(!scene.ok());
    CHECK(scene.error().gltfPath == "/buffers/0");
  }
}

TEST_CASE("gltf files: what is missing, empty, a folder or not glTF is one clear error") {
  const TemporaryFolder folder;
  CHECK(errorOf(folder / "absent.glb").text() == (folder / "absent.glb") + ": no such file");
  CHECK(errorOf(folder / "").message == "not a regular file");
  for (const char* text : {"", "{", "[]", "null", "{}", "glTF", "{\"asset\": 1}", "{\"asset\": {}}", "\xff\xfe",
                           "{\"asset\": {\"version\": \"1.0\"}}", "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": 1}",
                           "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [1]}", "{\"a\": 1e999}"}) {
    INFO(text);
    errorOf(writeText(folder, text));
  }
}

TEST_CASE("gltf files: a scene without triangles is an error") {
  const TemporaryFolder folder;
  CHECK(errorOf(GltfBuilder().writeGlb(folder)).message == "the scene has no triangles");
  GltfBuilder b = triangle();
  b.json["meshes"][0]["primitives"][0]["mode"] = 1;
  CHECK(errorOf(b.writeGlb(folder)).message == "the scene has no triangles");
  GltfBuilder unseen = triangle();
  unseen.json["scenes"][0]["nodes"] = Json::array();
  CHECK(errorOf(unseen.writeGlb(folder)).message == "the scene has no triangles");
}

TEST_CASE("gltf files: a .glb cut anywhere is an error") {
  const TemporaryFolder folder;
  const std::vector<uint8_t> whole = triangle().glb();
  for (size_t n = 0; n < whole.size(); ++n) {
    writeBytes(folder / "cut.glb", {whole.begin(), whole.begin() + std::ptrdiff_t(n)});
    REQUIRE(!sceneFromGltf(folder / "cut.glb").ok());
  }
}

TEST_CASE("gltf files: a header that lies about lengths is an error") {
  const TemporaryFolder folder;
  for (const size_t at : {size_t(8), size_t(12)})  // the file's length, the JSON chunk's
    for (const uint32_t value : {0u, 1u, 13u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
      std::vector<uint8_t> glb = triangle().glb();
      for (size_t k = 0; k < 4; ++k) glb[at + k] = uint8_t(value >> (8 * k));
      writeBytes(folder / "lie.glb", glb);
      errorOf(folder / "lie.glb");
    }
  std::vector<uint8_t> glb = triangle().glb();
  glb[glb.size() - triangle().binary.size() - 8] += 4;  // the binary chunk's length
  writeBytes(folder / "lie.glb", glb);
  errorOf(folder / "lie.glb");
}

TEST_CASE("gltf files: nesting that would exhaust the stack is refused") {
  const TemporaryFolder folder;
  const std::string deep(1000000, '[');
  CHECK(errorOf(writeText(folder, deep)).message == "JSON nested deeper than 256 levels");
  const std::string text = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": " + std::string(1000, '[') +
                           std::string(1000, ']') + "}";
  CHECK(errorOf(writeText(folder, text)).message == "JSON nested deeper than 256 levels");
  CHECK(errorOf(writeText(folder, "{\"asset\": {\"version\": \"" + deep + "\\\"[[\"}}")).gltfPath == "/asset/version");
}

TEST_CASE("gltf files: members of the wrong type are errors with their path") {
  const auto broken = [](const char* where, const Json& value) {
    GltfBuilder b = triangle();
    b.json[Json::json_pointer(where)] = value;
    return pathOfError(b);
  };
  const struct { const char* path; Json value; } kCases[] = {
      {"/accessors/0/count", "3"}, {"/accessors/0/count", -3}, {"/accessors/0/count", 3.5},
      {"/accessors/0/componentType", 5124}, {"/accessors/0/componentType", 5130}, {"/accessors/0/bufferView", 7},
      {"/accessors/0/normalized", 1}, {"/accessors/0/type", 3}, {"/accessors/0/type", "VEC5"},
      {"/bufferViews/0/buffer", 1.0},
      {"/bufferViews/0/byteStride", 2}, {"/bufferViews/0/byteStride", 256}, {"/bufferViews/0/byteStride", 5},
      {"/meshes/0/primitives/0/material", 0}, {"/meshes/0/primitives/0/indices", 9},
      {"/meshes/0/primitives/0/attributes/POSITION", 9}, {"/meshes/0/primitives/0/attributes/POSITION", "0"},
      {"/meshes/0/primitives/0/attributes", 1}, {"/meshes/0/primitives", Json::object()}, {"/nodes/0/mesh", true},
      {"/nodes/0/translation", {1, 2}}, {"/nodes/0/rotation", {1, 2, 3, "4"}}, {"/nodes/0/name", 5},
      {"/scenes/0/nodes", 0}, {"/scene", "0"}, {"/meshes/0/primitives/0/extensions", 4}};
  for (const auto& c : kCases) {
    INFO(c.path << " = " << c.value);
    const std::string found = broken(c.path, c.value);
    CHECK(found.find(c.path) == 0);
  }
  GltfBuilder b = triangle();
  b.json["accessors"][0].erase("count");
  CHECK(pathOfError(b) == "/accessors/0");
  b = triangle();
  b.json["bufferViews"][0]["buffer"] = 1;
  CHECK(pathOfError(b) == "/bufferViews/0");
}

TEST_CASE("gltf files: a required extension that is not supported is an error, an optional one a warning") {
  GltfBuilder b = triangle();
  b.json["extensionsUsed"] = {"KHR_mesh_quantization", "KHR_draco_mesh_compression", "VENDOR_x", "VENDOR_x"};
  b.json["nodes"][0]["extensions"]["VENDOR_undeclared"] = {{"deep", {1, 2, 3}}};
  b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const TemporaryFolder folder;
  const auto scene = sceneFromGltf(b.writeGlb(folder));
  REQUIRE(scene.ok());
  CHECK((*scene).warnings == std::vector<std::string>{"the extension KHR_draco_mesh_compression is ignored",
                                                      "the extension VENDOR_undeclared is ignored",
                                                      "the extension VENDOR_x is ignored"});
  b.json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_draco_mesh_compression"};
  const Error error = errorOf(b.writeGlb(folder));
  CHECK(error.gltfPath == "/extensionsRequired/1");
  CHECK(error.message == "the required extension KHR_draco_mesh_compression is not supported");
}

TEST_CASE("gltf files: limits on files, triangles and memory hold") {
  const GltfBuilder b = triangle();
  LoadOptions options;
  options.limits.fileBytes = b.glb().size();
  CHECK(pathOfError(b, options) == "loaded");
  options.limits.fileBytes -= 1;
  CHECK(pathOfError(b, options) == "");
  options = {};
  options.limits.triangles = 0;
  CHECK(pathOfError(b, options) == "/meshes/0/primitives/0");
  options = {};
  options.limits.geometryBytes = 59;
  CHECK(pathOfError(b, options) == "/meshes/0/primitives/0");
  options.limits.geometryBytes = 60;  // 3 indices read, 3 kept, 3 positions
  CHECK(pathOfError(b, options) == "loaded");
}

TEST_CASE("gltf files: control characters of a hostile file do not reach a message") {
  GltfBuilder b = triangle();
  b.json["extensionsRequired"] = {"A\x1b[31m\nB"};
  const TemporaryFolder folder;
  CHECK(errorOf(b.writeGlb(folder)).message == "the required extension A?[31m?B is not supported");
}
