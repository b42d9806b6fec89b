// In:  a frame of sub-pixels, and which AOVs are wanted.
// Out: the frame of pixels.
#pragma once

#include <optional>

#include "obscura/engine/frame.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {

// Fills the planes of settings.aovs, and the colour for settings.display, and says where they lie in the image; the other
// planes become empty. `full` is settings.supersample times as wide and high and has these planes and the depth. Light (color,
// emissive), reflectance (albedo, metallic, roughness) and factors (obscurance, transfer) are means over the pixel, what is
// empty included;
// depth, normal, position and ids are those of the nearest sub-pixel, so that they belong together.
// target: empty: by the scalar twins. Throws std::bad_alloc.
void downsampleFrame(const Frame& full, const FrameSettings& settings, raster::Parallel& parallel,
                     std::optional<raster::Target> target, Frame& out);

}  // namespace obscura::engine
