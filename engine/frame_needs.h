// In:  scene and settings of a frame.
// Out: the planes and passes that the wanted AOVs need.
#pragma once

#include "obscura/engine/frame.h"

namespace obscura::engine {

// What the wanted AOVs add up to.
struct FrameNeeds {
  raster::PlaneSet planes;
  bool color = false, sums = false;
  post::Occlusion occlusion = post::Occlusion::None;  // of the ambient light in the colour
  post::TransferPlanes transfer;
  bool albedo = false;    // of what occludes, or of the pixel itself
  bool radiance = false;  // of what occludes
  bool direct = false;    // lights
  bool reflections = false;  // of the environment
  post::Brdf brdf = post::Brdf::Lambert;  // of what is lit
  bool onlyLit = false;   // O and W are for the colour alone, and some pixels may reflect nothing
};

// The light depends on the direction of surfaces.
bool lightsByNormal(const FrameSettings& settings);

FrameNeeds needsOf(const Scene& scene, const FrameSettings& settings);

// Null, or what is wrong with a setting; for what is wrong with the crop see crop.h.
const char* wrongSetting(const FrameSettings& settings);

}  // namespace obscura::engine
