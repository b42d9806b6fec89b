// In:  depth and albedo of the G-buffer, metallic if the BRDF is glossy; which part of it is given; La by instance.
// Out: for every 16 pixels of a row whether their sums are read for a pixel that shows anything of them.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "obscura/raster/gbuffer.h"
#include "obscura/raster/span.h"

namespace obscura::post {

// O and W reach the picture as factors of R_A La (light.h): where that is 0, nobody can see what they are.
struct AskedInput {
  const raster::GBuffer* g = nullptr;
  raster::Window part;  // of g, in its pixels: what is given
  bool filter = true;   // the depth filter adds up windows
  // false: O or W of every pixel of the part is wanted. true: only the colour, so pixels that reflect nothing ask for
  // nothing, but for empty ones, which cost nothing in any case.
  bool onlyLit = false;
  // With onlyLit: La by the G-buffer's instance ids, as in AmbientLight; instances of La = 0 ask for nothing. Must be empty
  // where a pixel gets other light than that through the sums: with TransferAlbedo::Radiance, and where directions add some.
  raster::Span<const glm::vec3> ambient;
  bool glossy = false;  // of the BRDF: what reflects nothing is unlit, not all that has the albedo 0
};

// Rows y0 ... y1 - 1 of `asked`, which has one element per 16 pixels of a row: 1 or 0. Reads three rows more.
void askedPixels(const AskedInput& in, int y0, int y1, raster::Plane<uint8_t>& asked);

}  // namespace obscura::post
