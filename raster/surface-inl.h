// Per-target: from triangle and pixel to barycentric weights, interpolated attributes and texture coordinates.
#if defined(OBSCURA_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_SURFACE_INL_H_
#undef OBSCURA_SURFACE_INL_H_
#else
#define OBSCURA_SURFACE_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/raster/surface.h"
#include "obscura/raster/texture-inl.h"
#include "obscura/raster/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

HWY_INLINE V3 sub(const V3& a, const V3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE VF dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE V3 scale(const V3& a, VF s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
HWY_INLINE V3 select(MF mask, const V3& yes, const V3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

// False where v has no direction: zero, not finite, or its square out of float's range.
HWY_INLINE MF hasDirection(const V3& v) {
  const DF d;
  const VF square = dot(v, v);
  return hn::And(hn::Ge(square, hn::Set(d, 1e-36f)), hn::Le(square, hn::Set(d, 1e36f)));
}

// Unit vector, or `otherwise` where v has no direction.
HWY_INLINE V3 normalizeOr(const V3& v, const V3& otherwise) {
  const DF d;
  const VF square = dot(v, v);
  const MF usable = hasDirection(v);
  const VF one = hn::Set(d, 1.0f);
  return select(usable, scale(v, hn::Div(one, hn::Sqrt(hn::IfThenElse(usable, square, one)))), otherwise);
}

// One triangle per lane, all of the same draw, seen from one pixel per lane.
struct Seen {
  bool one;             // the same triangle in all lanes: its vertices are read once, not gathered
  uint32_t vertex[3];
  VI index[3];          // vertices, where they differ
  VF weight[3];         // barycentric, clamped: all >= 0, sum 1 but for rounding
  MF clockwise;         // as seen in the image
  VF gx[3], gy[3], sum; // gradients of the weight planes, and their sum at the pixel
};

// Vertex attribute `values` (floats, kComponents a vertex), component c, of corner i.
template <int kComponents>
HWY_INLINE VF corner(const Seen& s, const float* values, int c, int i) {
  const DF d;
  if (s.one) return hn::Set(d, values[size_t(s.vertex[i]) * kComponents + size_t(c)]);
  VI at = s.index[i];
  if (kComponents == 2) at = hn::Add(at, at);
  if (kComponents == 3) at = hn::Add(hn::Add(at, at), at);
  if (kComponents == 4) at = hn::ShiftLeft<2>(at);
  return hn::GatherIndex(d, values + c, at);
}

HWY_INLINE V3 corner3(const Seen& s, Span<const glm::vec3> values, int i) {
  const float* v = &values.data()->x;
  return {corner<3>(s, v, 0, i), corner<3>(s, v, 1, i), corner<3>(s, v, 2, i)};
}

// Vertices of a triangle of the mesh per lane.
HWY_INLINE void gatherVertices(const Draw& draw, VI triangle, Seen& s) {
  const DI di;
  const VI at = hn::Add(hn::Add(triangle, triangle), triangle);
  const int32_t* indices = reinterpret_cast<const int32_t*>(draw.mesh->indices.data());
  for (int i = 0; i < 3; ++i) s.index[i] = hn::GatherIndex(di, indices, hn::Add(at, hn::Set(di, i)));
}

// Weights from the values of the three weight planes.
HWY_INLINE void weigh(const V3& b, Seen& s) {
  const DF d;
  s.sum = hn::Add(hn::Add(b.x, b.y), b.z);
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f), perSum = hn::Div(one, s.sum);
  s.clockwise = hn::Gt(s.sum, zero);
  // NaN fails every comparison and ends as 0.
  auto clamped = [&](VF value, VF most) HWY_ATTR {
    const VF l = hn::Mul(value, perSum), positive = hn::IfThenElseZero(hn::Gt(l, zero), l);
    return hn::IfThenElse(hn::Lt(positive, most), positive, most);
  };
  s.weight[1] = clamped(b.y, one);
  const VF rest = hn::Sub(one, s.weight[1]);
  s.weight[2] = clamped(b.z, rest);
  s.weight[0] = hn::Sub(rest, s.weight[2]);
}

// Value of a weight plane dx, dy pixels from the cell's first.
HWY_INLINE VF planeAt(float c, float gx, float gy, VF dx, VF dy) {
  const DF d;
  return hn::Add(hn::Set(d, c), hn::Add(hn::Mul(hn::Set(d, gx), dx), hn::Mul(hn::Set(d, gy), dy)));
}

// The same triangle in all lanes.
HWY_INLINE Seen seeTriangle(const WeightPlanes& planes, const uint32_t vertex[3], VF dx, VF dy) {
  const DF d;
  Seen s;
  s.one = true;
  for (int i = 0; i < 3; ++i) {
    s.vertex[i] = vertex[i];
    s.index[i] = hn::Zero(DI());
    s.gx[i] = hn::Set(d, planes.gx[i]);
    s.gy[i] = hn::Set(d, planes.gy[i]);
  }
  auto plane = [&](int i) HWY_ATTR { return planeAt(planes.c[i], planes.gx[i], planes.gy[i], dx, dy); };
  weigh({plane(0), plane(1), plane(2)}, s);
  return s;
}

HWY_INLINE VF interpolate(const Seen& s, VF a0, VF a1, VF a2) {
  return hn::Add(hn::Add(hn::Mul(a0, s.weight[0]), hn::Mul(a1, s.weight[1])), hn::Mul(a2, s.weight[2]));
}

// Component `c` of a span of glm::vec2 or vec4 at the three vertices.
template <class T>
HWY_INLINE void gatherComponent(Span<const T> values, const Seen& s, int c, VF out[3]) {
  for (int i = 0; i < 3; ++i) out[i] = corner<int(sizeof(T) / sizeof(float))>(s, &values.data()->x, c, i);
}

template <class T>
HWY_INLINE VF interpolateComponent(Span<const T> values, const Seen& s, int c) {
  VF v[3];
  gatherComponent(values, s, c, v);
  return interpolate(s, v[0], v[1], v[2]);
}

// Texture coordinates of a slot, and the larger squared length of their gradients in texels of level 0.
struct TextureCoordinates {
  VF u, v, squaredLength;
};

HWY_INLINE TextureCoordinates textureCoordinates(const Draw& draw, const Seen& s, const TextureSlot& slot, const TextureView& texture) {
  const DF d;
  const Span<const glm::vec2> uvs = draw.mesh->uvs[slot.uvSet];
  TextureCoordinates out;
  if (uvs.empty()) return {hn::Set(d, slot.uvFromUv[2]), hn::Set(d, slot.uvFromUv[5]), hn::Zero(d)};
  VF u[3], v[3];
  gatherComponent(uvs, s, 0, u);
  gatherComponent(uvs, s, 1, v);
  const float* m = slot.uvFromUv.data();
  for (int i = 0; i < 3; ++i) {
    const VF ui = u[i], vi = v[i];
    u[i] = hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), ui), hn::Mul(hn::Set(d, m[1]), vi)), hn::Set(d, m[2]));
    v[i] = hn::Add(hn::Add(hn::Mul(hn::Set(d, m[3]), ui), hn::Mul(hn::Set(d, m[4]), vi)), hn::Set(d, m[5]));
  }
  out.u = interpolate(s, u[0], u[1], u[2]);
  out.v = interpolate(s, v[0], v[1], v[2]);
  out.squaredLength = hn::Zero(d);
  if (!needsLod(texture)) return out;
  // d(b_i / sum) = (d b_i - (b_i / sum) d sum) / sum, per pixel.
  const VF scaleU = hn::Set(d, float(texture.width)), scaleV = hn::Set(d, float(texture.height));
  for (int axis = 0; axis < 2; ++axis) {
    const VF* db = axis == 0 ? s.gx : s.gy;
    const VF dSum = hn::Add(hn::Add(db[0], db[1]), db[2]);
    auto gradient = [&](const VF a[3], VF value, VF texels) HWY_ATTR {
      const VF da = hn::Add(hn::Add(hn::Mul(db[0], a[0]), hn::Mul(db[1], a[1])), hn::Mul(db[2], a[2]));
      return hn::Mul(hn::Div(hn::Sub(da, hn::Mul(value, dSum)), s.sum), texels);
    };
    const VF du = gradient(u, out.u, scaleU), dv = gradient(v, out.v, scaleV);
    const VF squared = hn::Add(hn::Mul(du, du), hn::Mul(dv, dv));
    out.squaredLength = hn::IfThenElse(hn::Gt(squared, out.squaredLength), squared, out.squaredLength);
  }
  return out;
}

