// Per-target: the attributes of a vector of pixels.
#if defined(OBSCURA_SHADE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_SHADE_INL_H_
#undef OBSCURA_SHADE_INL_H_
#else
#define OBSCURA_SHADE_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/raster/cell-inl.h"
#include "obscura/raster/wanted-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// The triangles that a vector of pixels shows.
struct VectorTriangles {
  const CellTriangles& cell;
  const uint16_t* slot;  // their numbers in the cell
  int count;
  int draws;             // how many of the first of them must be looked at to see every draw; 1 if there is only one
  VU id;                 // per pixel

  const Draw& draw(int k) const { return *cell.draw[slot[k]]; }
  HWY_INLINE MF shows(int k) const { return hn::RebindMask(DF(), hn::Eq(id, hn::Set(DU(), cell.id[slot[k]]))); }
  HWY_INLINE MF showsDraw(const Draw& draw) const {
    const DU d;
    return hn::RebindMask(DF(), hn::Lt(hn::Sub(id, hn::Set(d, draw.firstTriangle)), hn::Set(d, draw.triangleCount)));
  }
  bool firstOfItsDraw(int k) const {
    for (int j = 0; j < k; ++j)
      if (&draw(j) == &draw(k)) return false;
    return true;
  }
};

HWY_INLINE Seen weightsOf(const VectorTriangles& t, VF dx, VF dy) {
  const CellTriangles& cell = t.cell;
  auto planes = [&](int k) HWY_ATTR {
    const int slot = t.slot[k];
    auto plane = [&](int i) HWY_ATTR { return planeAt(cell.c[i][slot], cell.gx[i][slot], cell.gy[i][slot], dx, dy); };
    return V3{plane(0), plane(1), plane(2)};
  };
  V3 b = planes(0);
  for (int k = 1; k < t.count; ++k) b = select(t.shows(k), planes(k), b);
  Seen s;
  s.one = t.count == 1;
  weigh(b, s);
  return s;
}

HWY_INLINE V3 interpolatedNormal(const VectorTriangles& t, const Seen& s) {
  const DF d;
  auto normal = [&](int k) HWY_ATTR {
    auto component = [&](int c) HWY_ATTR {
      auto of = [&](int i) HWY_ATTR { return hn::Set(d, t.cell.normal[3 * i + c][t.slot[k]]); };
      return hn::Add(of(0), hn::Add(hn::Mul(of(1), s.weight[1]), hn::Mul(of(2), s.weight[2])));
    };
    return V3{component(0), component(1), component(2)};
  };
  V3 n = normal(0);
  for (int k = 1; k < t.count; ++k) n = select(t.shows(k), normal(k), n);
  return n;
}

HWY_INLINE V3 facetOf(const VectorTriangles& t) {
  const DF d;
  auto facet = [&](int k) HWY_ATTR {
    const int slot = t.slot[k];
    return V3{hn::Set(d, t.cell.facet[0][slot]), hn::Set(d, t.cell.facet[1][slot]), hn::Set(d, t.cell.facet[2][slot])};
  };
  V3 f = facet(0);
  for (int k = 1; k < t.count; ++k) f = select(t.shows(k), facet(k), f);
  return f;
}

struct Shaded {
  V3 normal, facet, albedo, emissive;
  Gloss gloss;
};

HWY_INLINE Gloss select(MF mask, const Gloss& yes, const Gloss& no) {
  return {hn::IfThenElse(mask, yes.metallic, no.metallic), hn::IfThenElse(mask, yes.roughness, no.roughness)};
}

// What the material says of albedo, emission and gloss.
HWY_INLINE void constantColors(const VectorTriangles& t, const Wanted& wanted, Shaded& out) {
  const DF d;
  V3 &albedo = out.albedo, &emission = out.emissive;
  auto set = [&](const auto& c) HWY_ATTR { return V3{hn::Set(d, c.r), hn::Set(d, c.g), hn::Set(d, c.b)}; };
  const V3 none{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int k = 0; k < t.draws; ++k) {
    const Draw& draw = t.draw(k);
    if (k > 0 && &draw == &t.draw(0)) continue;
    const Material& m = *draw.material;
    const V3 c = set(m.baseColor), e = set(m.emissive), base = albedoOf(c.x, c.y, c.z);
    const MF mine = t.showsDraw(draw);
    const V3 a = m.unlit ? none : base;
    albedo = k == 0 ? a : select(mine, a, albedo);
    if (wanted.gloss) out.gloss = k == 0 ? constantGloss(m) : select(mine, constantGloss(m), out.gloss);
    if (!wanted.emissive) continue;
    const V3 light = m.unlit ? base : emissionOf(e.x, e.y, e.z);
    emission = k == 0 ? light : select(mine, light, emission);
  }
}

