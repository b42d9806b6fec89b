// In:  depth, normals (and albedo, for the neighbours' W) of the G-buffer; a lit frame, for that of stored radiance; implicit
//      surfaces.
// Out: per pixel the numerator and denominator of the ambient transfer (long paper, equation 9 and its shader).
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/post/depth_bounds.h"
#include "obscura/post/linear_color.h"
#include "obscura/post/projector.h"
#include "obscura/post/settings.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/implicit.h"
#include "obscura/raster/target.h"

namespace obscura::post {

// So many pixels of a row are known to be open, or asked for, together: what is skipped does not depend on the vector's length.
constexpr int kSegment = 16;
static_assert(DepthBounds::kCellWidth == kSegment, "a segment lies in one block");
constexpr int segmentsOf(int width) { return (width + kSegment - 1) / kSegment; }

// What the shader returns as (w.a, w.rgb). For TransferAlbedo::Own the denominator follows from the numerator and is
// not stored.
struct TransferSums {
  raster::Plane<float> numerator;       // test rays that stay outside: 0 ... n, a whole number; n where empty
  // Per channel n minus the occluders' albedos; TransferAlbedo::Radiance: 0 minus their radiances.
  raster::Plane<float> denominator[3];
  raster::Plane<uint8_t> open;          // one element per segment: 1 where all numerators are n
};

// Every pixel is one of these. Which, depends neither on the instruction set nor on how the rows are divided.
struct TransferStatistics {
  uint64_t unasked = 0;  // nobody reads what they would be
  uint64_t empty = 0;    // nothing is seen there
  uint64_t open = 0;     // known from the bounds of the depth
  uint64_t sampled = 0;

  void add(const TransferStatistics& o) { unasked += o.unasked, empty += o.empty, open += o.open, sampled += o.sampled; }
};

// How far behind the second layer (AmbientSettings::layers) is inside, of R. All of R would be too much: where a closed
// mesh is double-sided, its far wall is a second layer, and behind it is outside.
constexpr float kHiddenThickness = 0.5f;

struct TransferInput {
  const raster::GBuffer* g = nullptr;
  Projector projector;
  AmbientSettings settings;
  std::vector<glm::vec3> offsets;  // transferSamples(settings): n, or 16 n
  // Of this depth and projector, whole: where they show that every ray stays outside, none is followed. Null: all are.
  const DepthBounds* bounds = nullptr;
  // askedPixels(): where it has 0, no ray is followed, and the sums are those of open pixels. Null: all are asked for.
  const raster::Plane<uint8_t>* asked = nullptr;
  // For TransferAlbedo::Radiance: what each pixel of the G-buffer sends out, linear, >= 0, of its size: any lit frame, as
  // light() makes one. Where something else than a number >= 0 is met, the windows concerned have no bounced light.
  const LinearColor* radiance = nullptr;
  // Surfaces whose inside is known, seen from the same camera: what lies in a single-sided one is inside, whatever the depth map says
  // (containment-inl.h). So they occlude where they are hidden, off screen, or farther than R behind what hides them.
  raster::Span<const raster::ImplicitDraw> implicits = {};
  // Of what is displaced, where the G-buffer has the relief planes: what lies below its own height map is inside, too.
  raster::Span<const raster::HeightView> heights = {};
};

// Allocates what the settings need; std::invalid_argument if the radiance is needed and is not there or of another size,
// or if two layers are asked for and the G-buffer has one. `used`, here and in the other make functions of the post
// process: planes of an earlier frame, which serve again where they have the right size.
TransferSums makeTransferSums(const TransferInput& in, TransferSums used = {});

// Rows y0 ... y1 - 1 of `out`; reads the depth map everywhere.
TransferStatistics ambientTransfer(const TransferInput& in, int y0, int y1, TransferSums& out, raster::Target target);
void ambientTransferRef(const TransferInput& in, int y0, int y1, TransferSums& out);  // the scalar twin: follows all rays

}  // namespace obscura::post
