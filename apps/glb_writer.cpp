#include "obscura/apps/glb_writer.h"

#include <algorithm>
#include <cstring>

#include <nlohmann/json.hpp>

#include "obscura/apps/demo_random.h"

namespace obscura::apps {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<uint8_t>;

// Numbers of glTF's component types and buffer targets (those of OpenGL).
constexpr int kU16 = 5123, kU32 = 5125, kF32 = 5126, kVertices = 34962, kIndices = 34963;

void putLittle(Bytes& out, uint32_t v, int bytes = 4) {
  for (int i = 0; i < bytes; ++i) out.push_back(uint8_t(v >> (8 * i)));
}

void putBig(Bytes& out, uint32_t v) {
  for (int i = 3; i >= 0; --i) out.push_back(uint8_t(v >> (8 * i)));
}

void putFloat(Bytes& out, float v) {
  uint32_t bits;
  std::memcpy(&bits, &v, sizeof bits);
  putLittle(out, bits);
}

void pad(Bytes& out, uint8_t with) {
  while (out.size() % 4 != 0) out.push_back(with);
}

Json array(glm::dvec3 v) { return {v.x, v.y, v.z}; }

// The buffer and the JSON lists that describe it.
struct Buffer {
  Bytes bytes;
  Json views = Json::array(), accessors = Json::array();

  size_t addView(const Bytes& data, int target) {
    pad(bytes, 0);
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}};
    if (target != 0) view["target"] = target;
    bytes.insert(bytes.end(), data.begin(), data.end());
    views.push_back(view);
    return views.size() - 1;
  }

  size_t addAccessor(const Bytes& data, int target, int componentType, size_t count, const char* type) {
    const size_t view = addView(data, target);
    accessors.push_back({{"bufferView", view}, {"componentType", componentType}, {"count", count}, {"type", type}});
    return accessors.size() - 1;
  }
};

size_t addVectors(Buffer& buffer, const std::vector<glm::vec3>& vectors, bool bounds) {
  Bytes data;
  glm::vec3 lo = vectors[0], hi = lo;
  for (const glm::vec3& v : vectors)
    for (int k = 0; k < 3; ++k) {
      putFloat(data, v[k]);
      lo[k] = std::min(lo[k], v[k]);
      hi[k] = std::max(hi[k], v[k]);
    }
  const size_t accessor = buffer.addAccessor(data, kVertices, kF32, vectors.size(), "VEC3");
  if (bounds) {
    buffer.accessors[accessor]["min"] = array(lo);
    buffer.accessors[accessor]["max"] = array(hi);
  }
  return accessor;
}

Json primitiveOf(const GlbMesh& mesh, Buffer& buffer) {
  Json attributes;
  attributes["POSITION"] = addVectors(buffer, mesh.positions, true);
  attributes["NORMAL"] = addVectors(buffer, mesh.normals, false);
  if (!mesh.uvs.empty()) {
    Bytes data;
    for (const glm::vec2& uv : mesh.uvs) {
      putFloat(data, uv.x);
      putFloat(data, uv.y);
    }
    attributes["TEXCOORD_0"] = buffer.addAccessor(data, kVertices, kF32, mesh.uvs.size(), "VEC2");
  }
  if (!mesh.colors.empty()) {
    Bytes data;
    for (const glm::vec3& c : mesh.colors) {
      for (int k = 0; k < 3; ++k) putLittle(data, uint32_t(clamp01(double(c[k])) * 65535 + 0.5), 2);
      putLittle(data, 65535, 2);
    }
    const size_t accessor = buffer.addAccessor(data, kVertices, kU16, mesh.colors.size(), "VEC4");
    buffer.accessors[accessor]["normalized"] = true;
    attributes["COLOR_0"] = accessor;
  }
  const bool isShort = mesh.positions.size() <= 65535;  // 65535 itself would restart a strip
  Bytes data;
  for (uint32_t i : mesh.indices) putLittle(data, i, isShort ? 2 : 4);
  const size_t indices = buffer.addAccessor(data, kIndices, isShort ? kU16 : kU32, mesh.indices.size(), "SCALAR");
  return {{"attributes", attributes}, {"indices", indices}, {"material", mesh.material}};
}