// The pixels of one draw: what its textures and vertex colours say, and normals where the vertices' give none.
HWY_NOINLINE void shadeDraw(const SurfaceContext& context, const Draw& draw, const Wanted& wanted, const VectorTriangles& t, MF noNormal,
                            const Seen& weights, Shaded& out) {
  const DF d;
  const DI di;
  const MF mine = t.showsDraw(draw);
  Seen s = weights;
  bool found = false;
  for (int k = 0; k < t.count; ++k) {
    if (&t.draw(k) != &draw) continue;
    const int slot = t.slot[k];
    const MF triangle = t.shows(k);
    s.one = !found;
    for (int i = 0; i < 3; ++i) {
      const VI vertex = hn::Set(di, t.cell.vertex[i][slot]);
      const VF gx = hn::Set(d, t.cell.gx[i][slot]), gy = hn::Set(d, t.cell.gy[i][slot]);
      s.vertex[i] = uint32_t(t.cell.vertex[i][slot]);
      s.index[i] = found ? hn::IfThenElse(hn::RebindMask(di, triangle), vertex, s.index[i]) : vertex;
      s.gx[i] = found ? hn::IfThenElse(triangle, gx, s.gx[i]) : gx;
      s.gy[i] = found ? hn::IfThenElse(triangle, gy, s.gy[i]) : gy;
    }
    found = true;
  }
  const Material& m = *draw.material;
  if (!hn::AllFalse(d, hn::And(mine, noNormal))) {
    const V3 object[3] = {corner3(s, draw.mesh->positions, 0), corner3(s, draw.mesh->positions, 1), corner3(s, draw.mesh->positions, 2)};
    out.normal = select(hn::And(mine, noNormal), flatNormal(draw, object), out.normal);
  }
  if (mapsNormals(draw, wanted)) out.normal = select(mine, mappedNormal(context, draw, s, out.normal), out.normal);
  if (variesInColor(draw, wanted)) {
    const Rgba color = baseColor(context, draw, s);
    V3& base = m.unlit ? out.emissive : out.albedo;
    base = select(mine, albedoOf(color.r, color.g, color.b), base);
  }
  if (variesInEmission(draw, wanted)) {
    const Rgba e = sampleSlot(context, draw, s, m.emissiveMap);
    auto times = [&](float factor, VF v) HWY_ATTR { return hn::Mul(hn::Set(d, factor), v); };
    out.emissive = select(mine, emissionOf(times(m.emissive.r, e.r), times(m.emissive.g, e.g), times(m.emissive.b, e.b)), out.emissive);
  }
  if (variesInGloss(draw, wanted)) {
    const Rgba texel = sampleSlot(context, draw, s, m.metallicRoughnessMap);
    out.gloss = select(mine, glossOf(m, texel.g, texel.b), out.gloss);
  }
}

// dx, dy: pixels from the cell's first. Zero where not covered.
HWY_INLINE Shaded shade(const SurfaceContext& context, const Wanted& wanted, const VectorTriangles& t, MF covered, VF dx, VF dy) {
  const DF d;
  const VF zero = hn::Zero(d);
  const V3 none{zero, zero, zero};
  Shaded out{none, none, none, none, {zero, zero}};
  if (t.count == 0) return out;
  const MF nowhere = hn::Lt(zero, zero);
  MF noNormal = nowhere, behind = nowhere;
  bool more = false;
  for (int k = 0; k < t.draws; ++k) more |= needsMore(t.draw(k), wanted);
  Seen s;
  if (wanted.normal || more) s = weightsOf(t, dx, dy);
  if (wanted.normal) {
    const V3 n = interpolatedNormal(t, s);
    out.normal = normalizeOr(n, none);
    noNormal = hn::AndNot(hasDirection(n), covered);
    for (int k = 0; k < t.draws; ++k)
      if (t.draw(k).material->doubleSided)
        behind = hn::Or(behind, hn::And(t.showsDraw(t.draw(k)), t.draw(k).mirrored ? hn::Not(s.clockwise) : s.clockwise));
  }
  if (wanted.facet) out.facet = facetOf(t);
  constantColors(t, wanted, out);
  if (HWY_UNLIKELY(more || !hn::AllFalse(d, noNormal)))
    for (int k = 0; k < t.draws; ++k)
      if (t.firstOfItsDraw(k)) shadeDraw(context, t.draw(k), wanted, t, noNormal, s, out);
  out.normal = select(behind, {hn::Neg(out.normal.x), hn::Neg(out.normal.y), hn::Neg(out.normal.z)}, out.normal);
  return {select(covered, out.normal, none), select(covered, out.facet, none), select(covered, out.albedo, none),
          select(covered, out.emissive, none), select(covered, out.gloss, {zero, zero})};
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
