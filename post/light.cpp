#include "obscura/post/light.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/light.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/brdf-inl.h"
#include "obscura/post/instance_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

constexpr float kMost = std::numeric_limits<float>::max(), kInfinity = std::numeric_limits<float>::infinity();

HWY_INLINE V3 loaded(const raster::Plane<float> (&planes)[3], int x, int y) {
  const DF d;
  return {hn::LoadU(d, planes[0].row(y) + x), hn::LoadU(d, planes[1].row(y) + x), hn::LoadU(d, planes[2].row(y) + x)};
}

struct Ambients {
  V3 la;             // L D + A
  V3 factor, added;  // D and A; only with directions, A only if they add light
};

// For vectors of pixels. Which of its parts there are is the same for all of a frame.
template <bool kVaries>
class Ambient {
 public:
  Ambient(const raster::GBuffer& g, const AmbientLight& in) : g_(g), in_(in), adds_(in.adds()) {
    mean_.color = mean_.added = glm::vec3(0);
    for (const AmbientDirection& k : in.directions) mean_.color += k.color, mean_.added += k.added;
    if (!in.directions.empty()) mean_.color /= float(in.directions.size()), mean_.added /= float(in.directions.size());
  }

  bool directed() const { return kVaries && !in_.directions.empty(); }
  bool adds() const { return kVaries && adds_; }

  HWY_INLINE Ambients at(int x, int y) const {
    const DF d;
    Ambients out;
    V3& la = out.la;
    la = {hn::Set(d, in_.color.x), hn::Set(d, in_.color.y), hn::Set(d, in_.color.z)};
    if (!kVaries) return out;
    if (in_.environment) la = ofEnvironment(x, y);
    if (!in_.instances.empty()) la = orOfInstance(in_.instances, g_.instance, x, y, la);
    if (!directed()) return out;
    byNormal(x, y, out);
    la = product(la, out.factor);
    if (adds()) la = sum(la, out.added);
    return out;
  }

 private:
  static HWY_INLINE V3 product(const V3& a, const V3& b) { return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)}; }
  static HWY_INLINE V3 sum(const V3& a, const V3& b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
  static HWY_INLINE V3 weighted(VF weight, const glm::vec3& color) {
    const DF d;
    return {hn::Mul(weight, hn::Set(d, color.x)), hn::Mul(weight, hn::Set(d, color.y)), hn::Mul(weight, hn::Set(d, color.z))};
  }
  static HWY_INLINE V3 quotient(MF sound, const V3& sum, VF by, const glm::vec3& otherwise) {
    const DF d;
    return {hn::IfThenElse(sound, hn::Div(sum.x, by), hn::Set(d, otherwise.x)), hn::IfThenElse(sound, hn::Div(sum.y, by), hn::Set(d, otherwise.y)),
            hn::IfThenElse(sound, hn::Div(sum.z, by), hn::Set(d, otherwise.z))};
  }

  // One channel of the quadratic form.
  static HWY_INLINE VF quadric(const NormalQuadric& q, int c, const V3& n) {
    const DF d;
    const auto times = [&](float factor, VF v) { return hn::Mul(hn::Set(d, factor), v); };
    const VF x = hn::Add(hn::Add(hn::Add(times(q.xx[c], n.x), times(q.xy[c], n.y)), times(q.xz[c], n.z)), hn::Set(d, q.x[c]));
    const VF y = hn::Add(hn::Add(times(q.yy[c], n.y), times(q.yz[c], n.z)), hn::Set(d, q.y[c]));
    const VF z = hn::Add(times(q.zz[c], n.z), hn::Set(d, q.z[c]));
    const VF sum = hn::Add(hn::Add(hn::Add(hn::Mul(x, n.x), hn::Mul(y, n.y)), hn::Mul(z, n.z)), hn::Set(d, q.constant[c]));
    const VF most = hn::Set(d, q.most[c]);
    return hn::IfThenElseZero(hn::Gt(sum, hn::Zero(d)), hn::IfThenElse(hn::Lt(sum, most), sum, most));
  }

  HWY_NOINLINE V3 ofEnvironment(int x, int y) const {
    const V3 n = loaded(g_.normal, x, y);
    const NormalQuadric& q = *in_.environment;
    return {quadric(q, 0, n), quadric(q, 1, n), quadric(q, 2, n)};
  }

  // D and A.
  HWY_INLINE void byNormal(int x, int y, Ambients& out) const {
    const DF d;
    const VF zero = hn::Zero(d);
    const V3 n = loaded(g_.normal, x, y);
    V3 factors{zero, zero, zero}, lights{zero, zero, zero};
    VF weights = zero;
    for (const AmbientDirection& k : in_.directions) {
      const VF facing = dot(n, {hn::Set(d, k.direction.x), hn::Set(d, k.direction.y), hn::Set(d, k.direction.z)});
      const VF weight = hn::IfThenElseZero(hn::Gt(facing, zero), facing);
      weights = hn::Add(weights, weight);
      factors = sum(factors, weighted(weight, k.color));
      if (adds()) lights = sum(lights, weighted(weight, k.added));
    }
    const MF sound = hn::And(hn::Gt(weights, zero), hn::Lt(weights, hn::Set(d, 1e8f)));
    const VF by = hn::IfThenElse(sound, weights, hn::Set(d, 1.0f));
    out.factor = quotient(sound, factors, by, mean_.color);
    if (adds()) out.added = quotient(sound, lights, by, mean_.added);
  }

  const raster::GBuffer& g_;
  const AmbientLight& in_;
  const bool adds_;
  AmbientDirection mean_;  // of the directions' colours
};

