// Scalar twin of tone_map.cpp.
#include <algorithm>

#include <glm/vec3.hpp>

#include "obscura/post/tone_map.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

glm::vec3 reinhard(const glm::vec3& c) { return c / (c.r * 0.2126f + c.g * 0.7152f + c.b * 0.0722f + 1.0f); }

// Below the knee a colour keeps its distance from black but for what Fresnel's reflection adds; above it the largest channel
// approaches 1, and the others follow it towards white.
glm::vec3 neutral(const glm::vec3& in) {
  const float knee = 0.76f, room = 1 - knee;
  const float dark = std::min({in.r, in.g, in.b}), toe = dark < 0.08f ? dark - 6.25f * dark * dark : 0.04f;
  const glm::vec3 c = in - toe;
  const float peak = std::max({c.r, c.g, c.b});
  if (peak < knee) return c;
  const float lowered = 1 - room * room / (peak + room - knee), white = 1 - 1 / (0.15f * (peak - lowered) + 1);
  return c * (lowered / peak) * (1 - white) + glm::vec3(lowered * white);
}

}  // namespace

void toneMapRef(const LinearColor& in, const ToneSettings& settings, int y0, int y1, LinearColor& out) {
  const raster::FloatEnvironment environment;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.rgb[0].width(); ++x) {
      glm::vec3 c;
      for (int k = 0; k < 3; ++k) {
        const float v = in.rgb[k].at(x, y) * settings.exposure;
        c[k] = v > 0 ? std::min(v, 1e30f) : 0;
      }
      if (settings.curve == ToneCurve::Reinhard) c = reinhard(c);
      if (settings.curve == ToneCurve::Neutral) c = neutral(c);
      for (int k = 0; k < 3; ++k) out.rgb[k].at(x, y) = c[k];
    }
}

}  // namespace obscura::post
