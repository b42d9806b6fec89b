#include "obscura/raster/resolve.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/resolve.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

HWY_INLINE V3 rotate(const float m[3][3], const V3& n) {
  const DF d;
  auto row = [&](const float r[3]) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, r[0]), n.x), hn::Mul(hn::Set(d, r[1]), n.y)), hn::Mul(hn::Set(d, r[2]), n.z));
  };
  return {row(m[0]), row(m[1]), row(m[2])};
}

// Unit vector, or `otherwise` where v has no direction: zero, not finite, or its square out of float's range.
HWY_INLINE V3 normalizeOr(const V3& v, const V3& otherwise) {
  const DF d;
  const VF square = dot(v, v);
  const MF usable = hn::And(hn::Ge(square, hn::Set(d, 1e-36f)), hn::Le(square, hn::Set(d, 1e36f)));
  const VF length = hn::Sqrt(hn::IfThenElse(usable, square, hn::Set(d, 1.0f)));
  return select(usable, {hn::Div(v.x, length), hn::Div(v.y, length), hn::Div(v.z, length)}, otherwise);
}

// Tangent-space normal of the material's map, applied to the unit normal n (camera space, not yet turned to the eye).
HWY_NOINLINE V3 mappedNormal(const SurfaceContext& context, const Draw& draw, const Seen& s, const V3& n) {
  const DF d;
  const Material& m = *draw.material;
  const Rgba texel = sampleSlot(context, draw, s, m.normalMap);
  const VF two = hn::Set(d, 2.0f), one = hn::Set(d, 1.0f), zero = hn::Zero(d), strength = hn::Set(d, m.normalScale);
  auto component = [&](VF c) HWY_ATTR { return hn::Sub(hn::Mul(c, two), one); };
  V3 t, tangent;
  t.x = hn::Mul(component(texel.r), strength);
  t.y = hn::Mul(component(texel.g), strength);
  t.z = component(texel.b);
  VF sign = one;
  const Span<const glm::vec4> tangents = draw.mesh->tangents;
  if (!tangents.empty()) {
    tangent = {interpolateComponent(tangents, s, 0), interpolateComponent(tangents, s, 1), interpolateComponent(tangents, s, 2)};
    sign = hn::IfThenElse(hn::Lt(interpolateComponent(tangents, s, 3), zero), hn::Set(d, -1.0f), one);
  } else if (!draw.mesh->uvs[m.normalMap.uvSet].empty()) {
    // The direction in which u grows on the triangle: e1 dv2 - e2 dv1, turned round where uv is mirrored.
    const Span<const glm::vec2> uvs = draw.mesh->uvs[m.normalMap.uvSet];
    VF u[3], v[3];
    gatherComponent(uvs, s, 0, u);
    gatherComponent(uvs, s, 1, v);
    const VF du1 = hn::Sub(u[1], u[0]), du2 = hn::Sub(u[2], u[0]), dv1 = hn::Sub(v[1], v[0]), dv2 = hn::Sub(v[2], v[0]);
    const V3 along = sub(scale(sub(s.object[1], s.object[0]), dv2), scale(sub(s.object[2], s.object[0]), dv1));
    // glTF's v points down the image and its bitangent up, hence the sign for a right-handed frame is that of -det.
    const MF mirrored = hn::Lt(hn::Sub(hn::Mul(du1, dv2), hn::Mul(du2, dv1)), zero);
    const VF turn = hn::IfThenElse(mirrored, hn::Set(d, -1.0f), one);
    tangent = scale(along, turn);
    sign = hn::Neg(turn);
  } else {
    return n;
  }
  float direction[3][3];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) direction[r][c] = draw.viewFromObject[r][c];
  const V3 none{zero, zero, zero};
  tangent = normalizeOr(rotate(direction, tangent), none);
  if (draw.mirrored) sign = hn::Neg(sign);
  const V3 bitangent = scale(cross(n, tangent), sign);
  auto combine = [&](VF a, VF b, VF c) HWY_ATTR { return hn::Add(hn::Add(hn::Mul(a, t.x), hn::Mul(b, t.y)), hn::Mul(c, t.z)); };
  const V3 bent{combine(tangent.x, bitangent.x, n.x), combine(tangent.y, bitangent.y, n.y), combine(tangent.z, bitangent.z, n.z)};
  // Where there is no tangent the map cannot be oriented.
  return select(hn::Gt(dot(tangent, tangent), zero), normalizeOr(bent, n), n);
}

