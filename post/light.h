// In:  albedo, emission, depth; O, W or the bounced light; what La and the ambient reflectance R_A depend on; the light of
//      direct lights that is reflected; what mirrors show.
// Out: linear colour, Lr = R_A W La + direct + emission (long paper, equation 2, where R_A is a; brdf.h).
#pragma once

#include <glm/vec3.hpp>

#include "obscura/post/ambient_light.h"
#include "obscura/post/brdf.h"
#include "obscura/post/depth_filter.h"
#include "obscura/post/linear_color.h"
#include "obscura/post/projector.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/target.h"

namespace obscura::post {

// What modulates the ambient light: 1, O or W. With TransferAlbedo::Radiance W La is O La + the bounced light.
enum class Occlusion : uint8_t { None, Obscurance, Transfer };

struct LightInput {
  // Depth and albedo; emission where the scene has any; instance and normal where the ambient light needs them; normal,
  // metallic and roughness of a glossy BRDF.
  const raster::GBuffer* g = nullptr;
  const Transfer* transfer = nullptr;  // may be null for Occlusion::None
  Occlusion occlusion = Occlusion::Transfer;
  AmbientLight ambient;
  glm::vec3 background{0};             // linear; where nothing was drawn
  const LinearColor* direct = nullptr; // reflected, see direct_light.h; of the G-buffer's size; null: none
  Brdf brdf = Brdf::Lambert;
  Projector projector = {};            // of a glossy BRDF: where the G-buffer's pixels look
  // Of a glossy BRDF, what arrives from where it mirrors (environment_reflection.h), in place of La and what modulates it in the
  // specular part of R_A: Lr = kd W La + S(v) (D reflected + W A) + emission. Null: La there, too. May be what light() writes to.
  const LinearColor* reflected = nullptr;
};

// Without occlusion this is also a first guess of what the occluders send back, see TransferInput::radiance: their
// emission, direct light, and the ambient light reflected as if all of it arrived.
void light(const LightInput& in, int y0, int y1, LinearColor& out, raster::Target target);
void lightRef(const LightInput& in, int y0, int y1, LinearColor& out);  // the scalar twin

// W of in.transfer, which holds O and the bounced light: O + bounced / La per channel, never above the largest float. Where
// La is 0 there is nothing to relate the bounced light to, and W is O (light() loses none of it, as it does not divide).
// Empty pixels have W = 1. `w` is allocated, in.occlusion and in.background are not read.
void transferOfBounced(const LightInput& in, int y0, int y1, raster::Plane<float> (&w)[3], raster::Target target);
void transferOfBouncedRef(const LightInput& in, int y0, int y1, raster::Plane<float> (&w)[3]);  // the scalar twin

}  // namespace obscura::post
