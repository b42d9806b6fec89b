#include "obscura/engine/gltf_schema.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace obscura::engine::gltf {
namespace {

using Json = nlohmann::json;

enum class Kind {
  Index,       // an integer in [0, 2^31)
  Size,        // an integer in [0, 2^53]
  Number, String, Boolean,
  Numbers,     // `count` numbers
  Indices,     // any number of indices
  Strings,
  IndexMap,    // name -> index
  Object,      // as `child` says
  Objects,     // an array of them
  Extensions,  // an object of objects; those that `child` does not name are ignored
  Targets,     // morph targets: only their number is kept
  Extras,      // as `child` says if it is an object; anything else is ignored, as it can be of anybody
};

struct Field;
struct Schema {
  const Field* fields;
  size_t count;
  template <size_t N>
  constexpr Schema(const Field (&f)[N]) : fields(f), count(N) {}
  constexpr Schema() : fields(nullptr), count(0) {}
  const Field* begin() const;
  const Field* end() const;
};

constexpr bool kRequired = true, kOptional = false;

struct Field {
  const char* name;
  Kind kind;
  bool required = kOptional;
  size_t count = 0;
  Schema child = {};
};

const Field* Schema::begin() const { return fields; }
const Field* Schema::end() const { return fields + count; }

constexpr Field optional(const char* name, Kind kind) { return {name, kind, kOptional, 0, {}}; }
constexpr Field required(const char* name, Kind kind) { return {name, kind, kRequired, 0, {}}; }
constexpr Field numbers(const char* name, size_t count) { return {name, Kind::Numbers, kOptional, count, {}}; }
constexpr Field object(const char* name, Schema child) { return {name, Kind::Object, kOptional, 0, child}; }
constexpr Field objects(const char* name, Schema child) { return {name, Kind::Objects, kOptional, 0, child}; }
constexpr Field extras(Schema child) { return {"extras", Kind::Extras, kOptional, 0, child}; }
constexpr Field extensions(Schema child) { return {"extensions", Kind::Extensions, kOptional, 0, child}; }

// glTF 2.0, appendix A, and the schemas of the extensions: what of it the loader uses.
constexpr Field kTextureTransform[] = {numbers("offset", 2), optional("rotation", Kind::Number), numbers("scale", 2),
                                       optional("texCoord", Kind::Index)};
constexpr Field kTextureExtensions[] = {object("KHR_texture_transform", kTextureTransform)};
constexpr Field kTextureInfo[] = {required("index", Kind::Index), optional("texCoord", Kind::Index),
                                  optional("scale", Kind::Number), extensions(kTextureExtensions)};
constexpr Field kMetallicRoughness[] = {
    numbers("baseColorFactor", 4), object("baseColorTexture", kTextureInfo), optional("metallicFactor", Kind::Number),
    optional("roughnessFactor", Kind::Number), object("metallicRoughnessTexture", kTextureInfo)};
constexpr Field kEmissiveStrength[] = {optional("emissiveStrength", Kind::Number)};
constexpr Field kHeight[] = {required("index", Kind::Index), optional("texCoord", Kind::Index), required("scale", Kind::Number),
                             extensions(kTextureExtensions)};
constexpr Field kMaterialExtras[] = {object("obscura_height", kHeight)};
constexpr Field kMaterialExtensions[] = {object("KHR_materials_unlit", {}),
                                         object("KHR_materials_emissive_strength", kEmissiveStrength)};
constexpr Field kMaterial[] = {
    optional("name", Kind::String), object("pbrMetallicRoughness", kMetallicRoughness),
    object("normalTexture", kTextureInfo), object("emissiveTexture", kTextureInfo), numbers("emissiveFactor", 3),
    optional("alphaMode", Kind::String), optional("alphaCutoff", Kind::Number),
    optional("doubleSided", Kind::Boolean), extensions(kMaterialExtensions), extras(kMaterialExtras)};

constexpr Field kSparseIndices[] = {required("bufferView", Kind::Index), optional("byteOffset", Kind::Index),
                                    required("componentType", Kind::Index)};
constexpr Field kSparseValues[] = {required("bufferView", Kind::Index), optional("byteOffset", Kind::Index)};
constexpr Field kSparse[] = {required("count", Kind::Index),
                             {"indices", Kind::Object, kRequired, 0, kSparseIndices},
                             {"values", Kind::Object, kRequired, 0, kSparseValues}};
constexpr Field kAccessor[] = {
    optional("bufferView", Kind::Index), optional("byteOffset", Kind::Size), required("componentType", Kind::Index),
    optional("normalized", Kind::Boolean), required("count", Kind::Size), required("type", Kind::String),
    object("sparse", kSparse)};
constexpr Field kBuffer[] = {optional("uri", Kind::String), required("byteLength", Kind::Size)};
constexpr Field kBufferView[] = {required("buffer", Kind::Index), optional("byteOffset", Kind::Size),
                                 required("byteLength", Kind::Size), optional("byteStride", Kind::Index)};
constexpr Field kPrimitive[] = {required("attributes", Kind::IndexMap), optional("indices", Kind::Index),
                                optional("material", Kind::Index), optional("mode", Kind::Index),
                                optional("targets", Kind::Targets), extensions({})};
constexpr Field kMesh[] = {optional("name", Kind::String),
                           {"primitives", Kind::Objects, kRequired, 0, kPrimitive},
                           extensions({})};
constexpr Field kInstancing[] = {required("attributes", Kind::IndexMap)};
constexpr Field kNodeLight[] = {required("light", Kind::Index)};
constexpr Field kNodeExtensions[] = {object("EXT_mesh_gpu_instancing", kInstancing), object("KHR_lights_punctual", kNodeLight)};
// The loader's own, in the extras of a node (and above, of a material); which members a type needs is for whoever reads it.
constexpr Field kBall[] = {numbers("center", 3), required("radius", Kind::Number)};
constexpr Field kImplicit[] = {
    required("type", Kind::String), optional("material", Kind::Index), optional("radius", Kind::Number), optional("tube", Kind::Number),
    numbers("size", 3), optional("period", Kind::Number), optional("thickness", Kind::Number), objects("balls", kBall)};
constexpr Field kNodeExtras[] = {numbers("obscura_ambient", 3), object("obscura_implicit", kImplicit)};
constexpr Field kNode[] = {
    optional("name", Kind::String), optional("mesh", Kind::Index), optional("camera", Kind::Index),
    optional("skin", Kind::Index), optional("children", Kind::Indices), numbers("matrix", 16),
    numbers("translation", 3), numbers("rotation", 4), numbers("scale", 3), extensions(kNodeExtensions),
    extras(kNodeExtras)};
constexpr Field kScene[] = {optional("name", Kind::String), optional("nodes", Kind::Indices), extensions({})};
constexpr Field kPerspective[] = {required("yfov", Kind::Number), required("znear", Kind::Number),
                                  optional("zfar", Kind::Number), optional("aspectRatio", Kind::Number)};
constexpr Field kOrthographic[] = {required("xmag", Kind::Number), required("ymag", Kind::Number),
                                   required("zfar", Kind::Number), required("znear", Kind::Number)};
constexpr Field kCamera[] = {optional("name", Kind::String), required("type", Kind::String),
                             object("perspective", kPerspective), object("orthographic", kOrthographic)};
constexpr Field kImage[] = {optional("name", Kind::String), optional("uri", Kind::String),
                            optional("bufferView", Kind::Index)};
constexpr Field kSampler[] = {optional("magFilter", Kind::Index), optional("minFilter", Kind::Index),
                              optional("wrapS", Kind::Index), optional("wrapT", Kind::Index)};
constexpr Field kTexture[] = {optional("sampler", Kind::Index), optional("source", Kind::Index), extensions({})};
constexpr Field kAsset[] = {required("version", Kind::String)};
constexpr Field kSpot[] = {optional("innerConeAngle", Kind::Number), optional("outerConeAngle", Kind::Number)};
constexpr Field kLight[] = {optional("name", Kind::String), required("type", Kind::String), numbers("color", 3),
                            optional("intensity", Kind::Number), optional("range", Kind::Number), object("spot", kSpot)};
constexpr Field kLights[] = {{"lights", Kind::Objects, kRequired, 0, kLight}};
constexpr Field kRootExtensions[] = {object("KHR_lights_punctual", kLights)};
constexpr Field kRoot[] = {
    {"asset", Kind::Object, kRequired, 0, kAsset},
    optional("extensionsUsed", Kind::Strings), optional("extensionsRequired", Kind::Strings),
    optional("scene", Kind::Index), objects("scenes", kScene), objects("nodes", kNode), objects("meshes", kMesh),
    objects("accessors", kAccessor), objects("bufferViews", kBufferView), objects("buffers", kBuffer),
    objects("materials", kMaterial), objects("textures", kTexture), objects("images", kImage),
    objects("samplers", kSampler), objects("cameras", kCamera), extensions(kRootExtensions)};

// A JSON pointer under construction; text is made only for a message.
struct Path {
  const Path* parent = nullptr;
  const char* key = nullptr;  // or an element's number
  size_t index = 0;
  std::string text() const {
    if (!parent) return {};
    return parent->text() + "/" + (key ? std::string(key) : std::to_string(index));
  }
};

bool isInteger(const Json& j, uint64_t most) { return j.is_number_unsigned() && j.get<uint64_t>() <= most; }

constexpr uint64_t kMostIndex = 0x7FFFFFFF, kMostSize = 1ull << 53;

class Checker {
 public:
  explicit Checker(std::set<std::string>& ignored) : ignored_(ignored) {}

