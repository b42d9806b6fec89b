// In:  an environment map's file.
// Out: what frames are lit by: its diffuse light.
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
  std::vector<std::string> warnings;  // one line each
};

// threads: 0: one per core; changes no bit. BadInput: no such map.
Result<Environment> readEnvironment(const std::string& path, EnvironmentProjection projection, int threads);

}  // namespace obscura::engine
