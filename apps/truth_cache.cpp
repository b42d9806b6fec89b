#include "obscura/apps/truth_cache.h"

#include <cstring>
#include <type_traits>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "obscura/engine/content_cache.h"

namespace obscura::apps {
namespace {

constexpr char kVersion[] = "obscura truth 4";  // counts up when the method's values change

class Hash {
 public:
  Hash() { XXH3_128bits_reset(&state_); }
  void add(const void* bytes, size_t size) { XXH3_128bits_update(&state_, bytes, size); }
  template <class T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "no padding");
    add(&value, sizeof value);
  }
  template <class T>
  void addAll(raster::Span<const T> values) {
    add(uint64_t(values.size()));
    add(values.data(), values.size() * sizeof(T));
  }
  template <class T>
  void addAll(const std::vector<T>& values) {
    addAll(raster::Span<const T>(values));
  }
  template <class T>
  void add(const raster::Plane<T>& plane) {
    for (int y = 0; y < plane.height(); ++y) add(plane.row(y), size_t(plane.width()) * sizeof(T));
  }
  std::string text() const {
    XXH128_canonical_t bytes;
    XXH128_canonicalFromHash(&bytes, XXH3_128bits_digest(&state_));
    std::string hex;
    for (const unsigned char b : bytes.digest) hex += {"0123456789abcdef"[b >> 4], "0123456789abcdef"[b & 15]};
    return hex;
  }

 private:
  XXH3_state_t state_;
};

void addMaterial(Hash& hash, const raster::Material& m) {
  hash.add(&m.baseColor, sizeof m.baseColor);
  hash.add(m.alphaCutoff);
  hash.add(m.alphaMode);
  hash.add(m.unlit);
  hash.add(m.baseColorMap.texture);
  hash.add(m.baseColorMap.uvSet);
  hash.add(m.baseColorMap.uvFromUv.data(), sizeof m.baseColorMap.uvFromUv);
}

void addTexture(Hash& hash, const raster::TextureView& t) {
  hash.add(t.width);
  hash.add(t.height);
  hash.add(t.srgb);
  hash.add(t.wrapU);
  hash.add(t.wrapV);
  hash.add(t.magFilter);
  hash.add(t.texels.data(), size_t(t.width) * size_t(t.height) * 4);  // the level that rays read
}

std::vector<uint8_t> payloadOf(const Truth& t) {
  std::vector<uint8_t> bytes;
  for (const auto* planes : {&t.value, &t.error})
    for (const raster::Plane<float>& plane : *planes)
      for (int y = 0; y < plane.height(); ++y) {
        const auto* row = reinterpret_cast<const uint8_t*>(plane.row(y));
        bytes.insert(bytes.end(), row, row + size_t(plane.width()) * sizeof(float));
      }
  return bytes;
}

std::string titleOf(const std::string& key, int width, int height) {
  return std::string(kVersion) + "\n" + key + "\n" + std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

std::string truthKey(const engine::Scene& scene, const RaySurface& surface, const engine::FrameSettings& f,
                     const engine::Frame& frame, const TruthSettings& s) {
  Hash hash;
  hash.add(kVersion, sizeof kVersion);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const engine::Mesh& m = scene.meshes[scene.instances[i].mesh];
    hash.addAll(surface.positions(i));  // camera space: they hold the instance's and the camera's place
    const glm::dmat4& at = scene.instances[i].worldFromObject;
    hash.add(&at, sizeof at);
    hash.addAll(m.indices);
    hash.addAll(m.normals);
    hash.addAll(m.colors);
    for (const auto& uvs : m.uvs) hash.addAll(uvs);
    hash.add(m.material);
  }
  for (const raster::Material& m : scene.materials) addMaterial(hash, m);
  for (const engine::Texture& t : scene.textures) addTexture(hash, t.view);
  const raster::Camera& c = f.camera;
  hash.add(&c.viewFromWorld, sizeof c.viewFromWorld);
  hash.add(c.projection);
  for (const float v : {c.xScale, c.yScale, c.xShift, c.yShift, c.zNear, c.zFar}) hash.add(v);
  for (const int v : {frame.width, frame.height, frame.x, frame.y, frame.imageWidth, frame.imageHeight}) hash.add(v);
  hash.add(frame.g.depth);
  hash.add(frame.g.triangle);
  for (int k = 0; k < 3; ++k) hash.add(frame.g.normal[k]), hash.add(frame.g.albedo[k]);
  hash.add(s.radius);
  hash.add(s.membership);
  hash.add(s.rays);
  return hash.text();
}

std::string environmentTruthKey(const std::string& truthKey, const engine::EnvironmentMap& map, const engine::FrameSettings& f) {
  constexpr char kMethod[] = "environment 1";  // counts up when these values change
  Hash hash;
  hash.add(kMethod, sizeof kMethod);
  hash.add(truthKey.data(), truthKey.size());
  const engine::EnvironmentProjector& p = map.projector();
  hash.add(p.projection);
  for (const int v : {p.width, p.height}) hash.add(v);
  hash.addAll(map.texels());
  for (const double v : {f.environmentRotation, f.environmentIntensity}) hash.add(v);
  return hash.text();
}

std::string truthFile(const std::string& folder, const std::string& key) { return folder + "/truth-" + key + ".bin"; }

std::optional<Truth> loadTruth(const std::string& file, const std::string& key, int width, int height,
                               int quantities) {
  const size_t size = size_t(width) * size_t(height) * 4 * 2 * size_t(quantities);
  const std::optional<engine::LargeVector<uint8_t>> bytes = engine::loadCached(file, titleOf(key, width, height), size);
  if (!bytes || bytes->size() != size) return std::nullopt;
  Truth t(width, height, quantities);
  const uint8_t* from = bytes->data();
  for (auto* planes : {&t.value, &t.error})
    for (raster::Plane<float>& plane : *planes)
      for (int y = 0; y < height; ++y, from += size_t(width) * 4) std::memcpy(plane.row(y), from, size_t(width) * 4);
  return t;
}

engine::Result<engine::Done> storeTruth(const std::string& file, const std::string& key, const Truth& truth) {
  return engine::storeCached(file, titleOf(key, truth.value[0].width(), truth.value[0].height()), payloadOf(truth));
}

}  // namespace obscura::apps
