// In:  a frame of a scene.
// Out: its truth, from the cache or traced; the options of the programs that want one.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/error_measures.h"
#include "obscura/apps/frame_options.h"
#include "obscura/apps/progress.h"
#include "obscura/apps/truth.h"
#include "obscura/engine/environment_map.h"

namespace obscura::apps {

struct TruthOptions {
  int rays = 512;
  std::optional<std::string> cache;  // folder; empty: truth_cache.h's
  bool noCache = false;

  void addTo(CLI::App& app);
};

// Takes away the options of a frame that say how the ambient transfer is estimated, but for `kept`, and those that say what
// is done with it: a truth depends on none of them. Rays meet the triangles of a mesh, so nothing is displaced.
extern const std::vector<std::string> kEnvironmentOptions;  // of the frame's that say which one there is
void removeEstimatorOptions(CLI::App& app, FrameOptions& options, const std::vector<std::string>& kept = {"--radius", "--membership"});

// A frame that truths are traced of.
struct TracedFrame {
  engine::Scene scene;
  ResolvedFrame resolved;
  engine::Frame frame;  // with truthAovs() and those asked for
  std::optional<engine::EnvironmentMap> environment;  // of the options' file
};

// Loads and renders; `change` is made to the scene before. Usage, BadInput: also where nothing is visible.
engine::Result<TracedFrame> renderTraced(const std::string& file, const FrameOptions& options, const std::vector<engine::Aov>& more,
                                         Progress& progress, const std::function<void(engine::Scene&)>& change = {});

// 1 where something is seen. BadInput, of this file: nowhere.
engine::Result<raster::Plane<uint8_t>> seenOf(const engine::Frame& frame, const std::string& file);

// Root of the mean square of the planes over these pixels: a truth's standard error.
double rmsOver(const PlaneRefs& planes, const raster::Plane<uint8_t>& seen);

struct SceneTruth {
  Truth truth;
  std::string key, environmentKey, file;  // file: of what depends on no environment; empty without a cache
  bool cached = true;  // nothing was traced
  double buildMs = 0, traceMs = 0;  // of Embree's tree and of the rays; 0 if cached
};

// Of a frame that has truthAovs() and no supersampling; with the environment's planes if there is one. A cache that cannot be written is an error where it was named, else a
// warning on standard error. CannotWrite; throws what RayScene and traceTruth throw.
engine::Result<SceneTruth> truthOfFrame(const engine::Scene& scene, const ResolvedFrame& resolved, const engine::Frame& frame,
                                        const TruthOptions& options, Progress& progress,
                                        const std::optional<engine::EnvironmentMap>& environment = {});

}  // namespace obscura::apps
