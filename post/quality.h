// In:  how much time there is.
// Out: the settings of the ambient transfer that err least in it; what each costs and errs: docs/accuracy.md.
#pragma once

#include <cstdint>

#include "obscura/post/settings.h"

namespace obscura::post {

enum class Quality : uint8_t {
  Paper,      // the papers' shader: their set of 8 points, one containment test each, filter by depth (AmbientSettings())
  Draft,      // rays marched through the depth map (post/ray_march.h), n = 1, m = 2; this and what follows: filter by plane
  Standard,   // n = 4, m = 3
  High,       // n = 8, m = 8
  Reference,  // n = 16, m = 8, two layers of depth, which GBuffer::depth2 must be rendered for
};

// Estimator, samples, steps, layers and the filter's guide; the rest stays as it is.
void setQuality(AmbientSettings& settings, Quality quality);

}  // namespace obscura::post
