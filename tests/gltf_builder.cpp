#include "obscura/tests/gltf_builder.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace obscura::tests {
namespace {

void append32(std::vector<uint8_t>& out, uint32_t value, bool bigEndian = false) {
  for (int k = 0; k < 4; ++k) out.push_back(uint8_t(value >> (8 * (bigEndian ? 3 - k : k))));
}

uint32_t crc32(const uint8_t* data, size_t size) {
  uint32_t crc = 0xFFFFFFFF;
  for (size_t i = 0; i < size; ++i) {
    crc ^= data[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

void appendPngChunk(std::vector<uint8_t>& png, const char* type, const std::vector<uint8_t>& content) {
  append32(png, uint32_t(content.size()), true);
  const size_t start = png.size();
  for (int k = 0; k < 4; ++k) png.push_back(uint8_t(type[k]));
  png.insert(png.end(), content.begin(), content.end());
  append32(png, crc32(&png[start], png.size() - start), true);
}

// zlib's format with stored blocks only.
std::vector<uint8_t> stored(const std::vector<uint8_t>& raw) {
  constexpr size_t kBlock = 65535;
  std::vector<uint8_t> out = {0x78, 0x01};
  uint32_t a = 1, b = 0;
  for (size_t i = 0; i < raw.size(); i += kBlock) {
    const size_t n = std::min(kBlock, raw.size() - i);
    out.push_back(i + n == raw.size());
    for (uint32_t v : {uint32_t(n), ~uint32_t(n)}) {
      out.push_back(uint8_t(v));
      out.push_back(uint8_t(v >> 8));
    }
    out.insert(out.end(), raw.begin() + std::ptrdiff_t(i), raw.begin() + std::ptrdiff_t(i + n));
  }
  for (uint8_t c : raw) {
    a = (a + c) % 65521;
    b = (b + a) % 65521;
  }
  append32(out, b << 16 | a, true);
  return out;
}

void appendGlbChunk(std::vector<uint8_t>& glb, uint32_t type, std::vector<uint8_t> content, uint8_t padding) {
  while (content.size() % 4 != 0) content.push_back(padding);
  append32(glb, uint32_t(content.size()));
  append32(glb, type);
  glb.insert(glb.end(), content.begin(), content.end());
}

}  // namespace

void writeBytes(const std::string& path, const std::vector<uint8_t>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  if (!out) throw std::runtime_error("cannot write " + path);
}

std::string dataUri(const std::vector<uint8_t>& bytes) {
  constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string s = "data:application/octet-stream;base64,";
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < n ? bytes[i + k] : 0);
    for (size_t k = 0; k < 4; ++k) s += k <= n ? kAlphabet[bits >> (18 - 6 * k) & 63] : '=';
  }
  return s;
}

std::vector<uint8_t> pngOf(const std::vector<uint32_t>& texels, int width, int height) {
  std::vector<uint8_t> raw, header;
  for (int y = 0; y < height; ++y) {
    raw.push_back(0);  // no row filter
    for (int x = 0; x < width; ++x) append32(raw, texels[size_t(y) * size_t(width) + size_t(x)]);
  }
  append32(header, uint32_t(width), true);
  append32(header, uint32_t(height), true);
  for (int v : {8, 6, 0, 0, 0}) header.push_back(uint8_t(v));  // 8 bits, RGBA, no interlace
  std::vector<uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  appendPngChunk(png, "IHDR", header);
  appendPngChunk(png, "IDAT", stored(raw));
  appendPngChunk(png, "IEND", {});
  return png;
}

GltfBuilder::GltfBuilder() {
  json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", Json::array({{{"nodes", Json::array()}}})}};
}

int GltfBuilder::add(const char* array, Json item) {
  json[array].push_back(std::move(item));
  return int(json[array].size()) - 1;
}

int GltfBuilder::addViewBytes(const std::vector<uint8_t>& bytes, int byteStride) {
  while (binary.size() % 4 != 0) binary.push_back(0);
  Json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (byteStride != 0) view["byteStride"] = byteStride;
  binary.insert(binary.end(), bytes.begin(), bytes.end());
  return add("bufferViews", std::move(view));
}

int GltfBuilder::addAccessorOf(int view, size_t count, ComponentType componentType, const char* type,
                               bool normalized) {
  Json accessor = {{"bufferView", view}, {"componentType", int(componentType)}, {"count", count}, {"type", type}};
  if (normalized) accessor["normalized"] = true;
  return add("accessors", std::move(accessor));
}

int GltfBuilder::addNode(Json node) {
  const int index = add("nodes", std::move(node));
  json["scenes"][0]["nodes"].push_back(index);
  return index;
}

int GltfBuilder::addTexture(const std::vector<uint8_t>& imageFile, Json sampler) {
  Json texture = {{"source", add("images", {{"bufferView", addView(imageFile)}, {"mimeType", "image/png"}})}};
  if (!sampler.is_null()) texture["sampler"] = add("samplers", std::move(sampler));
  return add("textures", std::move(texture));
}

int GltfBuilder::addTriangle(const Json& primitive) {
  Json p = {{"attributes", {{"POSITION", addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}}}};
  p.merge_patch(primitive);
  return addNode({{"mesh", addMesh(std::move(p))}});
}

GltfBuilder::Json GltfBuilder::whole(const Json& buffer) const {
  Json all = json;
  if (!all.contains("buffers") && !binary.empty()) all["buffers"] = Json::array({buffer});
  return all;
}

std::vector<uint8_t> GltfBuilder::glb() const {
  const std::string text = whole({{"byteLength", binary.size()}}).dump();
  std::vector<uint8_t> glb = {'g', 'l', 'T', 'F', 2, 0, 0, 0, 0, 0, 0, 0};
  appendGlbChunk(glb, 0x4E4F534A, {text.begin(), text.end()}, ' ');
  if (!binary.empty()) appendGlbChunk(glb, 0x004E4942, binary, 0);
  for (int k = 0; k < 4; ++k) glb[size_t(8 + k)] = uint8_t(glb.size() >> (8 * k));
  return glb;
}

std::string GltfBuilder::gltf(const std::string& bufferUri) const {
  return whole({{"byteLength", binary.size()}, {"uri", bufferUri}}).dump();
}

std::string GltfBuilder::writeGlb(const TemporaryFolder& folder, const std::string& name) const {
  writeBytes(folder / name, glb());
  return folder / name;
}

std::string GltfBuilder::writeGltf(const TemporaryFolder& folder, const std::string& name) const {
  const std::string text = gltf(dataUri(binary));
  writeBytes(folder / name, {text.begin(), text.end()});
  return folder / name;
}

size_t GltfBuilder::componentsOf(const std::string& type) {
  if (type == "SCALAR") return 1;
  const size_t side = size_t(type.back() - '0');
  return type[0] == 'V' ? side : side * side;
}

}  // namespace obscura::tests