  void checkObject(Json& o, const Schema& schema, const Path& path) {
    if (!o.is_object()) fail(path.text(), "not an object");
    for (auto it = o.begin(); it != o.end();) {
      const auto field = std::find_if(schema.begin(), schema.end(), [&](const Field& f) { return it.key() == f.name; });
      if (field == schema.end()) {
        it = o.erase(it);
        continue;
      }
      check(it.value(), *field, {&path, field->name});
      ++it;
    }
    for (const Field& f : schema)
      if (f.required && !o.contains(f.name)) fail(path.text(), std::string(f.name) + " is missing");
  }

 private:
  void check(Json& j, const Field& f, const Path& path) {
    switch (f.kind) {
      case Kind::Index:
        if (!isInteger(j, kMostIndex)) fail(path.text(), "not an integer from 0 to 2^31 - 1");
        return;
      case Kind::Size:
        if (!isInteger(j, kMostSize)) fail(path.text(), "not an integer from 0 to 2^53");
        return;
      case Kind::Number: return require(j.is_number(), path, "not a number");
      case Kind::String: return require(j.is_string(), path, "not a string");
      case Kind::Boolean: return require(j.is_boolean(), path, "not true or false");
      case Kind::Numbers:
        if (!j.is_array() || j.size() != f.count) fail(path.text(), "not " + std::to_string(f.count) + " numbers");
        return each(j, path, [&](Json& e, const Path& p) { require(e.is_number(), p, "not a number"); });
      case Kind::Indices:
        return each(j, path, [&](Json& e, const Path& p) { check(e, optional("", Kind::Index), p); });
      case Kind::Strings:
        return each(j, path, [&](Json& e, const Path& p) { require(e.is_string(), p, "not a string"); });
      case Kind::IndexMap:
        require(j.is_object(), path, "not an object");
        for (auto it = j.begin(); it != j.end(); ++it)
          check(it.value(), optional("", Kind::Index), {&path, it.key().c_str()});
        return;
      case Kind::Object: return checkObject(j, f.child, path);
      case Kind::Objects: return each(j, path, [&](Json& e, const Path& p) { checkObject(e, f.child, p); });
      case Kind::Extensions:
        require(j.is_object(), path, "not an object");
        for (auto it = j.begin(); it != j.end(); ++it) {
          const bool known = std::any_of(f.child.begin(), f.child.end(), [&](auto& c) { return it.key() == c.name; });
          if (!known) ignored_.insert(it.key());
        }
        return checkObject(j, f.child, path);
      case Kind::Extras:
        if (j.is_object()) checkObject(j, f.child, path);
        else j = Json::object();
        return;
      case Kind::Targets:
        return each(j, path, [&](Json& e, const Path&) { e = Json::object(); });
    }
  }

