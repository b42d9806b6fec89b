// Scalar twin of light.cpp.
#include <limits>

#include "obscura/post/light.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

void lightRef(const LightInput& in, int y0, int y1, LinearColor& out) {
  const raster::FloatEnvironment environment;
  const raster::GBuffer& g = *in.g;
  for (int c = 0; c < 3; ++c)
    for (int y = y0; y < y1; ++y)
      for (int x = 0; x < g.width; ++x) {
        const float occlusion = in.occlusion == Occlusion::Transfer     ? in.transfer->w[c].at(x, y)
                                : in.occlusion == Occlusion::Obscurance ? in.transfer->obscurance.at(x, y)
                                                                        : 1;
        const float reflected = g.albedo[c].at(x, y) * occlusion * in.ambient[c];
        const float emitted = g.emissive[c].empty() ? 0 : g.emissive[c].at(x, y);
        const bool seen = g.depth.at(x, y) < std::numeric_limits<float>::infinity();
        out.rgb[c].at(x, y) = seen ? reflected + emitted : in.background[c];
      }
}

}  // namespace obscura::post
