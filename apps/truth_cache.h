// In:  what a truth follows from.
// Out: the same truth again without tracing a ray, from a file.
#pragma once

#include <optional>
#include <string>

#include "obscura/apps/truth.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

// 32 hex digits, XXH3-128, of all that decides the values: the scene's triangles, materials and textures, the camera, the
// G-buffer (so that a truth is never of another version's pixels), settings and the version of the method.
std::string truthKey(const engine::Scene& scene, const RaySurface& surface, const engine::FrameSettings& frameSettings,
                     const engine::Frame& frame, const TruthSettings& settings);

// $XDG_CACHE_HOME/obscura, or ~/.cache/obscura; empty where neither variable is set to an absolute path.
std::string defaultCacheFolder();

std::string truthFile(const std::string& folder, const std::string& key);

// Empty if there is no such file, or it is not whole: its length, key, size or checksum is wrong.
std::optional<Truth> loadTruth(const std::string& file, const std::string& key, int width, int height);

// Makes the folder if need be. Written beside and renamed: a reader never sees half a file.
engine::Result<engine::Done> storeTruth(const std::string& file, const std::string& key, const Truth& truth);

}  // namespace obscura::apps
