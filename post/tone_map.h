// In:  linear colour of the scene.
// Out: linear colour for a screen: exposed, and brought into its range.
#pragma once

#include "obscura/post/linear_color.h"
#include "obscura/raster/target.h"

namespace obscura::post {

enum class ToneCurve : uint8_t {
  None,      // what is above 1 is clipped later, by the display
  Reinhard,  // c / (1 + L), L the luminance (Reinhard et al. 2002, "Photographic Tone Reproduction", equation 3)
  Neutral,   // Khronos PBR Neutral: colours below 0.76 stay, but for an offset that makes up for Fresnel's 4 %
};

struct ToneSettings {
  ToneCurve curve = ToneCurve::None;
  float exposure = 1;  // a factor before the curve, >= 0 and finite

  bool changesNothing() const { return curve == ToneCurve::None && exposure == 1; }
};

// Whatever the colours hold, the result is a number, from 0 up: negative ones and NaN count as 0, those above 1e30 as that.
// Neutral and the luminance of Reinhard end at 1; single channels of Reinhard may be above. `in` and `out` may be one.
void toneMap(const LinearColor& in, const ToneSettings& settings, int y0, int y1, LinearColor& out, raster::Target target);
void toneMapRef(const LinearColor& in, const ToneSettings& settings, int y0, int y1, LinearColor& out);  // the scalar twin

}  // namespace obscura::post
