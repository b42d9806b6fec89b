// Random damage: whatever comes out, it comes out as a scene or as an error.
#include <catch2/catch.hpp>

#include <cmath>

#include "obscura/engine/gltf.h"
#include "obscura/engine/shadow_maps.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura::tests;
using obscura::engine::LoadOptions;
using obscura::engine::Scene;
using obscura::engine::sceneFromGltf;

namespace {

struct Random {  // splitmix64
  uint64_t state;
  uint64_t next() {
    uint64_t z = state += 0x9E3779B97F4A7C15;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
    z = (z ^ z >> 27) * 0x94D049BB133111EB;
    return z ^ z >> 31;
  }
  size_t below(size_t n) { return size_t(next() % n); }
};

// Something of everything.
GltfBuilder sample() {
  GltfBuilder b;
  const int uv = b.addAccessor<uint16_t>({0, 0, 65535, 0, 0, 65535}, kUShort, "VEC2", true);
  b.addTexture(pngOf({0xFF0000FF, 0xFF00FF00, 0xFFFF0000, 0x80FFFFFF}, 2, 2), {{"minFilter", 9987}, {"wrapS", 33071}});
  b.add("materials", GltfBuilder::Json::parse(R"({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture":
    {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1}}}},
    "extras": {"obscura_height": {"index": 0, "scale": 0.5, "texCoord": 0,
    "extensions": {"KHR_texture_transform": {"offset": [0.25, 1]}}}}})"));
  b.addTriangle({{"attributes", {{"TEXCOORD_0", uv}}},
                 {"material", 0},
                 {"indices", b.addAccessor<uint8_t>({0, 1, 2}, kUByte, "SCALAR")}});
  const int sparse = b.addView<uint8_t>({1}), values = b.addView<float>({5, 5, 5});
  const size_t position = b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
  b.json["accessors"][position]["sparse"] = {{"count", 1},
                                             {"indices", {{"bufferView", sparse}, {"componentType", 5121}}},
                                             {"values", {{"bufferView", values}}}};
  b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", b.addFloats({1, 0, 0, 0, 2, 0}, "VEC3")}};
  b.add("nodes", {{"children", {0}}, {"rotation", {0, 0.6, 0, 0.8}}});
  b.json["scenes"][0]["nodes"] = {1};
  b.addNode({{"camera", b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}})}});
  b.addNode({{"extras", {{"obscura_implicit", GltfBuilder::Json::parse(R"({"type": "metaballs", "material": 0, "radius": 1,
    "balls": [{"center": [1, 2, 3], "radius": 1}, {"radius": 2}]})")}}}});
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = GltfBuilder::Json::parse(R"([{"type": "spot", "color": [1, 0.5, 0.25],
    "intensity": 3, "range": 9, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}}])");
  b.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return b;
}

std::vector<uint8_t> damaged(std::vector<uint8_t> bytes, Random& random) {
  for (size_t k = random.below(4) == 0 ? 3 : 1; k-- > 0 && !bytes.empty();) {
    size_t at = random.below(bytes.size());
    switch (random.below(12)) {
      case 0: bytes.resize(at); break;
      case 1: bytes.erase(bytes.begin() + std::ptrdiff_t(at)); break;
      case 2: bytes[at] = "0123456789-.e\"[]{},:"[random.below(20)]; break;
      case 3: bytes.insert(bytes.begin() + std::ptrdiff_t(at), uint8_t('0' + random.below(10))); break;
      case 4: bytes[at] = random.below(2) ? 0xFF : 0; break;
      case 5: bytes[at] ^= uint8_t(1u << random.below(8)); break;
      default:  // another digit keeps JSON readable
        while (at < bytes.size() && (bytes[at] < '0' || bytes[at] > '9')) ++at;
        if (at < bytes.size()) bytes[at] = uint8_t('0' + random.below(10));
    }
  }
  return bytes;
}

void checkSound(const Scene& scene) {
  REQUIRE(!scene.materials.empty());
  for (const auto& mesh : scene.meshes) {
    REQUIRE(mesh.material < scene.materials.size());
    for (uint32_t i : mesh.indices) REQUIRE(i < mesh.positions.size());
    for (const auto& uv : mesh.uvs) REQUIRE((uv.empty() || uv.size() == mesh.positions.size()));
  }
  for (const auto& instance : scene.instances) REQUIRE(instance.mesh < scene.meshes.size());
  for (const auto& implicit : scene.implicits) {
    REQUIRE(implicit.material < scene.materials.size());
    REQUIRE(obscura::raster::wrongImplicit(implicit) == nullptr);
  }
  for (const auto& material : scene.materials) {
    REQUIRE(material.baseColorMap.texture < int(scene.textures.size()));
    REQUIRE(material.heightMap.texture < int(scene.heightMaps.size()));
    REQUIRE((material.heightScale >= 0 && material.heightScale <= 1e15f));
  }
  for (const auto& light : scene.lights) REQUIRE(obscura::engine::wrongLight(light) == nullptr);
  for (const auto& map : scene.heightMaps) {
    REQUIRE(map.view.heights.size() == size_t(map.view.width) * size_t(map.view.height));
    for (float h : map.view.heights) REQUIRE((h >= 0 && h <= 1));
  }
  for (int c = 0; c < 3; ++c) REQUIRE((std::isfinite(scene.bounds.min[c]) && std::isfinite(scene.bounds.max[c])));
}

}  // namespace

TEST_CASE("gltf fuzz: a damaged file is a sound scene or an error") {
  const TemporaryFolder folder;
  const GltfBuilder b = sample();
  const std::string text = b.gltf(dataUri(b.binary));
  const std::vector<uint8_t> files[] = {b.glb(), {text.begin(), text.end()}};
  Random random{20260101};
  LoadOptions options;
  options.limits.zeroElements = 10000;
  int loaded = 0, refused = 0;
  for (const auto& file : files) {
    writeBytes(folder / "damaged", file);
    REQUIRE(sceneFromGltf(folder / "damaged", options).ok());
    for (int i = 0; i < 300; ++i) {
      options.textures = i % 2 == 0;
      writeBytes(folder / "damaged", damaged(file, random));
      const auto scene = sceneFromGltf(folder / "damaged", options);
      if (scene) checkSound(*scene);
      else REQUIRE(!scene.error().message.empty());
      ++(scene ? loaded : refused);
    }
  }
  CHECK(loaded > 50);  // otherwise the damage would test only the parser
  CHECK(refused > 50);
}
