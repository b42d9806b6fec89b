#include <catch2/catch.hpp>

#include <cmath>

#include "obscura/engine/gltf.h"
#include "obscura/tests/gltf_builder.h"

using namespace obscura::tests;
using obscura::engine::LoadOptions;
using obscura::engine::Scene;
using obscura::engine::sceneFromGltf;
using obscura::raster::Filter;
using obscura::raster::Material;
using obscura::raster::MipFilter;
using obscura::raster::TextureView;
using obscura::raster::Wrap;
using Json = GltfBuilder::Json;

namespace {

const std::vector<uint8_t> kImage = pngOf({0xFF0000FF, 0xFF00FF00, 0xFFFF0000, 0x80FFFFFF}, 2, 2);

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

// A triangle with the material and two sets of texture coordinates.
GltfBuilder drawnWith(const Json& material) {
  GltfBuilder b;
  const int uv0 = b.addFloats({0, 0, 1, 0, 0, 1}, "VEC2"), uv1 = b.addFloats({5, 5, 6, 5, 5, 6}, "VEC2");
  b.addTriangle({{"material", b.add("materials", material)},
                 {"attributes", {{"TEXCOORD_0", uv0}, {"TEXCOORD_1", uv1}}}});
  return b;
}

Material materialOf(const Json& material) { return load(drawnWith(material)).materials.at(0); }

Json baseTexture(const Json& info) { return {{"pbrMetallicRoughness", {{"baseColorTexture", info}}}}; }

}  // namespace

TEST_CASE("gltf materials: what is not said has glTF's default") {
  GltfBuilder b;
  b.addTriangle();
  const Scene scene = load(b);
  REQUIRE(scene.materials.size() == 1);
  CHECK(scene.meshes.at(0).material == 0);
  const Material& m = scene.materials[0];
  CHECK(m.baseColor == glm::vec4(1));
  CHECK(m.emissive == glm::vec3(0));
  CHECK(m.metallic == 1);
  CHECK(m.roughness == 1);
  CHECK(m.alphaMode == obscura::raster::AlphaMode::Opaque);
  CHECK_FALSE(m.doubleSided);
  CHECK_FALSE(m.unlit);
  CHECK(m.baseColorMap.texture == -1);
}

TEST_CASE("gltf materials: factors, sides and extensions are read") {
  const Material m = materialOf(Json::parse(R"({
    "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 0.75, 1], "metallicFactor": 0.5, "roughnessFactor": 0.25},
    "emissiveFactor": [1, 0.5, 0], "doubleSided": true,
    "extensions": {"KHR_materials_unlit": {}, "KHR_materials_emissive_strength": {"emissiveStrength": 8}}})"));
  CHECK(m.baseColor == glm::vec4(0.25f, 0.5f, 0.75f, 1));
  CHECK(m.metallic == 0.5f);
  CHECK(m.roughness == 0.25f);
  CHECK(m.emissive == glm::vec3(8, 4, 0));
  CHECK(m.doubleSided);
  CHECK(m.unlit);
}

TEST_CASE("gltf materials: MASK keeps its cutoff, BLEND becomes MASK at one half with one warning") {
  const Material mask = materialOf({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}});
  CHECK(mask.alphaMode == obscura::raster::AlphaMode::Mask);
  CHECK(mask.alphaCutoff == 0.25f);
  const Scene blend = load(drawnWith({{"alphaMode", "BLEND"}, {"alphaCutoff", 0.25}}));
  CHECK(blend.materials[0].alphaMode == obscura::raster::AlphaMode::Mask);
  CHECK(blend.materials[0].alphaCutoff == 0.5f);
  CHECK(blend.warnings.size() == 1);
  CHECK(pathOfError(drawnWith({{"alphaMode", "ADD"}})) == "/materials/0/alphaMode");
}

TEST_CASE("gltf textures: base colour and emission are sRGB, normals and roughness are not") {
  GltfBuilder b = drawnWith(Json::object());
  const int t = b.addTexture(kImage);
  b.json["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", t}}},
                                                      {"metallicRoughnessTexture", {{"index", t}}}}},
                            {"emissiveTexture", {{"index", t}}},
                            {"normalTexture", {{"index", t}, {"scale", 0.5}}}};
  const Scene scene = load(b);
  const Material& m = scene.materials[0];
  REQUIRE(scene.textures.size() == 2);  // one image, in two colour spaces
  CHECK(scene.textures[size_t(m.baseColorMap.texture)].view.srgb);
  CHECK(m.emissiveMap.texture == m.baseColorMap.texture);
  CHECK_FALSE(scene.textures[size_t(m.normalMap.texture)].view.srgb);
  CHECK(m.metallicRoughnessMap.texture == m.normalMap.texture);
  CHECK(m.normalScale == 0.5f);

  const TextureView& view = scene.textures[0].view;
  CHECK(view.width == 2);
  CHECK(view.height == 2);
  CHECK(view.levels == 2);
  REQUIRE(view.texels.size() == 5);
  CHECK(view.texels[0] == 0xFF0000FF);
  CHECK(view.texels[3] == 0x80FFFFFF);
  CHECK(view.texels.data() == scene.textures[0].texels->data());
}

