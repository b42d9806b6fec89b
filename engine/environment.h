// In:  an environment map's file.
// Out: what frames are lit by, its diffuse light, and what is seen behind the scene.
#pragma once

#include <string>
#include <vector>

#include "obscura/engine/environment_projection.h"
#include "obscura/engine/irradiance.h"
#include "obscura/engine/result.h"

namespace obscura::engine {

constexpr double kMostIntensity = 1e6, kMostRotation = 1e6;

struct Environment {
  Harmonics harmonics{};
  EnvironmentMap cube;                // to look into; without texels unless asked for
  std::vector<std::string> warnings;  // one line each
};

// The cube has texels of about the map's size in the middle of its faces, at most 4096 a side. threads: 0: one per core;
// changes no bit. BadInput: no such map.
Result<Environment> readEnvironment(const std::string& path, EnvironmentProjection projection, bool cube, int threads);

}  // namespace obscura::engine
