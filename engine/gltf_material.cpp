#include "obscura/engine/gltf_material.h"

#include <algorithm>

#include "obscura/raster/exact_math.h"

namespace obscura::engine::gltf {
namespace {

using raster::TextureSlot;

// KHR_texture_transform: translation * rotation * scale. Positive angles turn counter-clockwise as seen with v
// downwards, as in the extension's example, where 90 degrees send (u, 0) to (0, -u).
std::array<float, 6> uvTransform(const tinygltf::Value& extension) {
  const auto number = [&](const char* name, int i, double otherwise) {
    return extension.Has(name) ? extension.Get(name).Get(i).GetNumberAsDouble() : otherwise;
  };
  const double angle = extension.Has("rotation") ? extension.Get("rotation").GetNumberAsDouble() : 0;
  const double s = raster::exactSin(angle), c = raster::exactCos(angle);
  const double scaleU = number("scale", 0, 1), scaleV = number("scale", 1, 1);
  return {float(c * scaleU),  float(s * scaleV), float(number("offset", 0, 0)),
          float(-s * scaleU), float(c * scaleV), float(number("offset", 1, 0))};
}

class MaterialReader {
 public:
  MaterialReader(Document& document, TextureLoader& textures, HeightLoader& heights)
      : document_(document), textures_(textures), heights_(heights) {}

  raster::Material read(const tinygltf::Material& in, const std::string& path, bool isUsed) {
    raster::Material m;
    const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
    const double strength = emissiveStrength(in);
    for (int c = 0; c < 4; ++c) m.baseColor[c] = float(pbr.baseColorFactor[size_t(c)]);
    for (int c = 0; c < 3; ++c) m.emissive[c] = float(std::max(0.0, in.emissiveFactor[size_t(c)] * strength));
    m.metallic = float(std::clamp(pbr.metallicFactor, 0.0, 1.0));
    m.roughness = float(std::clamp(pbr.roughnessFactor, 0.0, 1.0));
    m.normalScale = float(in.normalTexture.scale);
    m.doubleSided = in.doubleSided;
    m.unlit = in.extensions.count("KHR_materials_unlit") != 0;
    readAlpha(in, path, isUsed, m);
    const bool all = document_.options.textures;
    // Where a mask is transparent decides what is seen, so its texture is always needed.
    if (isUsed && (all || m.alphaMode == raster::AlphaMode::Mask))
      m.baseColorMap = readSlot(pbr.baseColorTexture, true, path + "/pbrMetallicRoughness/baseColorTexture");
    if (isUsed && all) readOtherTextures(in, path, m);
    if (isUsed) readHeight(in, path + "/extras/obscura_height", m);
    return m;
  }

  VertexNeeds needs() const { return needs_; }

 private:
  static double emissiveStrength(const tinygltf::Material& in) {
    const auto extension = in.extensions.find("KHR_materials_emissive_strength");
    if (extension == in.extensions.end() || !extension->second.Has("emissiveStrength")) return 1;
    return extension->second.Get("emissiveStrength").GetNumberAsDouble();
  }

  void readAlpha(const tinygltf::Material& in, const std::string& path, bool isUsed, raster::Material& m) {
    if (in.alphaMode == "OPAQUE") return;
    m.alphaMode = raster::AlphaMode::Mask;
    if (in.alphaMode == "MASK") {
      m.alphaCutoff = float(in.alphaCutoff);
    } else if (in.alphaMode == "BLEND") {
      m.alphaCutoff = 0.5f;
      if (isUsed) document_.warnings.add("alphaMode BLEND is drawn as MASK with the cutoff 0.5");
    } else {
      fail(path + "/alphaMode", "neither OPAQUE, MASK nor BLEND");
    }
  }

  void readOtherTextures(const tinygltf::Material& in, const std::string& path, raster::Material& m) {
    m.metallicRoughnessMap = readSlot(in.pbrMetallicRoughness.metallicRoughnessTexture, false,
                                      path + "/pbrMetallicRoughness/metallicRoughnessTexture");
    m.normalMap = readSlot(in.normalTexture, false, path + "/normalTexture");
    m.emissiveMap = readSlot(in.emissiveTexture, true, path + "/emissiveTexture");
    needs_.tangents = m.normalMap.texture >= 0;
  }

  // It decides what is seen where, so it is always needed.
  void readHeight(const tinygltf::Material& in, const std::string& path, raster::Material& m) {
    if (!in.extras.IsObject() || !in.extras.Has("obscura_height")) return;
    const tinygltf::Value& extras = in.extras.Get("obscura_height");
    tinygltf::TextureInfo info;
    info.index = extras.Get("index").GetNumberAsInt();
    if (extras.Has("texCoord")) info.texCoord = extras.Get("texCoord").GetNumberAsInt();
    if (extras.Has("extensions"))
      for (const std::string& name : extras.Get("extensions").Keys()) info.extensions[name] = extras.Get("extensions").Get(name);
    const double scale = extras.Get("scale").GetNumberAsDouble();
    if (!(scale >= 0 && scale <= 1e15)) fail(path + "/scale", "below 0 or above 10^15");
    m.heightScale = float(scale);
    m.heightMap = readSlot(info, [&] { return heights_.request(info.index, path); });
  }

  template <class Info>
  TextureSlot readSlot(const Info& info, bool srgb, const std::string& path) {
    return readSlot(info, [&] { return textures_.request(info.index, srgb, path); });
  }

  // request: gives the texture its number in the scene.
  template <class Info, class Request>
  TextureSlot readSlot(const Info& info, const Request& request) {
    TextureSlot slot;
    if (info.index < 0) return slot;
    int texCoord = info.texCoord;
    const auto extension = info.extensions.find("KHR_texture_transform");
    if (extension != info.extensions.end()) {
      slot.uvFromUv = uvTransform(extension->second);
      if (extension->second.Has("texCoord")) texCoord = extension->second.Get("texCoord").GetNumberAsInt();
    }
    slot.uvSet = uvSetOf(texCoord);
    if (slot.uvSet < 0) {
      document_.warnings.add("of a material's texture coordinate sets only the first two are read");
      return {};
    }
    slot.texture = request();
    return slot;
  }

  // Any two of the file's sets, in the order in which the material names them.
  int uvSetOf(int texCoord) {
    for (int k = 0; k < 2; ++k) {
      if (needs_.uvSource[k] < 0) needs_.uvSource[k] = texCoord;
      if (needs_.uvSource[k] == texCoord) return k;
    }
    return -1;
  }

  Document& document_;
  TextureLoader& textures_;
  HeightLoader& heights_;
  VertexNeeds needs_;
};

}  // namespace

Materials readMaterials(Document& document, const std::vector<bool>& used) {
  Materials result;
  TextureLoader textures(document);
  HeightLoader heights(document);
  const std::vector<tinygltf::Material>& materials = document.model.materials;
  for (size_t i = 0; i < materials.size(); ++i) {
    MaterialReader reader(document, textures, heights);
    result.materials.push_back(reader.read(materials[i], pointer("/materials", i), used[i]));
    result.names.push_back(materials[i].name);
    result.needs.push_back(reader.needs());
  }
  result.materials.emplace_back();
  result.names.emplace_back("default");
  result.needs.emplace_back();
  result.textures = textures.load();
  result.heightMaps = std::move(heights.heightMaps);
  return result;
}

}  // namespace obscura::engine::gltf
