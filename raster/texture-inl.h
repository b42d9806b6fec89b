// Per-target texture sampling: wrap, nearest / bilinear / trilinear, sRGB.
#if defined(OBSCURA_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_TEXTURE_INL_H_
#undef OBSCURA_TEXTURE_INL_H_
#else
#define OBSCURA_TEXTURE_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/raster/material.h"
#include "obscura/raster/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

struct Rgba {
  VF r, g, b, a;
};

// log2(x) of positive normal x, error below 2e-5: log2(1 + t) = t + t (1 - t) q(t), q fitted by the Lawson algorithm.
HWY_INLINE VF log2Approximately(VF x) {
  const DF d;
  const DI di;
  const VI bits = hn::BitCast(di, x);
  const VF exponent = hn::ConvertTo(d, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(di, 127)));
  const VI mantissa = hn::Or(hn::And(bits, hn::Set(di, 0x007FFFFF)), hn::Set(di, 0x3F800000));
  const VF one = hn::Set(d, 1.0f), t = hn::Sub(hn::BitCast(d, mantissa), one);
  VF q = hn::Set(d, -0.045149015f);
  q = hn::Add(hn::Mul(q, t), hn::Set(d, 0.148426603f));
  q = hn::Add(hn::Mul(q, t), hn::Set(d, -0.267179386f));
  q = hn::Add(hn::Mul(q, t), hn::Set(d, 0.441917037f));
  return hn::Add(exponent, hn::Add(t, hn::Mul(hn::Mul(t, hn::Sub(one, t)), q)));
}

// Level of detail from the texel-space gradients' larger squared length; NaN and what is below one texel give <= 0.
HWY_INLINE VF levelOfDetail(VF squaredLength) {
  const DF d;
  const VF tiny = hn::Set(d, 1e-30f), huge = hn::Set(d, 1e30f);
  const MF usable = hn::Ge(squaredLength, tiny);
  const VF x = hn::IfThenElse(usable, hn::IfThenElse(hn::Lt(squaredLength, huge), squaredLength, huge), tiny);
  return hn::Mul(log2Approximately(x), hn::Set(d, 0.5f));
}

// Folds a coordinate into [0, 1]; NaN and infinity become 0.
HWY_INLINE VF wrapCoordinate(VF u, Wrap mode) {
  const DF d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  if (mode == Wrap::Repeat) {
    u = hn::Sub(u, hn::Floor(u));
  } else if (mode == Wrap::MirroredRepeat) {
    const VF t = hn::Sub(u, hn::Mul(hn::Set(d, 2.0f), hn::Floor(hn::Mul(u, hn::Set(d, 0.5f)))));
    u = hn::IfThenElse(hn::Gt(t, one), hn::Sub(hn::Set(d, 2.0f), t), t);
  }
  u = hn::IfThenElse(hn::Gt(u, zero), u, zero);
  return hn::IfThenElse(hn::Lt(u, one), u, one);
}

// Texel index after stepping out of [0, size) by at most one.
HWY_INLINE VI wrapTexel(VI i, VI size, Wrap mode) {
  const DI d;
  const MI below = hn::Lt(i, hn::Zero(d)), above = hn::Not(hn::Lt(i, size));
  const VI last = hn::Sub(size, hn::Set(d, 1));
  if (mode == Wrap::Repeat) return hn::IfThenElse(below, last, hn::IfThenElse(above, hn::Zero(d), i));
  return hn::IfThenElse(below, hn::Zero(d), hn::IfThenElse(above, last, i));
}

HWY_INLINE Rgba fetchTexel(const TextureView& t, const float* srgbToLinear, VI index) {
  const DF d;
  const DI di;
  const VI texel = hn::GatherIndex(di, reinterpret_cast<const int32_t*>(t.texels.data()), index);
  const VI byte = hn::Set(di, 255);
  const VI r = hn::And(texel, byte), g = hn::And(hn::ShiftRight<8>(texel), byte), b = hn::And(hn::ShiftRight<16>(texel), byte);
  const VI a = hn::And(hn::ShiftRight<24>(texel), byte);
  const VF full = hn::Set(d, 255.0f);
  auto linear = [&](VI c) HWY_ATTR { return hn::Div(hn::ConvertTo(d, c), full); };
  auto srgb = [&](VI c) HWY_ATTR { return hn::GatherIndex(d, srgbToLinear, c); };
  return t.srgb ? Rgba{srgb(r), srgb(g), srgb(b), linear(a)} : Rgba{linear(r), linear(g), linear(b), linear(a)};
}