HWY_INLINE Rgba sampleSlot(const SurfaceContext& context, const Draw& draw, const Seen& s, const TextureSlot& slot) {
  const TextureView& texture = context.textures[size_t(slot.texture)];
  const TextureCoordinates at = textureCoordinates(draw, s, slot, texture);
  return sampleTexture(texture, context.srgbToLinear, at.u, at.v, levelOfDetail(at.squaredLength));
}

// Base colour factor x texture x vertex colour, not clamped.
HWY_INLINE Rgba baseColor(const SurfaceContext& context, const Draw& draw, const Seen& s) {
  const DF d;
  const Material& m = *draw.material;
  Rgba c{hn::Set(d, m.baseColor.r), hn::Set(d, m.baseColor.g), hn::Set(d, m.baseColor.b), hn::Set(d, m.baseColor.a)};
  auto times = [&](const Rgba& k) HWY_ATTR {
    c = {hn::Mul(c.r, k.r), hn::Mul(c.g, k.g), hn::Mul(c.b, k.b), hn::Mul(c.a, k.a)};
  };
  if (m.baseColorMap.texture >= 0) times(sampleSlot(context, draw, s, m.baseColorMap));
  const Span<const glm::vec4> colors = draw.mesh->colors;
  if (!colors.empty())
    times({interpolateComponent(colors, s, 0), interpolateComponent(colors, s, 1), interpolateComponent(colors, s, 2),
           interpolateComponent(colors, s, 3)});
  return c;
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
