// In:  an environment map's file.
// Out: what frames are lit by: its diffuse light, what is reflected, and what is seen behind the scene.
#pragma once

#include <string>

#include "obscura/engine/environment_projection.h"
#include "obscura/engine/irradiance.h"
#include "obscura/engine/prefiltered_environment.h"
#include "obscura/engine/result.h"

namespace obscura::engine {

constexpr double kMostIntensity = 1e6, kMostRotation = 1e6;

// Each with what is before it.
enum class EnvironmentParts : uint8_t { Light, Background, Reflections };

struct Environment {
  Harmonics harmonics{};
  PrefilteredEnvironment cubes;       // nothing, the mirror for the background, or all that reflections need
  size_t clamped = 0;                 // values of the map that could not be taken as they are, see EnvironmentFile
};

// The mirror has texels of about the map's size in the middle of its faces, at most 4096 a side. Throws std::bad_alloc.
Environment environmentOf(const EnvironmentMap& map, EnvironmentParts parts, raster::Parallel& parallel);

// That of a map in a file. threads: 0: one per core; changes no bit. cacheFolder: where it is kept for the next time, and
// taken from if it is there (content_cache.h); empty: nowhere. A folder that cannot be written to is no error. BadInput: no such map.
Result<Environment> readEnvironment(const std::string& path, EnvironmentProjection projection, EnvironmentParts parts, int threads,
                                    const std::string& cacheFolder = {});

}  // namespace obscura::engine
