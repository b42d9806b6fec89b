// In: a frame.  Out: its AOVs as images, exact or to be looked at.
#pragma once

#include "obscura/engine/aov.h"
#include "obscura/engine/digest.h"
#include "obscura/engine/frame.h"
#include "obscura/engine/image.h"

namespace obscura::apps {

// All functions of a frame want the AOV's planes in it; all throw std::bad_alloc.

// The planes themselves: F32 or, for ids, U32, every bit kept. What EXR, PFM and NPY hold and digests are of.
engine::Image planeImage(const engine::Frame& frame, engine::Aov aov);

// The sRGB bytes of the colour, U8 RGB.
engine::Image displayPicture(const engine::Frame& frame);

// The same two row by row, for digests; they read the frame as long as they live.
engine::RowSource planeRows(const engine::Frame& frame, engine::Aov aov);
engine::RowSource displayRows(const engine::Frame& frame);

// Linear floats sRGB-encoded, U8 or U16; clamped to [0, 1], NaN is 0.
engine::Image srgbPicture(const engine::Image& linear, int bits);

// What a PNG holds. In 8 bits: color, albedo and emissive sRGB-encoded; obscurance, transfer,
// metallic and roughness linear, times 255 (they are factors, not light), those of one channel as grey; normal 255 (n / 2 + 1/2); see engine/plane_image.h for depth and ids;
// position along each axis from 0 at the least to 255 at the greatest that is seen (needs the depth, too). 16 bits:
// the same with 65535, but depth, position and ids stay pictures of 8 bits.
engine::Image picture(const engine::Frame& frame, engine::Aov aov, int bits);

// Depth, normal, albedo, O, W and the colour side by side, U8 RGB.
engine::Image stagesPicture(const engine::Frame& frame);

}  // namespace obscura::apps
