#include "obscura/post/environment_reflection.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/environment_reflection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/brdf-inl.h"
#include "obscura/post/cube_look_up-inl.h"
#include "obscura/post/instance_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Trilinear look-ups in a chain.
class Chain {
 public:
  explicit Chain(const EnvironmentChain& chain) : texels_(chain.texels.data()) {
    for (int k = 0; k < kRoughnessLevels; ++k) sizes_[k] = chain.sizes[k], firsts_[k] = chain.first(k);
  }

  // roughness in [0, 1].
  HWY_INLINE V3 at(const V3& direction, VF roughness) const {
    const DF d;
    const DI di;
    const CubePoint p = cubePointOf(direction);
    const VF level = hn::Mul(roughness, hn::Set(d, float(kRoughnessLevels - 1)));
    const VI k = truncated(level);
    const VF part = hn::Sub(level, hn::ConvertTo(d, k));
    const V3 fine = cubeLookUp(texels_, p, hn::GatherIndex(di, sizes_, k), hn::GatherIndex(di, firsts_, k));
    if (hn::AllTrue(d, hn::Eq(part, hn::Zero(d)))) return fine;  // as of smooth and of wholly rough things: adds 0
    const VI next = hn::Min(hn::Add(k, hn::Set(di, 1)), hn::Set(di, kRoughnessLevels - 1));
    const V3 coarse = cubeLookUp(texels_, p, hn::GatherIndex(di, sizes_, next), hn::GatherIndex(di, firsts_, next));
    return {lerp(fine.x, coarse.x, part), lerp(fine.y, coarse.y, part), lerp(fine.z, coarse.z, part)};
  }

 private:
  const glm::vec3* texels_;
  int32_t sizes_[kRoughnessLevels], firsts_[kRoughnessLevels];
};

// Along which the light of a lobe around r is looked up.
HWY_INLINE V3 dominant(const V3& n, const V3& r, VF roughness) {
  const VF alpha = hn::Mul(roughness, roughness), s = hn::Sub(hn::Set(DF(), 1.0f), alpha), f = hn::Mul(s, hn::Add(hn::Sqrt(s), alpha));
  return {lerp(n.x, r.x, f), lerp(n.y, r.y, f), lerp(n.z, r.z, f)};
}

HWY_INLINE VF specularOcclusion(VF o, VF nv, VF roughness) {
  const DF d;
  const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const VF smooth = hn::Sub(one, roughness), s2 = hn::Mul(smooth, smooth), s4 = hn::Mul(s2, s2), s10 = hn::Mul(hn::Mul(s4, s4), s2);
  const VF value = hn::Add(o, hn::Mul(hn::Sub(hn::Sqrt(hn::Add(nv, o)), one), s10));
  return hn::IfThenElseZero(hn::Gt(value, zero), hn::IfThenElse(hn::Lt(value, one), value, one));
}

void EnvironmentReflection(const ReflectionInput& in, int y0, int y1, LinearColor& out) {
  const DF d;
  const raster::GBuffer& g = *in.g;
  const Chain chain(in.environment.chain);
  const ViewDirections directions(in.projector);
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity()), intensity = hn::Set(d, in.environment.intensity);
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < g.width; x += int(hn::Lanes(d))) {
      const MF seen = hn::Lt(hn::LoadU(d, g.depth.row(y) + x), infinity);
      if (hn::AllFalse(d, seen)) continue;
      const V3 v = directions.at(x, y), n{hn::LoadU(d, g.normal[0].row(y) + x), hn::LoadU(d, g.normal[1].row(y) + x), hn::LoadU(d, g.normal[2].row(y) + x)};
      const VF given = hn::LoadU(d, g.roughness.row(y) + x), kept = hn::IfThenElse(hn::Lt(given, one), given, one);
      const VF roughness = hn::IfThenElseZero(hn::And(seen, hn::Gt(kept, zero)), kept);
      const VF cosine = dot(n, v), twice = hn::Add(cosine, cosine);
      const V3 r{hn::Sub(hn::Mul(twice, n.x), v.x), hn::Sub(hn::Mul(twice, n.y), v.y), hn::Sub(hn::Mul(twice, n.z), v.z)};
      V3 light = chain.at(turned(in.environment.mapFromView, dominant(n, r, roughness)), roughness);
      light = {hn::Mul(light.x, intensity), hn::Mul(light.y, intensity), hn::Mul(light.z, intensity)};
      if (!in.instances.empty()) light = orOfInstance(in.instances, g.instance, x, y, light);
      if (in.obscurance) {
        const VF o = specularOcclusion(hn::LoadU(d, in.obscurance->row(y) + x), facingOf(n, v), roughness);
        light = {hn::Mul(light.x, o), hn::Mul(light.y, o), hn::Mul(light.z, o)};
      }
      hn::StoreU(light.x, d, out.rgb[0].row(y) + x);
      hn::StoreU(light.y, d, out.rgb[1].row(y) + x);
      hn::StoreU(light.z, d, out.rgb[2].row(y) + x);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(EnvironmentReflection);

void environmentReflection(const ReflectionInput& in, int y0, int y1, LinearColor& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(EnvironmentReflection, target)(in, y0, y1, out);
}

}  // namespace obscura::post
#endif
