#include "obscura/post/tone_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/tone_map.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

HWY_INLINE VF least(VF a, VF b) { return hn::IfThenElse(hn::Lt(b, a), b, a); }
HWY_INLINE VF most(VF a, VF b) { return hn::IfThenElse(hn::Gt(b, a), b, a); }

struct NoCurve {
  static HWY_INLINE V3 map(const V3& c) { return c; }
};

struct Reinhard {
  static HWY_INLINE V3 map(const V3& c) {
    const DF d;
    const VF by = hn::Add(dot(c, {hn::Set(d, 0.2126f), hn::Set(d, 0.7152f), hn::Set(d, 0.0722f)}), hn::Set(d, 1.0f));
    return {hn::Div(c.x, by), hn::Div(c.y, by), hn::Div(c.z, by)};
  }
};

// After Khronos' specification "PBR Neutral Tone Mapper".
struct Neutral {
  static HWY_INLINE V3 map(const V3& in) {
    const DF d;
    constexpr float kKnee = 0.76f;
    const VF one = hn::Set(d, 1.0f), knee = hn::Set(d, kKnee), room = hn::Set(d, 1.0f - kKnee), limit = hn::Set(d, 0.08f);
    const VF dark = least(least(in.x, in.y), in.z);
    const VF toe = hn::IfThenElse(hn::Lt(dark, limit), hn::Sub(dark, hn::Mul(hn::Mul(hn::Set(d, 6.25f), dark), dark)), hn::Set(d, 0.04f));
    const V3 c{hn::Sub(in.x, toe), hn::Sub(in.y, toe), hn::Sub(in.z, toe)};
    const VF peak = most(most(c.x, c.y), c.z);
    const MF high = hn::Ge(peak, knee);
    const VF lowered = hn::Sub(one, hn::Div(hn::Mul(room, room), hn::Sub(hn::Add(peak, room), knee)));
    const VF scale = hn::Div(lowered, hn::IfThenElse(high, peak, one));
    const VF white = hn::Sub(one, hn::Div(one, hn::Add(hn::Mul(hn::Set(d, 0.15f), hn::Sub(peak, lowered)), one)));
    const auto channel = [&](VF v) {
      const VF mixed = hn::Add(hn::Mul(hn::Mul(v, scale), hn::Sub(one, white)), hn::Mul(lowered, white));
      return hn::IfThenElse(high, mixed, v);
    };
    return {channel(c.x), channel(c.y), channel(c.z)};
  }
};

template <class Curve>
void mapRows(const LinearColor& in, float exposure, int y0, int y1, LinearColor& out) {
  const DF d;
  const VF zero = hn::Zero(d), kMost = hn::Set(d, 1e30f), factor = hn::Set(d, exposure);
  const auto exposed = [&](const float* from) {
    const VF v = hn::Mul(hn::LoadU(d, from), factor);
    const VF above = hn::IfThenElseZero(hn::Gt(v, zero), v);
    return hn::IfThenElse(hn::Lt(above, kMost), above, kMost);
  };
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.rgb[0].width(); x += int(hn::Lanes(d))) {
      const V3 c = Curve::map({exposed(in.rgb[0].row(y) + x), exposed(in.rgb[1].row(y) + x), exposed(in.rgb[2].row(y) + x)});
      hn::StoreU(c.x, d, out.rgb[0].row(y) + x);
      hn::StoreU(c.y, d, out.rgb[1].row(y) + x);
      hn::StoreU(c.z, d, out.rgb[2].row(y) + x);
    }
}

void ToneMap(const LinearColor& in, const ToneSettings& s, int y0, int y1, LinearColor& out) {
  switch (s.curve) {
    case ToneCurve::None: return mapRows<NoCurve>(in, s.exposure, y0, y1, out);
    case ToneCurve::Reinhard: return mapRows<Reinhard>(in, s.exposure, y0, y1, out);
    case ToneCurve::Neutral: return mapRows<Neutral>(in, s.exposure, y0, y1, out);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(ToneMap);

void toneMap(const LinearColor& in, const ToneSettings& settings, int y0, int y1, LinearColor& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(ToneMap, target)(in, settings, y0, y1, out);
}

}  // namespace obscura::post
#endif