  static void require(bool holds, const Path& path, const char* otherwise) {
    if (!holds) fail(path.text(), otherwise);
  }
  template <class Body>
  static void each(Json& array, const Path& path, Body body) {
    require(array.is_array(), path, "not an array");
    size_t index = 0;
    for (Json& e : array) body(e, Path{&path, nullptr, index++});
  }

  std::set<std::string>& ignored_;
};

// nlohmann's parser does not recurse, but whatever walks the tree does: glTF itself needs no more than ten levels.
void checkDepth(Bytes text) {
  constexpr int kDeepest = 256;
  int depth = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const uint8_t c = text[i];
    if (c == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\';
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest) fail("", "JSON nested deeper than " + std::to_string(kDeepest) + " levels");
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

}  // namespace

CheckedJson checkedJson(Bytes text) {
  checkDepth(text);
  CheckedJson result;
  try {
    result.root = Json::parse(text.begin(), text.end());
  } catch (const Json::exception& e) {
    const char* reason = std::strstr(e.what(), "] ");  // after "[json.exception.parse_error.101] "
    fail("", "bad JSON: " + std::string(reason ? reason + 2 : e.what()));
  }
  Checker(result.ignoredExtensions).checkObject(result.root, kRoot, {});
  return result;
}

}  // namespace obscura::engine::gltf