HWY_INLINE V3 shadingNormal(const SurfaceContext& context, const Draw& draw, const Seen& s) {
  const DF d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const V3 towardsEye{zero, zero, one};
  const bool smooth = !draw.mesh->normals.empty();
  V3 n = smooth ? rotate(draw.normalToView, interpolate3(s, draw.mesh->normals)) : towardsEye;
  n = smooth ? normalizeOr(n, {zero, zero, zero}) : V3{zero, zero, zero};
  const MF missing = hn::Not(hn::Gt(dot(n, n), zero));
  if (!hn::AllFalse(d, missing)) {
    const V3 flat = cross(sub(s.object[1], s.object[0]), sub(s.object[2], s.object[0]));
    // Scaled first, so that the squares of tiny and huge triangles stay in range.
    const VF size = hn::Max(hn::Max(hn::Abs(flat.x), hn::Abs(flat.y)), hn::Abs(flat.z));
    const MF sized = hn::And(hn::Gt(size, zero), hn::Lt(size, hn::Set(d, std::numeric_limits<float>::infinity())));
    const VF divisor = hn::IfThenElse(sized, size, one);
    const V3 unit{hn::Div(flat.x, divisor), hn::Div(flat.y, divisor), hn::Div(flat.z, divisor)};
    n = select(missing, normalizeOr(rotate(draw.normalToView, unit), towardsEye), n);
  }
  if (draw.material->normalMap.texture >= 0) n = mappedNormal(context, draw, s, n);
  if (!draw.material->doubleSided) return n;
  const MF behind = draw.mirrored ? hn::Not(s.clockwise) : s.clockwise;
  return select(behind, {hn::Neg(n.x), hn::Neg(n.y), hn::Neg(n.z)}, n);
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

HWY_INLINE void storeWhere(MF mask, VF v, Plane<float>& plane, int x, int y) {
  const DF d;
  hn::BlendedStore(v, mask, d, plane.row(y) + x);
}

HWY_INLINE void store3(MF mask, const V3& v, Plane<float> planes[3], int x, int y) {
  storeWhere(mask, v.x, planes[0], x, y);
  storeWhere(mask, v.y, planes[1], x, y);
  storeWhere(mask, v.z, planes[2], x, y);
}

HWY_INLINE VF centersX(const View& view, int x) {
  const DF d;
  const DI di;
  return hn::ConvertTo(d, hn::Add(hn::Set(di, view.xCenterSub(x)), hn::ShiftLeft<kSubBits>(hn::Iota(di, 0))));
}

// The lanes `mask` of one vector show triangles of `draw`, the first of them the one with firstId.
void resolveDraw(const SurfaceContext& context, const Draw& draw, VI id, uint32_t firstId, MF mask, int x, int y, GBuffer& out) {
  const DF d;
  const DI di;
  const DU du;
  const View& view = *context.view;
  const MI lanes = hn::RebindMask(di, mask);
  if (!out.instance.empty())
    hn::BlendedStore(hn::Set(du, draw.instance), hn::RebindMask(du, mask), du, out.instance.row(y) + x);
  if (!out.material.empty())
    hn::BlendedStore(hn::Set(du, draw.materialIndex), hn::RebindMask(du, mask), du, out.material.row(y) + x);
  const bool normal = !out.normal[0].empty(), albedo = !out.albedo[0].empty(), emissive = !out.emissive[0].empty();
  if (!normal && !albedo && !emissive) return;

  const Material& m = *draw.material;
  const VI triangle = hn::IfThenElseZero(lanes, hn::Sub(id, hn::Set(di, int32_t(draw.firstTriangle))));
  const VF xCenter = centersX(view, x);
  const bool constantAlbedo = m.baseColorMap.texture < 0 && draw.mesh->colors.empty();
  const bool constantEmissive = m.unlit ? constantAlbedo : m.emissiveMap.texture < 0;
  Rgba color{hn::Set(d, m.baseColor.r), hn::Set(d, m.baseColor.g), hn::Set(d, m.baseColor.b), hn::Set(d, m.baseColor.a)};
  V3 emission{hn::Set(d, m.emissive.r), hn::Set(d, m.emissive.g), hn::Set(d, m.emissive.b)};
  if (normal || (albedo && !constantAlbedo) || (emissive && !constantEmissive)) {
    const VF yCenter = hn::Set(d, float(view.yCenterSub(y)));
    // Large triangles fill whole vectors.
    const uint32_t one = firstId - draw.firstTriangle;
    const bool same = hn::AllTrue(di, hn::Or(hn::Eq(triangle, hn::Set(di, int32_t(one))), hn::Not(lanes)));
    const Seen s = same ? seePixels(view, draw, one, xCenter, yCenter) : seePixel(view, draw, triangle, xCenter, yCenter);
    if (normal) store3(mask, shadingNormal(context, draw, s), out.normal, x, y);
    if (!constantAlbedo && (albedo || m.unlit)) color = baseColor(context, draw, s);
    if (emissive && !m.unlit && m.emissiveMap.texture >= 0) {
      const Rgba e = sampleSlot(context, draw, s, m.emissiveMap);
      emission = {hn::Mul(emission.x, e.r), hn::Mul(emission.y, e.g), hn::Mul(emission.z, e.b)};
    }
  }
  const VF zero = hn::Zero(d);
  const V3 base{unitRange(color.r), unitRange(color.g), unitRange(color.b)};
  if (albedo) store3(mask, m.unlit ? V3{zero, zero, zero} : base, out.albedo, x, y);
  if (emissive)
    store3(mask, m.unlit ? base : V3{nonNegative(emission.x), nonNegative(emission.y), nonNegative(emission.z)}, out.emissive, x, y);
}

void storeEmpty(int x, int y, GBuffer& out) {
  const DF d;
  const DU du;
  const VF zero = hn::Zero(d);
  for (int c = 0; c < 3; ++c)
    for (Plane<float>* p : {&out.normal[c], &out.albedo[c], &out.emissive[c], &out.position[c]})
      if (!p->empty()) hn::StoreU(zero, d, p->row(y) + x);
  for (Plane<uint32_t>* p : {&out.instance, &out.material})
    if (!p->empty()) hn::StoreU(hn::Set(du, kNoTriangle), du, p->row(y) + x);
}

void storeDepth(const View& view, VF key, MF covered, int x, int y, GBuffer& out) {
  const DF d;
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity()), zero = hn::Zero(d);
  // 0 - key: a plain negation would give two kinds of zero.
  const VF zView = view.perspective ? hn::Div(hn::Set(d, 1.0f), key) : hn::Sub(zero, key);
  if (!out.depth.empty()) hn::StoreU(hn::IfThenElse(covered, zView, infinity), d, out.depth.row(y) + x);
  if (out.position[0].empty()) return;
  const VF xc = centersX(view, x), yc = hn::Set(d, float(view.yCenterSub(y)));
  VF px = hn::Div(hn::Sub(xc, hn::Set(d, view.xShiftSub)), hn::Set(d, view.xScaleSub));
  VF py = hn::Div(hn::Sub(yc, hn::Set(d, view.yShiftSub)), hn::Set(d, view.yScaleSub));
  if (view.perspective) {
    px = hn::Mul(px, zView);
    py = hn::Mul(py, zView);
  }
  store3(covered, {px, py, hn::Sub(zero, zView)}, out.position, x, y);
}

