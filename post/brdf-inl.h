// Per target: what a surface reflects, see brdf.h.
#if defined(OBSCURA_BRDF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_BRDF_INL_H_
#undef OBSCURA_BRDF_INL_H_
#else
#define OBSCURA_BRDF_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/post/brdf.h"
#include "obscura/post/projector.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Towards the eye from what pixels see: unit, in the space of the G-buffer's normals (x right, y up, z towards the eye).
class ViewDirections {
 public:
  explicit ViewDirections(const Projector& p) : p_(p) {}

  // Of pixel x and those right of it.
  HWY_INLINE V3 at(int x, int y) const {
    const DF d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    if (!p_.perspective) return {zero, zero, one};
    const VF px = hn::Add(hn::ConvertTo(d, hn::Iota(DI(), p_.xFirst + x)), hn::Set(d, 0.5f));
    const VF vx = hn::Mul(hn::Sub(hn::Set(d, p_.xCenter), px), hn::Set(d, p_.xInverse));
    const VF vy = hn::Set(d, (p_.yCenter - (float(p_.yFirst + y) + 0.5f)) * p_.yInverse);
    const VF perLength = hn::Div(one, hn::Sqrt(hn::Add(hn::Add(hn::Mul(vx, vx), hn::Mul(vy, vy)), one)));
    return {hn::Mul(vx, perLength), hn::Mul(vy, perLength), perLength};
  }

 private:
  const Projector p_;
};

// |n.v| as the BRDFs take it, kLeastFacing ... 1; that of a normal that is no number is the least.
HWY_INLINE VF facingOf(const V3& n, const V3& v) {
  const DF d;
  const VF cosine = hn::Abs(dot(n, v)), least = hn::Set(d, kLeastFacing), one = hn::Set(d, 1.0f);
  const VF enough = hn::IfThenElse(hn::Gt(cosine, least), cosine, least);
  return hn::IfThenElse(hn::Lt(enough, one), enough, one);
}

HWY_INLINE VF lerp(VF a, VF b, VF t) { return hn::Add(a, hn::Mul(hn::Sub(b, a), t)); }

// E and B / E.
struct Lobe {
  VF e, share;
};

// nv in [0, 1], roughness in [0, 1].
HWY_INLINE Lobe lobeOf(const uint32_t* table, VF nv, VF roughness) {
  const DF d;
  const DI di;
  const VF last = hn::Set(d, float(kBrdfTable - 1));
  const VI beforeLast = hn::Set(di, kBrdfTable - 2);
  const VF x = hn::Mul(hn::Sqrt(nv), last), y = hn::Mul(roughness, last);
  // The roughness of lanes beyond the image's edge may be any number.
  const VI column = hn::Min(truncated(x), beforeLast), row = hn::Max(hn::Min(truncated(y), beforeLast), hn::Zero(di));
  const VF tx = hn::Sub(x, hn::ConvertTo(d, column)), ty = hn::Sub(y, hn::ConvertTo(d, row));
  const VI at = hn::Add(hn::ShiftLeft<5>(row), column);
  static_assert(kBrdfTable == 32, "a shift by 5");
  const int32_t* t = reinterpret_cast<const int32_t*>(table);
  const VI t00 = hn::GatherIndex(di, t, at), t10 = hn::GatherIndex(di, t + 1, at);
  const VI t01 = hn::GatherIndex(di, t + kBrdfTable, at), t11 = hn::GatherIndex(di, t + kBrdfTable + 1, at);
  const auto lower = [](VI v) HWY_ATTR { return hn::ConvertTo(DF(), hn::And(v, hn::Set(DI(), 0xFFFF))); };
  const auto upper = [](VI v) HWY_ATTR { return hn::ConvertTo(DF(), hn::ShiftRight<16>(v)); };
  const VF unit = hn::Set(d, 1.0f / 32768);
  return {hn::Mul(lerp(lerp(lower(t00), lower(t10), tx), lerp(lower(t01), lower(t11), tx), ty), unit),
          hn::Mul(lerp(lerp(upper(t00), upper(t10), tx), lerp(upper(t01), upper(t11), tx), ty), unit)};
}

// x^p by repeated squaring; 0 <= x <= 1, 0 <= p < 2^14.
HWY_INLINE VF power(VF x, VI p) {
  const DF d;
  const DI di;
  VF result = hn::Set(d, 1.0f);
  for (int bit = 0; bit < 14; ++bit) {
    const MF set = hn::RebindMask(d, hn::Ne(hn::And(p, hn::Set(di, 1 << bit)), hn::Zero(di)));
    result = hn::IfThenElse(set, hn::Mul(result, x), result);
    x = hn::Mul(x, x);
  }
  return result;
}

