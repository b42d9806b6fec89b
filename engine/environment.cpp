#include "obscura/engine/environment.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "obscura/engine/environment_cache.h"
#include "obscura/engine/environment_map.h"
#include "obscura/engine/image_file.h"
#include "obscura/raster/float_environment.h"

namespace obscura::engine {

Environment environmentOf(const EnvironmentMap& map, EnvironmentParts parts, raster::Parallel& parallel) {
  Environment out;
  out.harmonics = harmonicsOf(map, parallel);
  if (parts == EnvironmentParts::Light) return out;
  // A latlong map's texels are 2 pi / width wide in its middle, a cube's 2 / side: side = width / pi, and a fifth more, as
  // both interpolate.
  const double side = 0.53 * std::sqrt(usedTexels(map.projector()));
  const int n = std::min(4096, std::max(1, int(std::ceil(side))));
  EnvironmentMap cube = convertEnvironment(map, {EnvironmentProjection::Cube, n, n}, parallel);
  out.cubes = parts == EnvironmentParts::Reflections ? prefiltered(std::move(cube), parallel) : mirrorOf(std::move(cube));
  return out;
}

Result<Environment> readEnvironment(const std::string& path, EnvironmentProjection projection, EnvironmentParts parts, int threads,
                                    const std::string& cacheFolder) try {
  const raster::FloatEnvironment environment;
  const Result<std::vector<uint8_t>> bytes = readImageBytes(path);
  if (!bytes) return bytes.error();
  std::optional<EnvironmentCache> cache;
  if (!cacheFolder.empty()) cache.emplace(cacheFolder, *bytes, projection, parts);
  if (cache)
    if (std::optional<Environment> kept = cache->load()) return std::move(*kept);
  raster::Parallel parallel(threads);
  const Result<EnvironmentFile> file = decodeEnvironmentMap(*bytes, path, projection, parallel);
  if (!file) return file.error();
  Environment out = environmentOf(file->map, parts, parallel);
  out.clamped = file->clamped;
  if (cache) cache->store(out);
  return out;
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::BadInput, "out of memory", path, ""};
}

}  // namespace obscura::engine
