// In:  depth, normals (and albedo, for the neighbours' W) of the G-buffer.
// Out: per pixel the numerator and denominator of the ambient transfer (long paper, equation 9 and its shader).
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "obscura/post/projector.h"
#include "obscura/post/settings.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/target.h"

namespace obscura::post {

// What the shader returns as (w.a, w.rgb). For TransferAlbedo::Own the denominator follows from the numerator and is
// not stored.
struct TransferSums {
  raster::Plane<float> numerator;       // test rays that stay outside: 0 ... n, a whole number; n where empty
  raster::Plane<float> denominator[3];  // n minus the occluders' albedos, per channel
};

struct TransferInput {
  const raster::GBuffer* g = nullptr;
  Projector projector;
  AmbientSettings settings;
  std::vector<glm::vec3> offsets;  // transferSamples(settings)
};

// Allocates what the settings need. `used`, here and in the other make functions of the post process: planes of an earlier
// frame, which serve again where they have the right size.
TransferSums makeTransferSums(const TransferInput& in, TransferSums used = {});

// Rows y0 ... y1 - 1 of `out`; reads the depth map everywhere.
void ambientTransfer(const TransferInput& in, int y0, int y1, TransferSums& out, raster::Target target);
void ambientTransferRef(const TransferInput& in, int y0, int y1, TransferSums& out);  // the scalar twin

}  // namespace obscura::post