// What a vector of pixels reflects: made once from the surface and v, then asked for the ambient light or for any number of
// lights. base, metallic, roughness and the normal n as in the G-buffer, v of ViewDirections. What is not asked for costs
// nothing once inlined; Lambert reads the base alone.
template <Brdf kBrdf>
class Reflection {
 public:
  HWY_INLINE Reflection(const V3& base, VF metallic, VF roughness, const V3& n, const V3& v) : n_(n), v_(v) {
    const DF d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    if constexpr (kBrdf == Brdf::Lambert) {
      diffuse = base;
      specular = {zero, zero, zero};
      return;
    }
    nv_ = facingOf(n, v);
    const VF metal = metallic, other = hn::Sub(one, metallic), f0 = hn::Set(d, kDielectric);
    const MF unlit = hn::RebindMask(d, hn::Lt(hn::BitCast(DI(), metallic), hn::Zero(DI())));  // the sign of -0
    const Lobe lobe = lobeOf(brdfTable(kBrdf), nv_, roughness);
    const VF notShare = hn::Sub(one, lobe.share), lost = hn::Sub(one, lobe.e);
    const auto fresnel = [&](VF f) HWY_ATTR { return hn::Add(lobe.share, hn::Mul(f, notShare)); };  // (F0 A + B) / E
    alpha_ = hn::Mul(roughness, roughness);
    if constexpr (kBrdf == Brdf::Gltf) {
      const VF least = hn::Set(d, kLeastAlpha);
      alpha_ = hn::IfThenElse(hn::Gt(alpha_, least), alpha_, least);
      // E k(F0): what there is with what one bounce loses.
      const auto regained = [&](VF f) HWY_ATTR { return hn::Add(lobe.e, hn::Mul(f, lost)); };
      const VF dielectric = hn::Mul(fresnel(f0), regained(f0)), ofOther = hn::Mul(other, dielectric);
      const VF under = hn::Sub(one, hn::Add(metal, ofOther));
      const VF perE = hn::Div(one, lobe.e), k = hn::Mul(regained(f0), perE);
      const auto channel = [&](VF c, VF& kd, VF& s, VF& normal, VF& grazing) HWY_ATTR {
        // In this form kd + s is 1 at c = 1, and not above 1 elsewhere, in float, too.
        kd = hn::Mul(c, under);
        s = hn::Add(hn::Mul(metal, hn::Mul(fresnel(c), regained(c))), ofOther);
        const VF kMetal = hn::Mul(metal, hn::Mul(regained(c), perE)), kOther = hn::Mul(other, k);
        normal = hn::Add(hn::Mul(kMetal, c), hn::Mul(kOther, f0));
        grazing = hn::Add(hn::Mul(kMetal, hn::Sub(one, c)), hn::Mul(kOther, hn::Sub(one, f0)));
      };
      channel(base.x, diffuse.x, specular.x, normal_.x, grazing_.x);
      channel(base.y, diffuse.y, specular.y, normal_.y, grazing_.y);
      channel(base.z, diffuse.z, specular.z, normal_.z, grazing_.z);
    } else {
      const auto channel = [&](VF c, VF& kd, VF& s, VF& normal, VF& grazing) HWY_ATTR {
        normal = hn::Add(hn::Mul(metal, c), hn::Mul(other, f0));
        grazing = hn::Sub(one, normal);
        s = hn::Mul(fresnel(normal), lobe.e);
        kd = hn::Mul(hn::Mul(other, c), hn::Sub(one, s));
      };
      channel(base.x, diffuse.x, specular.x, normal_.x, grazing_.x);
      channel(base.y, diffuse.y, specular.y, normal_.y, grazing_.y);
      channel(base.z, diffuse.z, specular.z, normal_.z, grazing_.z);
    }
    const auto keep = [&](V3& a) HWY_ATTR { a = {hn::IfThenZeroElse(unlit, a.x), hn::IfThenZeroElse(unlit, a.y), hn::IfThenZeroElse(unlit, a.z)}; };
    keep(diffuse);
    keep(specular);
    keep(normal_);
    keep(grazing_);
  }

  // R_A(v) in two parts: what is scattered below the surface, and what its facets reflect, which is S(v). Each >= 0, their
  // sum at most 1.
  V3 diffuse, specular;