HWY_INLINE MF seenAt(const raster::GBuffer& g, int x, int y) {
  return hn::Lt(hn::LoadU(DF(), g.depth.row(y) + x), hn::Set(DF(), kInfinity));
}

HWY_INLINE bool isZero(const V3& v) {
  const DF d;
  return hn::AllTrue(d, hn::Eq(hn::Max(hn::Max(v.x, v.y), v.z), hn::Zero(d)));  // v >= 0
}

// R_A(v), or its two parts where each gets another light.
struct Reflectances {
  V3 ambient, mirrored;
};

template <Brdf kBrdf>
HWY_INLINE Reflectances reflectances(const raster::GBuffer& g, const ViewDirections& directions, bool apart, int x, int y) {
  const DF d;
  const V3 base = loaded(g.albedo, x, y);
  if constexpr (!isGlossy(kBrdf)) return {base, base};
  const Reflection<kBrdf> r(base, hn::LoadU(d, g.metallic.row(y) + x), hn::LoadU(d, g.roughness.row(y) + x), loaded(g.normal, x, y),
                            directions.at(x, y));
  if (apart) return {r.diffuse, r.specular};
  return {{hn::Add(r.diffuse.x, r.specular.x), hn::Add(r.diffuse.y, r.specular.y), hn::Add(r.diffuse.z, r.specular.z)}, r.specular};
}