// Rows of pixels from blocks of them, four at a time.
HWY_INLINE void rowFromBlocks(const TileBuffers& tile, int row, float* keys, uint32_t* ids) {
  const hn::CappedTag<float, kBlock> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (int column = 0; column < tile.width; column += kBlock)
    for (int i = 0; i < kBlock; i += int(hn::Lanes(d))) {
      hn::StoreU(hn::LoadU(d, tile.key + tile.at(column, row) + i), d, keys + column + i);
      hn::StoreU(hn::LoadU(du, tile.id + tile.at(column, row) + i), du, ids + column + i);
    }
}

void ResolveTile(const SurfaceContext& context, const TileBuffers& tile, bool covered, GBuffer& out) {
  const DF d;
  const DI di;
  const DU du;
  const int lanes = int(hn::Lanes(d));
  const VI none = hn::Set(di, int32_t(kNoTriangle));
  const VF nothing = hn::Set(d, -std::numeric_limits<float>::infinity());
  HWY_ALIGN float keys[1 << kMaxTileBits];
  HWY_ALIGN uint32_t ids[1 << kMaxTileBits];
  const Draw* draw = nullptr;
  for (int row = 0; row < tile.height; ++row) {
    const int y = tile.y + row;
    if (covered) rowFromBlocks(tile, row, keys, ids);
    for (int column = 0; column < tile.width; column += lanes) {
      const int x = tile.x + column;
      const VI id = covered ? hn::BitCast(di, hn::Load(du, ids + column)) : none;
      const MI inImage = hn::Lt(hn::Iota(di, x), hn::Set(di, tile.x + tile.width));
      MI rest = hn::And(hn::Ne(id, none), inImage);
      if (!out.triangle.empty()) hn::StoreU(hn::BitCast(du, id), du, out.triangle.row(y) + x);
      if (!hn::AllTrue(di, rest)) storeEmpty(x, y, out);
      if (hn::AllFalse(di, rest)) {
        storeDepth(*context.view, nothing, hn::RebindMask(d, rest), x, y, out);
        continue;
      }
      storeDepth(*context.view, hn::Load(d, keys + column), hn::RebindMask(d, rest), x, y, out);
      // Usually one draw; each round takes all lanes of the first lane's.
      do {
        const uint32_t first = ids[column + int(hn::FindKnownFirstTrue(di, rest))];
        draw = &drawOf(context, first, draw);
        const VU offset = hn::Sub(hn::BitCast(du, id), hn::Set(du, draw->firstTriangle));
        const MI mine = hn::And(rest, hn::RebindMask(di, hn::Lt(offset, hn::Set(du, draw->triangleCount))));
        resolveDraw(context, *draw, id, first, hn::RebindMask(d, mine), x, y, out);
        rest = hn::AndNot(mine, rest);
      } while (!hn::AllFalse(di, rest));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(ResolveTile);

void resolveTile(const SurfaceContext& context, const TileBuffers& tile, bool covered, GBuffer& out, Target target) {
  OBSCURA_DISPATCH(ResolveTile, target)(context, tile, covered, out);
}

}  // namespace obscura::raster
#endif
