// Per-target: normals from vertices, planes and normal maps.
#if defined(OBSCURA_NORMAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_NORMAL_INL_H_
#undef OBSCURA_NORMAL_INL_H_
#else
#define OBSCURA_NORMAL_INL_H_
#endif

#include <limits>

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

// Unit normal of the plane through the corners, camera space; towards the eye where there is none.
HWY_NOINLINE V3 flatNormal(const Draw& draw, const V3 object[3]) {
  const DF d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const V3 n = cross(sub(object[1], object[0]), sub(object[2], object[0]));
  // Scaled first, so that the squares of tiny and huge triangles stay in range.
  const VF size = hn::Max(hn::Max(hn::Abs(n.x), hn::Abs(n.y)), hn::Abs(n.z));
  const MF sized = hn::And(hn::Gt(size, zero), hn::Lt(size, hn::Set(d, std::numeric_limits<float>::infinity())));
  const VF divisor = hn::IfThenElse(sized, size, one);
  return normalizeOr(rotate(draw.normalToView, {hn::Div(n.x, divisor), hn::Div(n.y, divisor), hn::Div(n.z, divisor)}), {zero, zero, one});
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
    const V3 object[3] = {corner3(s, draw.mesh->positions, 0), corner3(s, draw.mesh->positions, 1), corner3(s, draw.mesh->positions, 2)};
    const V3 along = sub(scale(sub(object[1], object[0]), dv2), scale(sub(object[2], object[0]), dv1));
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

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