template <bool kVaries, Brdf kBrdf>
void lightRows(const LightInput& in, int y0, int y1, LinearColor& out) {
  const DF d;
  const raster::GBuffer& g = *in.g;
  const Ambient<kVaries> ambient(g, in.ambient);
  const ViewDirections directions(in.projector);
  const bool emits = !g.emissive[0].empty();
  const bool bounced = in.occlusion == Occlusion::Transfer && !in.transfer->bounced[0].empty();
  const bool obscured = in.occlusion == Occlusion::Obscurance || bounced;
  const bool mirrors = isGlossy(kBrdf) && in.reflected;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < g.width; x += int(hn::Lanes(d))) {
      const MF seen = seenAt(g, x, y);
      if (hn::AllFalse(d, seen)) {
        for (int c = 0; c < 3; ++c) hn::StoreU(hn::Set(d, in.background[c]), d, out.rgb[c].row(y) + x);
        continue;
      }
      const Ambients arriving = ambient.at(x, y);
      const bool dark = isGlossy(kBrdf) && !mirrors && !bounced && isZero(arriving.la);  // so is what is reflected of it, R_A being finite
      const Reflectances r = dark ? Reflectances{arriving.la, arriving.la} : reflectances<kBrdf>(g, directions, mirrors, x, y);
      const VF channels[3] = {arriving.la.x, arriving.la.y, arriving.la.z}, colors[3] = {r.ambient.x, r.ambient.y, r.ambient.z};
      const VF mirrored[3] = {r.mirrored.x, r.mirrored.y, r.mirrored.z};
      const VF factors[3] = {arriving.factor.x, arriving.factor.y, arriving.factor.z};
      const VF added[3] = {arriving.added.x, arriving.added.y, arriving.added.z};
      for (int c = 0; c < 3; ++c) {
        VF color = colors[c];
        const auto dimmed = [&](VF v) {  // by O or W
          if (obscured) return hn::Mul(v, hn::LoadU(d, in.transfer->obscurance.row(y) + x));
          if (in.occlusion == Occlusion::Transfer) return hn::Mul(v, hn::LoadU(d, in.transfer->w[c].row(y) + x));
          return v;
        };
        if (bounced) {
          color = hn::Mul(color, hn::Add(dimmed(channels[c]), hn::LoadU(d, in.transfer->bounced[c].row(y) + x)));
        } else {
          color = hn::Mul(dimmed(color), channels[c]);
        }
        if (mirrors) {
          const VF share = ambient.directed() ? hn::Mul(mirrored[c], factors[c]) : mirrored[c];
          color = hn::Add(color, hn::Mul(share, hn::LoadU(d, in.reflected->rgb[c].row(y) + x)));
          if (ambient.adds()) color = hn::Add(color, hn::Mul(dimmed(mirrored[c]), added[c]));
        }
        if (in.direct) color = hn::Add(color, hn::LoadU(d, in.direct->rgb[c].row(y) + x));
        if (emits) color = hn::Add(color, hn::LoadU(d, g.emissive[c].row(y) + x));
        hn::StoreU(hn::IfThenElse(seen, color, hn::Set(d, in.background[c])), d, out.rgb[c].row(y) + x);
      }
    }
}

template <bool kVaries>
void lightBy(const LightInput& in, int y0, int y1, LinearColor& out) {
  switch (in.brdf) {
    case Brdf::Lambert: return lightRows<kVaries, Brdf::Lambert>(in, y0, y1, out);
    case Brdf::Gltf: return lightRows<kVaries, Brdf::Gltf>(in, y0, y1, out);
    case Brdf::BlinnPhong: return lightRows<kVaries, Brdf::BlinnPhong>(in, y0, y1, out);
    case Brdf::BlinnPhongThresholded: return lightRows<kVaries, Brdf::BlinnPhongThresholded>(in, y0, y1, out);
  }
}

void Light(const LightInput& in, int y0, int y1, LinearColor& out) {
  const bool varies = in.ambient.needsInstance() || in.ambient.needsNormal();
  varies ? lightBy<true>(in, y0, y1, out) : lightBy<false>(in, y0, y1, out);
}

void TransferOfBounced(const LightInput& in, int y0, int y1, raster::Plane<float>* w) {
  const DF d;
  const raster::GBuffer& g = *in.g;
  const Ambient<true> ambient(g, in.ambient);
  const VF one = hn::Set(d, 1.0f);
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < g.width; x += int(hn::Lanes(d))) {
      const MF seen = seenAt(g, x, y);
      const V3 la = ambient.at(x, y).la;
      const VF channels[3] = {la.x, la.y, la.z}, o = hn::LoadU(d, in.transfer->obscurance.row(y) + x);
      for (int c = 0; c < 3; ++c) {
        const MF lit = hn::Gt(channels[c], hn::Zero(d));
        const VF added = hn::Div(hn::LoadU(d, in.transfer->bounced[c].row(y) + x), hn::IfThenElse(lit, channels[c], one));
        const VF sum = hn::Min(hn::Add(o, hn::IfThenElseZero(lit, added)), hn::Set(d, kMost));
        hn::StoreU(hn::IfThenElse(seen, sum, one), d, w[c].row(y) + x);
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
HWY_EXPORT(TransferOfBounced);

void light(const LightInput& in, int y0, int y1, LinearColor& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(Light, target)(in, y0, y1, out);
}

void transferOfBounced(const LightInput& in, int y0, int y1, raster::Plane<float> (&w)[3], raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(TransferOfBounced, target)(in, y0, y1, w);
}

LinearColor makeLinearColor(int width, int height, LinearColor used) {
  for (auto& plane : used.rgb) plane.resize(width, height);
  return used;
}

}  // namespace obscura::post
#endif
