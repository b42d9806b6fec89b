#include "obscura/engine/environment.h"

#include <new>

#include "obscura/engine/environment_map.h"
#include "obscura/raster/float_environment.h"

namespace obscura::engine {

Result<Environment> readEnvironment(const std::string& path, EnvironmentProjection projection, int threads) try {
  const raster::FloatEnvironment environment;
  raster::Parallel parallel(threads);
  const Result<EnvironmentFile> file = readEnvironmentMap(path, projection, parallel);
  if (!file) return file.error();
  Environment out;
  out.harmonics = harmonicsOf(file->map, parallel);
  if (file->clamped > 0) out.warnings.push_back(path + ": " + std::to_string(file->clamped) + " values are negative, no numbers or too large: clamped");
  return out;
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::BadInput, "out of memory", path, ""};
}

}  // namespace obscura::engine