  // f(l, v), 1 / sr: without the cosine at the light. l unit; nl = n.l > 0, any number where that is not so.
  HWY_INLINE V3 towards(const V3& l, VF nl) const {
    const DF d;
    const VF perPi = hn::Set(d, 0.318309886f);
    if constexpr (kBrdf == Brdf::Lambert) return {hn::Mul(diffuse.x, perPi), hn::Mul(diffuse.y, perPi), hn::Mul(diffuse.z, perPi)};
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    // h = (l + v) / |l + v|, so v.h = |l + v| / 2.
    const V3 h{hn::Add(l.x, v_.x), hn::Add(l.y, v_.y), hn::Add(l.z, v_.z)};
    const VF squared = dot(h, h), least = hn::Set(d, 1e-12f), square = hn::IfThenElse(hn::Gt(squared, least), squared, least);
    const VF outside = hn::Sub(one, hn::Mul(half, hn::Sqrt(square))), x = hn::IfThenElse(hn::Gt(outside, zero), outside, zero);
    const VF x2 = hn::Mul(x, x), schlick = hn::Mul(hn::Mul(x2, x2), x), lobe = lobeAt(nl, h, square);
    const auto channel = [&](VF normal, VF grazing, VF kd) HWY_ATTR {
      return hn::Add(hn::Mul(hn::Add(normal, hn::Mul(grazing, schlick)), lobe), hn::Mul(kd, perPi));
    };
    return {channel(normal_.x, grazing_.x, diffuse.x), channel(normal_.y, grazing_.y, diffuse.y), channel(normal_.z, grazing_.z, diffuse.z)};
  }

 private:
  // D V, or N (n.h)^p. h: l + v, of this squared length.
  HWY_INLINE VF lobeAt(VF nl, const V3& h, VF square) const {
    const DF d;
    const DI di;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f), alpha2 = hn::Mul(alpha_, alpha_);
    if constexpr (kBrdf == Brdf::Gltf) {
      const VF rest = hn::Sub(one, alpha2);
      const auto shadowed = [&](VF cosine) HWY_ATTR {
        return hn::Sqrt(hn::Add(hn::Mul(hn::Mul(cosine, cosine), rest), alpha2));
      };
      // The sine has all its digits where 1 - (n.h)^2 has none left.
      const V3 across = cross(n_, h);
      const VF sine2 = hn::Div(dot(across, across), square);
      const VF t = hn::Add(hn::Mul(hn::IfThenElse(hn::Lt(sine2, one), sine2, one), rest), alpha2);
      const VF visibility = hn::Add(hn::Mul(nl, shadowed(nv_)), hn::Mul(nv_, shadowed(nl)));
      return hn::Div(hn::Mul(alpha2, hn::Set(d, 0.159154943f)), hn::Mul(hn::Mul(t, t), visibility));
    }
    const VF two = hn::Set(d, 2.0f), most = hn::Set(d, kMostShininess), rootHalf = hn::Set(d, 0.707106781f);
    VF p = hn::Sub(hn::Div(two, alpha2), two);
    p = hn::IfThenElse(hn::Lt(p, most), p, most);
    p = hn::IfThenElse(hn::Gt(p, one), p, one);
    const VI whole = truncated(p);
    const VF part = hn::Sub(p, hn::ConvertTo(d, whole));
    const auto raised = [&](VF x, VF toWhole) HWY_ATTR { return lerp(toWhole, hn::Mul(toWhole, x), part); };
    // 2^(-p/2), and far less than p where it is not that.
    const VI halves = hn::Min(hn::ShiftRight<1>(whole), hn::Set(di, 100));
    const MF odd = hn::RebindMask(d, hn::Ne(hn::And(whole, hn::Set(di, 1)), hn::Zero(di)));
    const VF even = hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 127), halves)));
    const VF small = raised(rootHalf, hn::IfThenElse(odd, hn::Mul(even, rootHalf), even));
    const VF scale = hn::Div(hn::Mul(hn::Add(p, two), hn::Add(p, hn::Set(d, 4.0f))), hn::Mul(hn::Set(d, 25.1327412f), hn::Add(p, small)));
    const VF cosine = hn::Div(dot(n_, h), hn::Sqrt(square)), nh = hn::IfThenElse(hn::Lt(cosine, one), cosine, one);
    const VF positive = hn::IfThenElseZero(hn::Gt(nh, zero), nh);
    VF highlight = raised(positive, power(positive, whole));
    if constexpr (kBrdf == Brdf::BlinnPhongThresholded)
      highlight = hn::IfThenElseZero(hn::Ge(highlight, hn::Set(d, 0.5f)), hn::Set(d, kThresholded));
    return hn::Mul(scale, highlight);
  }

  V3 n_, v_;
  VF nv_, alpha_;
  V3 normal_, grazing_;  // F0 and 1 - F0 of what reflects, with what k gives back
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
