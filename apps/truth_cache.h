// In:  what a truth follows from.
// Out: the same truth again without tracing a ray, from a file.
#pragma once

#include <optional>
#include <string>

#include "obscura/apps/truth.h"
#include "obscura/engine/environment_map.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

// 32 hex digits, XXH3-128, of all that decides the values: the scene's triangles, materials and textures, the camera, the
// G-buffer (so that a truth is never of another version's pixels), settings and the version of the method.
std::string truthKey(const engine::Scene& scene, const RaySurface& surface, const engine::FrameSettings& frameSettings,
                     const engine::Frame& frame, const TruthSettings& settings);

std::string truthFile(const std::string& folder, const std::string& key);

// Alike, of the environment's planes, by the truth's key: also the map's texels, how it is turned, and its factor.
std::string environmentTruthKey(const std::string& truthKey, const engine::EnvironmentMap& map, const engine::FrameSettings& frameSettings);

// As engine/content_cache.h has it.
std::optional<Truth> loadTruth(const std::string& file, const std::string& key, int width, int height, int quantities = kTruthQuantities);

engine::Result<engine::Done> storeTruth(const std::string& file, const std::string& key, const Truth& truth);

}  // namespace obscura::apps
