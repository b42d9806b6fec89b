#include "obscura/post/light.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/light.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

void Light(const LightInput& in, int y0, int y1, LinearColor& out) {
  const DF d;
  const raster::GBuffer& g = *in.g;
  const bool emits = !g.emissive[0].empty();
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < g.width; x += int(hn::Lanes(d))) {
      const MF seen = hn::Lt(hn::LoadU(d, g.depth.row(y) + x), hn::Set(d, std::numeric_limits<float>::infinity()));
      for (int c = 0; c < 3; ++c) {
        VF color = hn::LoadU(d, g.albedo[c].row(y) + x);
        if (in.occlusion == Occlusion::Obscurance) color = hn::Mul(color, hn::LoadU(d, in.transfer->obscurance.row(y) + x));
        if (in.occlusion == Occlusion::Transfer) color = hn::Mul(color, hn::LoadU(d, in.transfer->w[c].row(y) + x));
        color = hn::Mul(color, hn::Set(d, in.ambient[c]));
        if (emits) color = hn::Add(color, hn::LoadU(d, g.emissive[c].row(y) + x));
        hn::StoreU(hn::IfThenElse(seen, color, hn::Set(d, in.background[c])), d, out.rgb[c].row(y) + x);
      }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(Light);

void light(const LightInput& in, int y0, int y1, LinearColor& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(Light, target)(in, y0, y1, out);
}

LinearColor makeLinearColor(int width, int height, LinearColor used) {
  for (auto& plane : used.rgb) plane.resize(width, height);
  return used;
}

}  // namespace obscura::post
#endif
