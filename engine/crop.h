// In:  a frame's image, border and crop; the depth that is seen in the crop.
// Out: the window of the image that has to be rasterized, so that the crop gets the bits of the whole frame.
#pragma once

#include <string>

#include "obscura/engine/frame.h"
#include "obscura/post/projector.h"

namespace obscura::engine {

// Empty if size, border and crop can be, else what is wrong with them.
std::string wrongCrop(const FrameSettings& settings);

// All in pixels of the camera's image. What the frame gives: the crop, or the image.
raster::Window outputWindow(const FrameSettings& settings);
// The image and its border: nothing outside of it takes part.
raster::Window wholeWindow(const FrameSettings& settings);
// The pixels whose sums the depth filter adds up for the output.
raster::Window filteredWindow(const FrameSettings& settings);
// The pixels that the transfer reads for the filtered window, or more; nearest: the smallest zView seen in that, infinity
// if there is none.
raster::Window transferWindow(const FrameSettings& settings, float nearest);

// The smallest value; infinity where all are.
float nearestDepth(const raster::Plane<float>& depth);

// The part of `from`, in its own pixels; planes that `from` does not hold are empty.
void cutOut(const post::Transfer& from, const raster::Window& part, post::Transfer& to);

}  // namespace obscura::engine
