#include "obscura/engine/environment.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "obscura/engine/environment_map.h"
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
  const EnvironmentMap cube = convertEnvironment(map, {EnvironmentProjection::Cube, n, n}, parallel);
  out.cubes = parts == EnvironmentParts::Reflections ? prefiltered(cube, parallel) : mirrorOf(cube);
  return out;
}

Result<Environment> readEnvironment(const std::string& path, EnvironmentProjection projection, EnvironmentParts parts, int threads) try {
  const raster::FloatEnvironment environment;
  raster::Parallel parallel(threads);
  const Result<EnvironmentFile> file = readEnvironmentMap(path, projection, parallel);
  if (!file) return file.error();
  Environment out = environmentOf(file->map, parts, parallel);
  if (file->clamped > 0) out.warnings.push_back(path + ": " + std::to_string(file->clamped) + " values are negative, no numbers or too large: clamped");
  return out;
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::BadInput, "out of memory", path, ""};
}

}  // namespace obscura::engine