Json materialJson(const GlbMaterial& material) {
  const auto number = [](double v) { return v == double(int(v)) ? Json(int(v)) : Json(v); };
  Json pbr = {{"baseColorFactor", {material.baseColor.x, material.baseColor.y, material.baseColor.z, 1}},
              {"metallicFactor", number(material.metallic)},
              {"roughnessFactor", number(material.roughness)}};
  if (material.texture >= 0) pbr["baseColorTexture"] = {{"index", material.texture}};
  if (material.gloss >= 0) pbr["metallicRoughnessTexture"] = {{"index", material.gloss}};
  Json json = {{"name", material.name}, {"pbrMetallicRoughness", pbr}};
  if (material.alphaCutoff > 0) {
    json["alphaMode"] = "MASK";
    json["alphaCutoff"] = material.alphaCutoff;
  }
  if (material.normalMap >= 0) json["normalTexture"] = {{"index", material.normalMap}};
  const double strength = std::max({1.0, material.emissive.x, material.emissive.y, material.emissive.z});
  if (material.emissive != glm::dvec3(0)) json["emissiveFactor"] = array(material.emissive / strength);
  if (strength > 1) json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  if (material.doubleSided) json["doubleSided"] = true;
  if (!material.extras.empty()) json["extras"] = Json::parse(material.extras);
  return json;
}

Json nodeJson(const GlbNode& node) {
  Json json = {{"name", node.name}};
  if (node.mesh >= 0) json["mesh"] = node.mesh;
  if (node.light >= 0) json["extensions"]["KHR_lights_punctual"]["light"] = node.light;
  if (node.translation != glm::dvec3(0)) json["translation"] = array(node.translation);
  if (node.rotation != std::array<double, 4>{0, 0, 0, 1}) json["rotation"] = node.rotation;
  if (node.scale != glm::dvec3(1)) json["scale"] = array(node.scale);
  if (!node.children.empty()) json["children"] = node.children;
  if (!node.extras.empty()) json["extras"] = Json::parse(node.extras);
  return json;
}

Json lightJson(const GlbLight& light) {
  Json json = {{"name", light.name}, {"type", light.type}, {"color", array(light.color)}, {"intensity", light.intensity}};
  if (light.range > 0) json["range"] = light.range;
  if (light.type == "spot") json["spot"] = {{"innerConeAngle", light.innerCone}, {"outerConeAngle", light.outerCone}};
  return json;
}

Json cameraNodeJson(const GlbCamera& camera) {
  const glm::dvec3 back = unit(camera.eye - camera.target);
  const glm::dvec3 right = unit(cross({0, 1, 0}, back)), up = cross(back, right);
  Json matrix = Json::array();
  for (const glm::dvec3& column : {right, up, back, camera.eye}) {
    for (int k = 0; k < 3; ++k) matrix.push_back(column[k]);
    matrix.push_back(matrix.size() == 15 ? 1 : 0);
  }
  return {{"name", camera.name}, {"camera", 0}, {"matrix", matrix}};
}

void putPngChunk(Bytes& out, const char (&type)[5], const Bytes& data) {
  putBig(out, uint32_t(data.size()));
  const size_t start = out.size();
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), data.begin(), data.end());
  uint32_t crc = 0xFFFFFFFFu;
  for (size_t i = start; i < out.size(); ++i) {
    crc ^= out[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0);
  }
  putBig(out, ~crc);
}

}  // namespace

