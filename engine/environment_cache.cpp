#include "obscura/engine/environment_cache.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "obscura/engine/content_cache.h"

namespace obscura::engine {
namespace {

constexpr char kVersion[] = "obscura environment 1";  // counts up when the method's values change
constexpr int kMostSide = 8192;
constexpr uint64_t kMostBytes = uint64_t(3) << 30;

size_t texelsOf(const std::vector<int>& sides) {
  size_t all = 0;
  for (const int side : sides) all += 6 * size_t(side + 2) * size_t(side + 2);
  return all;
}

// Sequences of plain values.
class Writer {
 public:
  explicit Writer(LargeVector<uint8_t>& to) : to_(to) {}
  void put(const void* values, size_t bytes) {
    const auto* from = static_cast<const uint8_t*>(values);
    to_.insert(to_.end(), from, from + bytes);
  }

 private:
  LargeVector<uint8_t>& to_;
};

class Reader {
 public:
  explicit Reader(const LargeVector<uint8_t>& from) : from_(from) {}
  bool take(void* values, size_t bytes) {
    if (bytes > left()) return false;
    if (bytes > 0) std::memcpy(values, from_.data() + at_, bytes);  // an environment without cubes has no place for texels
    at_ += bytes;
    return true;
  }
  size_t left() const { return from_.size() - at_; }

 private:
  const LargeVector<uint8_t>& from_;
  size_t at_ = 0;
};

bool isSound(const Environment& e) {
  for (const glm::dvec3& l : e.harmonics)
    for (int c = 0; c < 3; ++c)
      if (!(std::fabs(l[c]) < 1e40)) return false;
  const auto in = [](float v) { return v >= 0 && v <= EnvironmentMap::kMostRadiance; };
  return std::all_of(e.cubes.texels.begin(), e.cubes.texels.end(), [&](const glm::vec3& t) { return in(t.x) && in(t.y) && in(t.z); });
}

}  // namespace

EnvironmentCache::EnvironmentCache(const std::string& folder, raster::Span<const uint8_t> map, EnvironmentProjection projection, EnvironmentParts parts)
    : parts_(parts) {
  const std::string key = hashOf(map) + "-" + std::to_string(int(projection)) + std::to_string(int(parts));
  file_ = folder + "/environment-" + key + ".bin";
  title_ = std::string(kVersion) + "\n" + key;
}

std::optional<Environment> EnvironmentCache::load() const {
  const std::optional<LargeVector<uint8_t>> bytes = loadCached(file_, title_, kMostBytes);
  if (!bytes) return std::nullopt;
  Reader from(*bytes);
  Environment e;
  uint64_t clamped = 0;
  e.cubes.sides.resize(parts_ == EnvironmentParts::Light ? 0 : parts_ == EnvironmentParts::Background ? 1 : post::kRoughnessLevels);
  if (!from.take(e.harmonics.data(), sizeof e.harmonics) || !from.take(&clamped, sizeof clamped) ||
      !from.take(e.cubes.sides.data(), e.cubes.sides.size() * sizeof(int)))
    return std::nullopt;
  if (std::any_of(e.cubes.sides.begin(), e.cubes.sides.end(), [](int side) { return side < 1 || side > kMostSide; })) return std::nullopt;
  const size_t texels = texelsOf(e.cubes.sides);
  if (texels >= (size_t(1) << 31) / 3 || from.left() != texels * sizeof(glm::vec3)) return std::nullopt;
  e.clamped = size_t(clamped);
  e.cubes.texels.resize(texels);
  from.take(e.cubes.texels.data(), from.left());
  return isSound(e) ? std::optional(std::move(e)) : std::nullopt;
}

void EnvironmentCache::store(const Environment& made) const {
  LargeVector<uint8_t> bytes;
  bytes.reserve(sizeof made.harmonics + 64 + made.cubes.texels.size() * sizeof(glm::vec3));
  Writer to(bytes);
  const uint64_t clamped = made.clamped;
  to.put(made.harmonics.data(), sizeof made.harmonics);
  to.put(&clamped, sizeof clamped);
  to.put(made.cubes.sides.data(), made.cubes.sides.size() * sizeof(int));
  to.put(made.cubes.texels.data(), made.cubes.texels.size() * sizeof(glm::vec3));
  (void)storeCached(file_, title_, {bytes.data(), bytes.size()});  // what cannot be kept is made again
}

}  // namespace obscura::engine
