// Height maps as extras of materials.
#include <catch2/catch.hpp>

#include "obscura/engine/gltf.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura::tests;
using obscura::engine::LoadOptions;
using obscura::engine::sceneFromGltf;
using obscura::raster::Wrap;
using Json = GltfBuilder::Json;

namespace {

obscura::engine::Result<obscura::engine::Scene> load(GltfBuilder& b, const Json& extras, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const int uv = b.addFloats({0, 0, 1, 0, 0, 1}, "VEC2");
  b.addTriangle({{"material", b.add("materials", {{"extras", extras}})}, {"attributes", {{"TEXCOORD_0", uv}}}});
  return sceneFromGltf(b.writeGlb(folder), options);
}

// The first channel: 0, 51, 255 and 128 of 255.
GltfBuilder withTexture() {
  GltfBuilder b;
  b.addTexture(pngOf({0xFF000000, 0xFF00FF33, 0xFF0000FF, 0xFF808080}, 2, 2), {{"wrapS", 33071}, {"wrapT", 33648}});
  return b;
}

Json height(const char* json) { return {{"obscura_height", Json::parse(json)}}; }

}  // namespace

TEST_CASE("gltf height: the first channel, the sampler's wrap modes, scale and transform are read") {
  GltfBuilder b = withTexture();
  const auto scene = load(b, height(R"({"index": 0, "scale": 0.5, "extensions": {"KHR_texture_transform": {"offset": [0.25, 0], "scale": [2, 3]}}})"));
  REQUIRE(scene.ok());
  const auto& m = scene->materials.at(0);
  CHECK(m.heightScale == 0.5f);
  REQUIRE(m.heightMap.texture == 0);
  CHECK(m.heightMap.uvFromUv == std::array<float, 6>{2, 0, 0.25f, 0, 3, 0});
  REQUIRE(scene->heightMaps.size() == 1);
  const auto& map = scene->heightMaps[0].view;
  CHECK(map.width == 2);
  CHECK(map.height == 2);
  CHECK(map.wrapU == Wrap::ClampToEdge);
  CHECK(map.wrapV == Wrap::MirroredRepeat);
  CHECK(std::vector<float>(map.heights.begin(), map.heights.end()) == std::vector<float>{0, 51 / 255.f, 1, 128 / 255.f});
  CHECK(scene->textures.empty());
  CHECK_FALSE(scene->meshes.at(0).uvs[0].empty());
}

TEST_CASE("gltf height: it moves surfaces, so it is read for frames without textures as well, and once for all its users") {
  GltfBuilder b = withTexture();
  const int uv = b.addFloats({0, 0, 1, 0, 0, 1}, "VEC2");
  b.addTriangle({{"material", b.add("materials", {{"extras", height(R"({"index": 0, "scale": 3})")}})}, {"attributes", {{"TEXCOORD_0", uv}}}});
  LoadOptions options;
  options.textures = false;
  const auto scene = load(b, height(R"({"index": 0, "scale": 0})"), options);
  REQUIRE(scene.ok());
  CHECK(scene->heightMaps.size() == 1);
  CHECK(scene->materials[0].heightMap.texture == 0);
  CHECK(scene->materials[1].heightMap.texture == 0);
}

TEST_CASE("gltf height: what cannot be is refused with its place in the file") {
  const char* wrong[] = {R"({"index": 0})",
                         R"({"scale": 1})",
                         R"({"index": 0, "scale": -0.5})",
                         R"({"index": 0, "scale": 1e16})",
                         R"({"index": 0, "scale": "1"})",
                         R"({"index": 0, "scale": null})",
                         R"({"index": -1, "scale": 1})",
                         R"({"index": 0.5, "scale": 1})",
                         R"({"index": 7, "scale": 1})",
                         R"({"index": 0, "scale": 1, "texCoord": -2})",
                         R"({"index": 0, "scale": 1, "extensions": 3})",
                         R"([])"};
  for (const char* json : wrong) {
    INFO(json);
    GltfBuilder b = withTexture();
    const auto scene = load(b, height(json));
    REQUIRE(!scene.ok());
    INFO(scene.error().text());
    CHECK(scene.error().gltfPath.find("/materials/0/extras/obscura_height") == 0);
    CHECK(scene.error().code == obscura::engine::ErrorCode::BadInput);
  }
}

TEST_CASE("gltf height: images that cannot be read or are too large are refused, other extras mean nothing") {
  GltfBuilder broken;
  broken.addTexture({1, 2, 3});
  CHECK(load(broken, height(R"({"index": 0, "scale": 1})")).error().gltfPath == "/images/0");
  LoadOptions small;
  small.limits.textureBytes = 15;
  GltfBuilder large = withTexture();
  CHECK_FALSE(load(large, height(R"({"index": 0, "scale": 1})"), small).ok());
  for (const Json& extras : {Json(3), Json("text"), Json::array({1, 2}), Json{{"obscura", 1}}, Json(nullptr)}) {
    GltfBuilder b = withTexture();
    const auto scene = load(b, extras);
    REQUIRE(scene.ok());
    CHECK(scene->materials[0].heightMap.texture == -1);
    CHECK(scene->heightMaps.empty());
  }
}

TEST_CASE("gltf height: a texture without an image leaves the surface flat, with a warning") {
  GltfBuilder none;
  none.add("textures", Json::object());
  const auto scene = load(none, height(R"({"index": 0, "scale": 1})"));
  REQUIRE(scene.ok());
  CHECK(scene->materials[0].heightMap.texture == -1);
  CHECK_FALSE(scene->warnings.empty());
}
