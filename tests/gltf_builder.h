// Writes small glTF files for tests: valid ones, and ones that are broken on purpose.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "obscura/tests/temporary_folder.h"

namespace obscura::tests {

void writeBytes(const std::string& path, const std::vector<uint8_t>& bytes);
std::string dataUri(const std::vector<uint8_t>& bytes);  // data:application/octet-stream;base64,...
// A PNG of RGBA texels (R in the lowest byte), stored without compression.
std::vector<uint8_t> pngOf(const std::vector<uint32_t>& texels, int width, int height);

enum ComponentType { kByte = 5120, kUByte = 5121, kShort = 5122, kUShort = 5123, kUInt = 5125, kFloat = 5126 };

// `json` is the document without its buffers, open to any change; `binary` is buffer 0. A new builder holds one scene
// without nodes.
class GltfBuilder {
 public:
  using Json = nlohmann::json;
  Json json;
  std::vector<uint8_t> binary;

  GltfBuilder();

  // Each returns the index of what it added; arrays that do not exist yet are made.
  int add(const char* array, Json item);
  template <class T>
  int addView(const std::vector<T>& elements, int byteStride = 0) {
    std::vector<uint8_t> bytes(elements.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), elements.data(), bytes.size());
    return addViewBytes(bytes, byteStride);
  }
  template <class T>
  int addAccessor(const std::vector<T>& components, ComponentType componentType, const char* type,
                  bool normalized = false) {
    const int view = addView(components);
    return addAccessorOf(view, components.size() / componentsOf(type), componentType, type, normalized);
  }
  int addAccessorOf(int view, size_t count, ComponentType componentType, const char* type, bool normalized = false);
  int addFloats(const std::vector<float>& components, const char* type) {
    return addAccessor(components, kFloat, type);
  }
  int addMesh(Json primitive) { return add("meshes", {{"primitives", Json::array({std::move(primitive)})}}); }
  int addNode(Json node);  // a root of scene 0
  int addTexture(const std::vector<uint8_t>& imageFile, Json sampler = nullptr);
  // A node with a mesh of one triangle, (0,0,0) (1,0,0) (0,1,0); `primitive` is merged into its primitive.
  int addTriangle(const Json& primitive = Json::object());

  std::vector<uint8_t> glb() const;
  std::string gltf(const std::string& bufferUri) const;  // the text of a .gltf
  std::string writeGlb(const TemporaryFolder& folder, const std::string& name = "scene.glb") const;  // returns the path
  std::string writeGltf(const TemporaryFolder& folder, const std::string& name = "scene.gltf") const;  // buffer as data URI

  static size_t componentsOf(const std::string& type);  // of "SCALAR", "VEC2", ..., "MAT4"

 private:
  int addViewBytes(const std::vector<uint8_t>& bytes, int byteStride);
  Json whole(const Json& buffer) const;
};

}  // namespace obscura::tests
