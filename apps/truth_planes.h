// In:  a truth.
// Out: its planes by name, as files and as figures.
#pragma once

#include <string>
#include <vector>

#include "obscura/apps/truth.h"
#include "obscura/engine/image_file.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

struct TruthPlane {
  const char* name;  // "linear", "transfer", ...
  std::vector<TruthQuantity> quantities;  // one, or three for R, G, B
};
const std::vector<TruthPlane>& truthPlanes();  // those of an environment last
bool has(const Truth& truth, const TruthPlane& plane);

struct TruthFile {
  std::string path;
  engine::FileFormat format;
  std::vector<const TruthPlane*> planes;
};

// names: of planes, or "all" that there are, those of an environment or not. An EXR gets them as layers NAME and NAME_error, the other formats as STEM.NAME.EXT and
// STEM.NAME_error.EXT. Usage: no such plane, one of an
// environment without one, a format other than .exr, .npy and .pfm, standard output.
engine::Result<std::vector<TruthFile>> planTruthFiles(const std::vector<std::string>& outputs, const std::vector<std::string>& names,
                                                      bool environment);

engine::Result<engine::Done> writeTruthFile(const TruthFile& file, const Truth& truth, const engine::Frame& frame);

struct TruthSummary {
  double mean = 0, rmsError = 0, maxError = 0;  // over the pixels and channels in which something is seen
};
TruthSummary summaryOf(const TruthPlane& plane, const Truth& truth, const engine::Frame& frame);

}  // namespace obscura::apps