std::vector<uint8_t> storedPng(const GlbTexture& texture) {
  const bool grey = !texture.grey.empty();
  Bytes pixels = texture.rgba;
  for (uint16_t v : texture.grey) {
    pixels.push_back(uint8_t(v >> 8));
    pixels.push_back(uint8_t(v & 0xFF));
  }
  const size_t rowBytes = size_t(texture.width) * (grey ? 2 : 4);
  Bytes raw;
  for (int y = 0; y < texture.height; ++y) {
    raw.push_back(0);  // filter: none
    const auto row = pixels.begin() + std::ptrdiff_t(size_t(y) * rowBytes);
    raw.insert(raw.end(), row, row + std::ptrdiff_t(rowBytes));
  }
  Bytes zlib = {0x78, 0x01};
  uint32_t a = 1, b = 0;  // Adler-32
  for (uint8_t v : raw) {
    a = (a + v) % 65521;
    b = (b + a) % 65521;
  }
  for (size_t at = 0; at < raw.size();) {
    const size_t length = std::min<size_t>(raw.size() - at, 65535);
    zlib.push_back(at + length == raw.size() ? 1 : 0);  // last block or not; stored
    putLittle(zlib, uint32_t(length), 2);
    putLittle(zlib, uint32_t(~length & 0xFFFF), 2);
    zlib.insert(zlib.end(), raw.begin() + std::ptrdiff_t(at), raw.begin() + std::ptrdiff_t(at + length));
    at += length;
  }
  putBig(zlib, b << 16 | a);

  Bytes header;
  putBig(header, uint32_t(texture.width));
  putBig(header, uint32_t(texture.height));
  header.insert(header.end(), {uint8_t(grey ? 16 : 8), uint8_t(grey ? 0 : 6), 0, 0, 0});  // bits, grey or RGBA, not interlaced
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  putPngChunk(out, "IHDR", header);
  putPngChunk(out, "IDAT", zlib);
  putPngChunk(out, "IEND", {});
  return out;
}

std::vector<uint8_t> glbFromScene(const GlbScene& scene) {
  Buffer buffer;
  Json meshes = Json::array(), materials = Json::array(), images = Json::array(), textures = Json::array();
  for (const GlbMesh& mesh : scene.meshes)
    meshes.push_back({{"name", mesh.name}, {"primitives", Json::array({primitiveOf(mesh, buffer)})}});
  for (const GlbMaterial& material : scene.materials) materials.push_back(materialJson(material));
  for (const GlbTexture& texture : scene.textures) {
    const size_t view = buffer.addView(storedPng(texture), 0);
    textures.push_back({{"sampler", 0}, {"source", images.size()}});
    images.push_back({{"name", texture.name}, {"bufferView", view}, {"mimeType", "image/png"}});
  }
  Json nodes = Json::array();
  for (const GlbNode& node : scene.nodes) nodes.push_back(nodeJson(node));
  Json roots = scene.roots;
  roots.push_back(nodes.size());
  nodes.push_back(cameraNodeJson(scene.camera));
  pad(buffer.bytes, 0);

  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "obscura-scene"}};
  const auto isBright = [](const Json& m) { return m.contains("extensions"); };
  if (std::any_of(materials.begin(), materials.end(), isBright)) json["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"nodes", roots}}});
  json["nodes"] = nodes;
  json["cameras"] = Json::array({{{"name", scene.camera.name},
                                  {"type", "perspective"},
                                  {"perspective",
                                   {{"yfov", scene.camera.yFov},
                                    {"aspectRatio", scene.camera.aspect},
                                    {"znear", scene.camera.zNear},
                                    {"zfar", scene.camera.zFar}}}}});
  for (const GlbLight& light : scene.lights) json["extensions"]["KHR_lights_punctual"]["lights"].push_back(lightJson(light));
  if (!scene.lights.empty()) json["extensionsUsed"] = {"KHR_lights_punctual"};
  json["meshes"] = meshes;
  json["materials"] = materials;
  if (!images.empty()) {
    json["textures"] = textures;
    json["images"] = images;
    json["samplers"] = Json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
  }
  json["accessors"] = buffer.accessors;
  json["bufferViews"] = buffer.views;
  json["buffers"] = Json::array({{{"byteLength", buffer.bytes.size()}}});
  const std::string text = json.dump();
  Bytes jsonChunk(text.begin(), text.end());
  pad(jsonChunk, ' ');

  Bytes out = {'g', 'l', 'T', 'F'};
  putLittle(out, 2);
  putLittle(out, uint32_t(12 + 8 + jsonChunk.size() + 8 + buffer.bytes.size()));
  putLittle(out, uint32_t(jsonChunk.size()));
  out.insert(out.end(), {'J', 'S', 'O', 'N'});
  out.insert(out.end(), jsonChunk.begin(), jsonChunk.end());
  putLittle(out, uint32_t(buffer.bytes.size()));
  out.insert(out.end(), {'B', 'I', 'N', '\0'});
  out.insert(out.end(), buffer.bytes.begin(), buffer.bytes.end());
  return out;
}

}  // namespace obscura::apps