HWY_INLINE Rgba mix(const Rgba& a, const Rgba& b, VF t) {
  auto one = [&](VF p, VF q) HWY_ATTR { return hn::Add(p, hn::Mul(hn::Sub(q, p), t)); };
  return {one(a.r, b.r), one(a.g, b.g), one(a.b, b.b), one(a.a, b.a)};
}

// One level per lane; u, v folded into [0, 1].
HWY_INLINE Rgba sampleLevel(const TextureView& t, const float* srgbToLinear, VF u, VF v, VI level, Filter filter) {
  const DF d;
  const DI di;
  HWY_ALIGN int32_t offsets[16], widths[16], heights[16];
  int32_t offset = 0;
  for (int k = 0; k < 16; ++k) {
    const int w = (t.width >> k) > 1 ? t.width >> k : 1, h = (t.height >> k) > 1 ? t.height >> k : 1;
    offsets[k] = offset;
    widths[k] = w;
    heights[k] = h;
    if (k + 1 < t.levels) offset += w * h;
  }
  const VI base = hn::GatherIndex(di, offsets, level), w = hn::GatherIndex(di, widths, level);
  const VI h = hn::GatherIndex(di, heights, level);
  const VF x = hn::Mul(u, hn::ConvertTo(d, w)), y = hn::Mul(v, hn::ConvertTo(d, h));
  auto at = [&](VI xi, VI yi) HWY_ATTR {
    return fetchTexel(t, srgbToLinear, hn::Add(base, hn::Add(hn::Mul(wrapTexel(yi, h, t.wrapV), w), wrapTexel(xi, w, t.wrapU))));
  };
  if (filter == Filter::Nearest) return at(hn::ConvertTo(di, x), hn::ConvertTo(di, y));
  const VF half = hn::Set(d, 0.5f);
  const VF xs = hn::Sub(x, half), ys = hn::Sub(y, half), xf = hn::Floor(xs), yf = hn::Floor(ys);
  const VI x0 = hn::ConvertTo(di, xf), y0 = hn::ConvertTo(di, yf);
  const VI x1 = hn::Add(x0, hn::Set(di, 1)), y1 = hn::Add(y0, hn::Set(di, 1));
  const VF fx = hn::Sub(xs, xf), fy = hn::Sub(ys, yf);
  return mix(mix(at(x0, y0), at(x1, y0), fx), mix(at(x0, y1), at(x1, y1), fx), fy);
}

// lod <= 0 magnifies. Only read where the sampler distinguishes.
HWY_INLINE Rgba sampleTexture(const TextureView& t, const float* srgbToLinear, VF u, VF v, VF lod) {
  const DF d;
  const DI di;
  u = wrapCoordinate(u, t.wrapU);
  v = wrapCoordinate(v, t.wrapV);
  const VF zero = hn::Zero(d), top = hn::Set(d, float(t.levels - 1));
  const MF magnified = hn::Not(hn::Gt(lod, zero));
  Rgba result;
  if (t.mip == MipFilter::None || t.levels == 1) {
    result = sampleLevel(t, srgbToLinear, u, v, hn::Zero(di), t.minFilter);
  } else {
    VF l = hn::IfThenElse(magnified, zero, lod);
    l = hn::IfThenElse(hn::Lt(l, top), l, top);
    if (t.mip == MipFilter::Nearest) {
      const VI level = hn::ConvertTo(di, hn::Floor(hn::Add(l, hn::Set(d, 0.5f))));
      result = sampleLevel(t, srgbToLinear, u, v, level, t.minFilter);
    } else {
      const VF l0 = hn::Floor(l);
      const VI level = hn::ConvertTo(di, l0);
      const VI next = hn::Min(hn::Add(level, hn::Set(di, 1)), hn::Set(di, t.levels - 1));
      result = mix(sampleLevel(t, srgbToLinear, u, v, level, t.minFilter),
                   sampleLevel(t, srgbToLinear, u, v, next, t.minFilter), hn::Sub(l, l0));
    }
  }
  if (t.magFilter == t.minFilter && (t.mip == MipFilter::None || t.levels == 1)) return result;
  if (hn::AllFalse(d, magnified)) return result;
  const Rgba m = sampleLevel(t, srgbToLinear, u, v, hn::Zero(di), t.magFilter);
  auto pick = [&](VF p, VF q) HWY_ATTR { return hn::IfThenElse(magnified, p, q); };
  return {pick(m.r, result.r), pick(m.g, result.g), pick(m.b, result.b), pick(m.a, result.a)};
}

// Whether lod is read at all.
HWY_INLINE bool needsLod(const TextureView& t) {
  return t.magFilter != t.minFilter || (t.mip != MipFilter::None && t.levels > 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
