// obscura-bench albedo: which W is nearest to the recursive one, on which albedo.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/albedo_report.h"
#include "obscura/apps/frame_options.h"
#include "obscura/apps/scene_truth.h"

namespace obscura::apps {

struct AlbedoBenchmark {
  std::vector<std::string> scenes, map;
  std::vector<std::string> albedos = {"0.2", "0.5", "0.8", kSceneAlbedo};
  bool json = false, quiet = false;
  std::string csv, plot;
  FrameOptions options;
  TruthOptions truth;

  AlbedoBenchmark();
  // Runs when the command is parsed and leaves the exit code in `status`; the object must live until then.
  void addTo(CLI::App& app, int& status);

 private:
  int run();
  engine::Result<AlbedoScene> measure(const std::string& file, const std::vector<Albedo>& list, std::optional<size_t> mapped,
                                      Progress& progress) const;
};

}  // namespace obscura::apps
