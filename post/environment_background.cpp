#include "obscura/post/environment_background.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/environment_background.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/cube_look_up-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

void EnvironmentBackground(const BackgroundInput& in, int y0, int y1, LinearColor& out) {
  const DF d;
  const DI di;
  const Projector& p = in.projector;
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity()), half = hn::Set(d, 0.5f), zero = hn::Zero(d);
  const VF intensity = hn::Set(d, in.environment.intensity);
  const EnvironmentChain& chain = in.environment.chain;
  const VI size = hn::Set(di, chain.sizes[0]), first = hn::Zero(di);
  for (int y = y0; y < y1; ++y) {
    const float yPx = float(p.yFirst + y) + 0.5f;
    const VF yView = p.perspective ? hn::Set(d, (yPx - p.yCenter) * p.yInverse) : zero;
    for (int x = 0; x < in.g->width; x += int(hn::Lanes(d))) {
      const MF seen = hn::Lt(hn::LoadU(d, in.g->depth.row(y) + x), infinity);
      if (hn::AllTrue(d, seen)) continue;
      const VF xPx = hn::Add(hn::ConvertTo(d, hn::Iota(di, p.xFirst + x)), half);
      const VF xView = p.perspective ? hn::Mul(hn::Sub(xPx, hn::Set(d, p.xCenter)), hn::Set(d, p.xInverse)) : zero;
      const V3 radiance = cubeLookUp(chain.texels.data(), cubePointOf(turned(in.environment.mapFromView, {xView, yView, hn::Set(d, -1.0f)})), size, first);
      const VF channels[3] = {radiance.x, radiance.y, radiance.z};
      for (int c = 0; c < 3; ++c) {
        float* to = out.rgb[c].row(y) + x;
        hn::StoreU(hn::IfThenElse(seen, hn::LoadU(d, to), hn::Mul(channels[c], intensity)), d, to);
      }
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

HWY_EXPORT(EnvironmentBackground);

void environmentBackground(const BackgroundInput& in, int y0, int y1, LinearColor& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(EnvironmentBackground, target)(in, y0, y1, out);
}

}  // namespace obscura::post
#endif
