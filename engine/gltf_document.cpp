#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS

#include <fstream>  // missing in tiny_gltf.h under TINYGLTF_NO_FS

#include "obscura/engine/gltf_schema.h"  // before tinygltf, which would hide nlohmann's symbols

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "obscura/engine/gltf_document.h"
#pragma GCC diagnostic pop

#include <algorithm>

namespace obscura::engine::gltf {
namespace {

using Json = nlohmann::json;
using namespace nlohmann::literals;

constexpr const char* kSupportedExtensions[] = {
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_unlit",
    "KHR_mesh_quantization",   "KHR_texture_transform"};

bool isSupported(const std::string& extension) {
  return std::find(std::begin(kSupportedExtensions), std::end(kSupportedExtensions), extension) !=
         std::end(kSupportedExtensions);
}

// tinygltf would read every source whether it is used or not, slowly and (images in bufferViews) without looking at
// sizes. So the sources never reach it.
std::vector<Source> takeSources(Json& root, const char* key) {
  std::vector<Source> sources;
  const auto array = root.find(key);
  if (array == root.end()) return sources;
  for (Json& o : *array) {
    Source source;
    if (const auto uri = o.find("uri"); uri != o.end()) {
      source.hasUri = true;
      source.uri = std::move(uri->get_ref<std::string&>());
    }
    source.bufferView = o.value("bufferView", -1);
    source.byteLength = o.value("byteLength", uint64_t(0));
    source.name = o.value("name", std::string());
    sources.push_back(std::move(source));
  }
  root.erase(array);
  return sources;
}

// tinygltf refuses an index accessor without a bufferView, which is legal: its indices are zeros, or sparse. Such
// accessors get a bufferView that does not exist otherwise; the list says which to undo.
std::vector<size_t> lendBufferViews(Json& root) {
  std::vector<size_t> lent;
  const auto accessors = root.find("accessors");
  if (accessors == root.end()) return lent;
  Json& views = root["bufferViews"];
  for (size_t i = 0; i < accessors->size(); ++i) {
    Json& accessor = (*accessors)[i];
    if (accessor.contains("bufferView")) continue;
    accessor["bufferView"] = views.size();
    lent.push_back(i);
  }
  if (!lent.empty()) views.push_back({{"buffer", 0}, {"byteLength", 1}});
  return lent;
}

// What tinygltf refuses too, but without saying where it is.
void checkEnumerations(const Json& root) {
  constexpr int kComponentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
  constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  const auto check = [](const Json& o, const std::string& path, const char* member, const auto& allowed) {
    const Json& value = o[member];
    if (std::find(std::begin(allowed), std::end(allowed), value) == std::end(allowed))
      fail(path + "/" + member, value.dump(-1, ' ', true) + " is not one of glTF's");
  };
  const auto accessors = root.find("accessors");
  for (size_t i = 0; accessors != root.end() && i < accessors->size(); ++i) {
    check((*accessors)[i], pointer("/accessors", i), "componentType", kComponentTypes);
    check((*accessors)[i], pointer("/accessors", i), "type", kTypes);
  }
  const auto cameras = root.find("cameras");
  for (size_t i = 0; cameras != root.end() && i < cameras->size(); ++i) {
    constexpr const char* kProjections[] = {"perspective", "orthographic"};
    const Json& camera = (*cameras)[i];
    check(camera, pointer("/cameras", i), "type", kProjections);
    const std::string type = camera["type"].get<std::string>();
    if (!camera.contains(type)) fail(pointer("/cameras", i), type + " is missing");
  }
  const Json lights = root.value("/extensions/KHR_lights_punctual/lights"_json_pointer, Json::array());
  for (size_t i = 0; i < lights.size(); ++i) {
    constexpr const char* kLights[] = {"directional", "point", "spot"};
    const std::string path = pointer("/extensions/KHR_lights_punctual/lights", i);
    check(lights[i], path, "type", kLights);
    if (lights[i]["type"] == "spot" && !lights[i].contains("spot")) fail(path, "spot is missing");
  }
}

void checkIndexAccessors(const Json& root) {
  const auto array = root.find("accessors");
  const size_t accessors = array == root.end() ? 0 : array->size();
  const auto meshes = root.find("meshes");
  if (meshes == root.end()) return;
  for (size_t m = 0; m < meshes->size(); ++m) {
    const Json& primitives = (*meshes)[m]["primitives"];
    for (size_t k = 0; k < primitives.size(); ++k) {
      const uint64_t index = primitives[k].value("indices", uint64_t(0));
      if (index < std::max<size_t>(accessors, 1)) continue;
      fail(pointer(pointer("/meshes", m) + "/primitives", k) + "/indices",
           "there is no accessor " + std::to_string(index) + ", only " + std::to_string(accessors));
    }
  }
}

void checkStrides(const Json& root) {
  const auto views = root.find("bufferViews");
  if (views == root.end()) return;
  for (size_t i = 0; i < views->size(); ++i) {
    const uint64_t stride = (*views)[i].value("byteStride", uint64_t(4));
    if (stride >= 4 && stride <= 252 && stride % 4 == 0) continue;
    fail(pointer("/bufferViews", i) + "/byteStride", std::to_string(stride) + " is not a multiple of 4 from 4 to 252");
  }
}

std::string firstLine(const std::string& s) { return s.substr(0, s.find('\n')); }

}  // namespace

std::string pointer(const std::string& parent, uint64_t index) { return parent + "/" + std::to_string(index); }
std::string pointer(const std::string& parent, const std::string& key) { return parent + "/" + key; }

Document::Document(Bytes file, const LoadOptions& loadOptions) : options(loadOptions), parts_(splitContainer(file)) {
  parse(parts_.json);
}

Document::Document(const std::string& path, const LoadOptions& loadOptions) : options(loadOptions) {
  const size_t slash = path.find_last_of('/');
  if (slash != std::string::npos) folder_ = path.substr(0, std::max<size_t>(slash, 1));
  file_ = readFile(path, options.limits.fileBytes, "");
  parts_ = splitContainer(file_.view());
  parse(parts_.json);
}

void Document::parse(Bytes text) {
  CheckedJson json = checkedJson(text);
  Json& root = json.root;

  const std::string version = root["asset"]["version"].get<std::string>();
  if (version.compare(0, 2, "2.") != 0) fail("/asset/version", "glTF " + version + " is not supported, only 2.0");
  for (const char* array : {"extensionsRequired", "extensionsUsed"}) {
    const bool isRequired = std::string(array) == "extensionsRequired";
    uint64_t index = 0;
    for (const Json& name : root.value(array, Json::array())) {
      const std::string extension = name.get<std::string>();
      if (!isSupported(extension)) {
        if (isRequired) {
          fail(pointer(pointer("", array), index), "the required extension " + extension + " is not supported");
        }
        json.ignoredExtensions.insert(extension);
      }
      ++index;
    }
  }
  for (const std::string& extension : json.ignoredExtensions)
    warnings.add("the extension " + extension + " is ignored");

  checkStrides(root);
  checkEnumerations(root);
  checkIndexAccessors(root);
  buffers_ = takeSources(root, "buffers");
  images = takeSources(root, "images");
  const std::vector<size_t> lent = lendBufferViews(root);

  tinygltf::TinyGLTF parser;
  std::string error, warning;
  const std::string rest = root.dump();
  if (rest.size() > 0x7FFFFFFF) fail("", "more than 2 GB of JSON");
  if (!parser.LoadASCIIFromString(&model, &error, &warning, rest.data(), unsigned(rest.size()), "")) {
    fail("", "not a glTF document: " + firstLine(error));
  }
  for (size_t i : lent) model.accessors[i].bufferView = -1;
  if (!lent.empty()) model.bufferViews.pop_back();
}

Bytes Document::externalBytes(const Source& source, const std::string& user) {
  const auto known = externals_.find(source.uri);
  if (known != externals_.end()) return known->second.view();
  Blob blob = isDataUri(source.uri)
                  ? decodeDataUri(source.uri, user)
                  : readFile(pathOfUri(folder_, source.uri, user), options.limits.fileBytes, user);
  return externals_.emplace(source.uri, std::move(blob)).first->second.view();
}

Bytes Document::bufferBytes(int index, const std::string& user) {
  const Source& buffer = at(buffers_, index, "buffer", user);
  const std::string path = pointer("/buffers", uint64_t(index));
  Bytes bytes;
  if (buffer.hasUri) {
    bytes = externalBytes(buffer, path);
  } else if (index == 0 && parts_.hasBinary) {
    bytes = parts_.binary;
  } else {
    fail(path, "neither a uri nor a binary chunk holds its bytes");
  }
  if (buffer.byteLength > bytes.size()) {
    fail(path, "byteLength " + std::to_string(buffer.byteLength) + " is more than the " +
                   std::to_string(bytes.size()) + " bytes there are");
  }
  return {bytes.data(), size_t(buffer.byteLength)};
}

Bytes Document::bufferViewBytes(int index, const std::string& user) {
  const tinygltf::BufferView& view = at(model.bufferViews, index, "bufferView", user);
  const std::string path = pointer("/bufferViews", uint64_t(index));
  const Bytes buffer = bufferBytes(view.buffer, path);
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    fail(path, "byteOffset " + std::to_string(view.byteOffset) + " + byteLength " + std::to_string(view.byteLength) +
                   " exceed the " + std::to_string(buffer.size()) + " bytes of buffer " + std::to_string(view.buffer));
  }
  return {buffer.data() + view.byteOffset, view.byteLength};
}

Bytes Document::imageBytes(int index, const std::string& user) {
  const Source& image = at(images, index, "image", user);
  const std::string path = pointer("/images", uint64_t(index));
  if (image.hasUri == (image.bufferView >= 0)) fail(path, "exactly one of uri and bufferView must be there");
  return image.hasUri ? externalBytes(image, path) : bufferViewBytes(image.bufferView, path);
}

void Document::reserveGeometry(uint64_t bytes, const std::string& user) {
  const uint64_t left = options.limits.geometryBytes - std::min(geometryBytes_, options.limits.geometryBytes);
  if (bytes > left) {
    fail(user, "the geometry takes more than the limit of " + std::to_string(options.limits.geometryBytes) + " bytes");
  }
  geometryBytes_ += bytes;
}

void Document::reserveZeroElements(uint64_t count, const std::string& user) {
  const uint64_t left = options.limits.zeroElements - std::min(zeroElements_, options.limits.zeroElements);
  if (count > left) {
    fail(user, std::to_string(count) + " elements without data, where the limit for the file is " +
                   std::to_string(options.limits.zeroElements));
  }
  zeroElements_ += count;
}

}  // namespace obscura::engine::gltf
