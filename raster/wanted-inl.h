// Per-target: what the planes of a frame ask for of a material, and the ranges that they hold.
#if defined(OBSCURA_WANTED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_WANTED_INL_H_
#undef OBSCURA_WANTED_INL_H_
#else
#define OBSCURA_WANTED_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/raster/gbuffer.h"
#include "obscura/raster/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

struct Wanted {
  bool normal, facet, albedo, emissive, gloss, draws;  // gloss: metallic or roughness; draws: instance or material
  explicit Wanted(const GBuffer& g)
      : normal(!g.normal[0].empty()), facet(!g.facet[0].empty()), albedo(!g.albedo[0].empty()), emissive(!g.emissive[0].empty()),
        gloss(!g.metallic.empty() || !g.roughness.empty()),
        draws(!g.instance.empty() || !g.material.empty()) {}
  bool surfaces() const { return normal || facet || albedo || emissive || gloss; }
};

// The base colour is asked for and differs from pixel to pixel.
HWY_INLINE bool variesInColor(const Draw& draw, const Wanted& wanted) {
  const Material& m = *draw.material;
  return (m.unlit ? wanted.emissive : wanted.albedo) && (m.baseColorMap.texture >= 0 || !draw.mesh->colors.empty());
}

HWY_INLINE bool variesInEmission(const Draw& draw, const Wanted& wanted) {
  return wanted.emissive && !draw.material->unlit && draw.material->emissiveMap.texture >= 0;
}

HWY_INLINE bool variesInGloss(const Draw& draw, const Wanted& wanted) {
  return wanted.gloss && !draw.material->unlit && draw.material->metallicRoughnessMap.texture >= 0;
}

HWY_INLINE bool mapsNormals(const Draw& draw, const Wanted& wanted) {
  return wanted.normal && draw.material->normalMap.texture >= 0 && draw.material->heightMap.texture < 0;
}

// Attributes other than interpolated normals and constant colours.
HWY_INLINE bool needsMore(const Draw& draw, const Wanted& wanted) {
  return variesInColor(draw, wanted) || variesInEmission(draw, wanted) || variesInGloss(draw, wanted) || mapsNormals(draw, wanted);
}

// [0, 1]; NaN is 0.
HWY_INLINE VF unitRange(VF v) {
  const DF d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const VF positive = hn::IfThenElseZero(hn::Gt(v, zero), v);
  return hn::IfThenElse(hn::Lt(positive, one), positive, one);
}

HWY_INLINE VF nonNegative(VF v) {
  const DF d;
  return hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), v);
}

HWY_INLINE V3 albedoOf(VF r, VF g, VF b) { return {unitRange(r), unitRange(g), unitRange(b)}; }
HWY_INLINE V3 emissionOf(VF r, VF g, VF b) { return {nonNegative(r), nonNegative(g), nonNegative(b)}; }

struct Gloss {
  VF metallic, roughness;
};
HWY_INLINE Gloss constantGloss(const Material& m) {
  const DF d;
  if (m.unlit) return {hn::Set(d, -0.0f), hn::Set(d, 1.0f)};
  return {unitRange(hn::Set(d, m.metallic)), unitRange(hn::Set(d, m.roughness))};
}
HWY_INLINE Gloss glossOf(const Material& m, VF green, VF blue) {
  const DF d;
  return {unitRange(hn::Mul(hn::Set(d, m.metallic), blue)), unitRange(hn::Mul(hn::Set(d, m.roughness), green))};
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
