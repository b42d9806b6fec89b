#include "obscura/post/quality.h"

namespace obscura::post {

void setQuality(AmbientSettings& settings, Quality quality) {
  AmbientSettings chosen;
  const auto march = [&](int samples, int steps, int layers) {
    chosen.estimator = Estimator::March;
    chosen.samples = samples, chosen.steps = steps, chosen.layers = layers;
    chosen.filterGuide = FilterGuide::Plane;
  };
  switch (quality) {
    case Quality::Paper: break;
    case Quality::Draft: march(1, 2, 1); break;
    case Quality::Standard: march(4, 3, 1); break;
    case Quality::High: march(8, 8, 1); break;
    case Quality::Reference: march(16, 8, 2); break;
  }
  settings.estimator = chosen.estimator;
  settings.samples = chosen.samples;
  settings.steps = chosen.steps;
  settings.layers = chosen.layers;
  settings.filterGuide = chosen.filterGuide;
}

}  // namespace obscura::post