TEST_CASE("gltf textures: each wrap and filter mode, and linear repeating ones where none is named") {
  const auto viewOf = [](const Json& sampler) {
    GltfBuilder b = drawnWith(baseTexture({{"index", 0}}));
    b.addTexture(kImage, sampler);
    return load(b).textures.at(0).view;
  };
  const TextureView free = viewOf(nullptr);
  CHECK((free.wrapU == Wrap::Repeat && free.wrapV == Wrap::Repeat));
  CHECK((free.magFilter == Filter::Linear && free.minFilter == Filter::Linear && free.mip == MipFilter::Linear));
  const TextureView wrapped = viewOf({{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  CHECK((wrapped.wrapU == Wrap::ClampToEdge && wrapped.wrapV == Wrap::MirroredRepeat));
  CHECK(wrapped.magFilter == Filter::Nearest);
  const struct { int code; Filter filter; MipFilter mip; } kFilters[] = {
      {9728, Filter::Nearest, MipFilter::None},    {9729, Filter::Linear, MipFilter::None},
      {9984, Filter::Nearest, MipFilter::Nearest}, {9985, Filter::Linear, MipFilter::Nearest},
      {9986, Filter::Nearest, MipFilter::Linear},  {9987, Filter::Linear, MipFilter::Linear}};
  for (const auto& f : kFilters) {
    const TextureView v = viewOf({{"minFilter", f.code}});
    CHECK((v.minFilter == f.filter && v.mip == f.mip));
    CHECK(v.levels == (f.mip == MipFilter::None ? 1 : 2));
  }
  for (const char* member : {"wrapS", "wrapT", "minFilter", "magFilter"}) {
    GltfBuilder b = drawnWith(baseTexture({{"index", 0}}));
    b.addTexture(kImage, {{member, 9999}});
    CHECK(pathOfError(b) == std::string("/samplers/0/") + member);
  }
}

TEST_CASE("gltf textures: only the images of drawn materials are decoded") {
  const std::vector<uint8_t> broken = {1, 2, 3};
  GltfBuilder b = drawnWith(Json::object());
  b.addTexture(broken);
  b.add("materials", baseTexture({{"index", 0}}));
  CHECK(load(b).textures.empty());
  b.json["materials"][0] = baseTexture({{"index", 0}});
  CHECK(pathOfError(b) == "/images/0");
  LoadOptions options;
  options.textures = false;
  const Scene scene = load(b, options);
  CHECK(scene.textures.empty());
  CHECK(scene.materials[0].baseColorMap.texture == -1);
  // A mask's texture decides what is seen, so it is read all the same.
  b.json["materials"][0]["alphaMode"] = "MASK";
  b.json["images"][0] = {{"uri", dataUri(kImage)}};
  const Scene masked = load(b, options);
  CHECK(masked.textures.size() == 1);
  CHECK(masked.materials[0].baseColorMap.texture == 0);
}

TEST_CASE("gltf textures: images come from bufferViews, data URIs and files") {
  const TemporaryFolder folder;
  writeBytes(folder / "my image.png", kImage);
  for (const std::string& uri : {std::string("my%20image.png"), std::string("./my image.png"), dataUri(kImage)}) {
    GltfBuilder b = drawnWith(baseTexture({{"index", 0}}));
    b.add("textures", {{"source", b.add("images", {{"uri", uri}})}});
    const auto scene = sceneFromGltf(b.writeGlb(folder));
    REQUIRE(scene.ok());
    CHECK((*scene).textures.at(0).view.texels[1] == 0xFF00FF00);
  }
  GltfBuilder b = drawnWith(baseTexture({{"index", 0}}));
  b.add("textures", {{"source", b.add("images", {{"uri", "absent.png"}})}});
  const auto scene = sceneFromGltf(b.writeGlb(folder));
  REQUIRE(!scene.ok());
  CHECK(scene.error().gltfPath == "/images/0");
  CHECK(scene.error().file == folder / "absent.png");
}

TEST_CASE("gltf textures: the limits on sides and bytes hold") {
  GltfBuilder b = drawnWith(baseTexture({{"index", 0}}));
  b.addTexture(kImage);
  LoadOptions options;
  options.limits.textureSize = 1;
  CHECK(pathOfError(b, options) == "/images/0");
  options = {};
  options.limits.textureBytes = 20;
  CHECK(pathOfError(b, options) == "loaded");
  options.limits.textureBytes = 19;
  CHECK(pathOfError(b, options) == "/images");
}

TEST_CASE("gltf textures: indices that name nothing are errors, a texture without an image is a warning") {
  CHECK(pathOfError(drawnWith(baseTexture({{"index", 3}}))) ==
        "/materials/0/pbrMetallicRoughness/baseColorTexture/index");
  GltfBuilder b = drawnWith(baseTexture({{"index", 0}}));
  b.addTexture(kImage, Json::object());
  b.json["textures"][0]["source"] = 3;
  CHECK(pathOfError(b) == "/textures/0/source");
  b.json["textures"][0]["source"] = 0;
  b.json["textures"][0]["sampler"] = 3;
  CHECK(pathOfError(b) == "/textures/0/sampler");
  b.json["textures"][0].erase("source");
  const Scene scene = load(b);
  CHECK(scene.textures.empty());
  CHECK(scene.warnings.size() == 1);
}

TEST_CASE("gltf textures: KHR_texture_transform scales, then turns, then moves") {
  // The extension's own example: the lower left quadrant of the image, turned clockwise by 90 degrees.
  GltfBuilder b = drawnWith(baseTexture(Json::parse(R"({"index": 0, "texCoord": 0, "extensions":
    {"KHR_texture_transform":
      {"offset": [0, 1], "rotation": 1.5707963267948966, "scale": [0.5, 0.5], "texCoord": 1}}})")));
  b.addTexture(kImage);
  const Scene scene = load(b);
  const auto& m = scene.materials[0].baseColorMap.uvFromUv;
  const auto at = [&](float u, float v) { return glm::vec2(m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]); };
  const auto near = [](glm::vec2 a, glm::vec2 e) { return std::abs(a.x - e.x) < 1e-6f && std::abs(a.y - e.y) < 1e-6f; };
  CHECK(near(at(0, 0), {0, 1}));
  CHECK(near(at(1, 0), {0, 0.5f}));
  CHECK(near(at(0, 1), {0.5f, 1}));
  const int set = scene.materials[0].baseColorMap.uvSet;
  CHECK(scene.meshes[0].uvs[set] == std::vector<glm::vec2>{{5, 5}, {6, 5}, {5, 6}});
}

TEST_CASE("gltf textures: texture coordinates and tangents are read only where a texture needs them") {
  GltfBuilder b = drawnWith(Json::object());
  b.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      b.addFloats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4");
  const Scene bare = load(b);
  CHECK(bare.meshes[0].uvs[0].empty());
  CHECK(bare.meshes[0].tangents.empty());
  b.addTexture(kImage);
  b.json["materials"][0] = {{"normalTexture", {{"index", 0}}}};
  const Scene mapped = load(b);
  CHECK(mapped.meshes[0].uvs[0].size() == 3);
  CHECK(mapped.meshes[0].uvs[1].empty());
  CHECK(mapped.meshes[0].tangents.at(2) == glm::vec4(1, 0, 0, -1));
}

TEST_CASE("gltf textures: any two sets of coordinates may be used, a third is left out with a warning") {
  GltfBuilder b = drawnWith(Json::object());
  const int t = b.addTexture(kImage);
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_4"] = b.addFloats({7, 7, 8, 7, 7, 8}, "VEC2");
  b.json["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", t}, {"texCoord", 4}}}}},
                            {"normalTexture", {{"index", t}, {"texCoord", 1}}},
                            {"emissiveTexture", {{"index", t}, {"texCoord", 0}}}};
  const Scene scene = load(b);
  const Material& m = scene.materials[0];
  CHECK(scene.meshes[0].uvs[m.baseColorMap.uvSet].at(0) == glm::vec2(7, 7));
  CHECK(scene.meshes[0].uvs[m.normalMap.uvSet].at(0) == glm::vec2(5, 5));
  CHECK(m.emissiveMap.texture == -1);
  CHECK(scene.warnings.size() == 1);
}
