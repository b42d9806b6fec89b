// In:  measured rows.
// Out: a table, CSV, JSON, a plot.
#pragma once

#include <string>
#include <vector>

#include "obscura/apps/albedo_rows.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

struct AlbedoScene {
  std::string file;
  int width = 0, height = 0, rays = 0;
  post::AmbientSettings settings;  // of the depth map's rows
  struct TruthOfAlbedo {
    std::string name, key;
    double error = 0;  // standard error of the recursive W, rms
  };
  std::vector<TruthOfAlbedo> truths;  // by albedo
  std::vector<AlbedoRow> rows;
};

std::string tableOf(const AlbedoScene& scene);
std::string csvOf(const std::vector<AlbedoScene>& scenes);
std::string jsonOf(const std::vector<AlbedoScene>& scenes);

// By gnuplot: bars of RMSE by albedo, a line of two panels for each scene: by rays, by the depth map. Files as of
// writeParetoPlot(). CannotWrite.
engine::Result<engine::Done> writeAlbedoPlot(const std::string& path, const std::vector<AlbedoScene>& scenes);

}  // namespace obscura::apps
