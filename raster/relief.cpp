#include "obscura/raster/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/relief.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/height-inl.h"
#include "obscura/raster/surface-inl.h"
#include "obscura/raster/wanted-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {
namespace relief {

constexpr int kLanes = int(hn::MaxLanes(DF()));

HWY_INLINE V3 broadcast(const float v[3]) {
  const DF d;
  return {hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2])};
}

// Depth of a key and key of a depth.
HWY_INLINE VF turned(const View& view, VF k) {
  const DF d;
  return view.perspective ? hn::Div(hn::Set(d, 1.0f), k) : hn::Sub(hn::Zero(d), k);
}

// A vector of pixels in memory, as the planes take it.
struct Lanes {
  HWY_ALIGN float v[kLanes];
  HWY_INLINE explicit Lanes(VF x) { hn::Store(x, DF(), v); }
};

// One triangle of a displaced draw.
class Relief {
 public:
  Relief(const SurfaceContext& context, const Draw& draw, uint32_t triangle)
      : context_(context), view_(*context.view), draw_(draw), map_(context.heights[size_t(draw.material->heightMap.texture)]) {
    for (int i = 0; i < 3; ++i) vertex_[i] = draw.mesh->indices[size_t(triangle) * 3 + size_t(i)];
    frame_ = reliefFrame(draw, vertex_);
    const auto& m = draw.material->heightMap.uvFromUv;
    const Span<const glm::vec2> uvs = draw.mesh->uvs[draw.material->heightMap.uvSet];
    for (int i = 0; i < 3 && !uvs.empty(); ++i) {
      const glm::vec2 t = uvs[vertex_[i]];
      u_[i] = m[0] * t.x + m[1] * t.y + m[2];
      v_[i] = m[3] * t.x + m[4] * t.y + m[5];
    }
  }
  bool displaces() const { return frame_.depth > 0 && !draw_.mesh->uvs[draw_.material->heightMap.uvSet].empty(); }

  // A vector of pixels: lanes are the pixels (x + lx, y + ly) of the image, of which the triangle shows in `mine`.
  struct Pixels {
    int x, y;
    VI lx, ly;
    MF mine;
  };

  // How far the pixels sink: tau, and the key that they have then.
  HWY_NOINLINE void sink(const Pixels& pixels, VF& key, VF& tau) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f);
    const Way way = wayOf(pixels);
    const auto below = [&](VF t) HWY_ATTR {
      const VF height = heightOf(hn::Add(way.u, hn::Mul(way.du, t)), hn::Add(way.v, hn::Mul(way.dv, t)));
      return hn::Le(hn::Sub(one, hn::Mul(way.falls, t)), height);
    };
    tau = hn::IfThenElse(pixels.mine, firstBelow(pixels.mine, stepsOf(way.du, way.dv), below), tau);
    const VF sunk = turned(view_, hn::Add(turned(view_, key), hn::Mul(way.span, tau)));
    // Not nearer by a rounding, or else what hides the triangle might not hide it.
    key = hn::IfThenElse(hn::And(pixels.mine, hn::Lt(sunk, key)), sunk, key);
  }

  // The planes of what lies at tau, with the key that it has there.
  HWY_NOINLINE void store(const Pixels& pixels, VF key, VF tau, GBuffer& out) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f);
    Way way = wayOf(pixels);
    Seen& s = way.seen;
    s.weight[1] = hn::Add(s.weight[1], hn::Mul(way.step1, tau));
    s.weight[2] = hn::Add(s.weight[2], hn::Mul(way.step2, tau));
    s.weight[0] = hn::Sub(hn::Sub(one, s.weight[1]), s.weight[2]);
    storeShape(pixels, way.px, way.py, turned(view_, key), out);
    storeColors(pixels, s, out);
    if (out.normal[0].empty()) return;
    const VF u = hn::Add(way.u, hn::Mul(way.du, tau)), v = hn::Add(way.v, hn::Mul(way.dv, tau));
    const V3 gradientU = gradientOf(u_), gradientV = gradientOf(v_), smooth = loadNormals(pixels, out);
    storeNormals(pixels, smooth, u, v, gradientU, gradientV, out);
    if (out.heightMap.empty()) return;
    const VF perDepth = hn::Set(d, 1 / frame_.depth);
    const VF planes[12] = {u, v, hn::Sub(one, hn::Mul(way.falls, tau)), gradientU.x, gradientU.y, gradientU.z, gradientV.x, gradientV.y,
                           gradientV.z, hn::Mul(smooth.x, perDepth), hn::Mul(smooth.y, perDepth), hn::Mul(smooth.z, perDepth)};
    for (int k = 0; k < 12; ++k) store(pixels, planes[k], out.relief[k]);
    eachLane(pixels, [&](int, int column, int row) { out.heightMap.at(column, row) = uint32_t(draw_.material->heightMap.texture); });
  }

 private:
  // Of the rays through the pixels, from the triangle (tau 0) to where they are followed to (tau 1).
  struct Way {
    Seen seen;
    VF px, py;        // position / zView where perspective, else position
    VF span, falls;   // along the view axis; of the greatest depth
    VF step1, step2;  // of the weights of vertices 1 and 2
    VF u, v, du, dv;  // in the map, at tau 0 and from there to tau 1
  };

  HWY_NOINLINE Way wayOf(const Pixels& p) const {
    const DF d;
    const DI di;
    Way way;
    const VF zero = hn::Zero(d);
    const int cellX = p.x - ((view_.left + p.x) & (kCell - 1)), cellY = p.y - ((view_.top + p.y) & (kCell - 1));
    way.seen = seeTriangle(weightPlanes(view_, draw_, vertex_, cellX, cellY), vertex_,
                           hn::ConvertTo(d, hn::Add(p.lx, hn::Set(di, p.x - cellX))), hn::ConvertTo(d, hn::Add(p.ly, hn::Set(di, p.y - cellY))));
    const VF xc = hn::ConvertTo(d, hn::Add(hn::Set(di, view_.xCenterSub(p.x)), hn::ShiftLeft<kSubBits>(p.lx)));
    const VF yc = hn::ConvertTo(d, hn::Add(hn::Set(di, view_.yCenterSub(p.y)), hn::ShiftLeft<kSubBits>(p.ly)));
    way.px = hn::Div(hn::Sub(xc, hn::Set(d, view_.xShiftSub)), hn::Set(d, view_.xScaleSub));
    way.py = hn::Div(hn::Sub(yc, hn::Set(d, view_.yShiftSub)), hn::Set(d, view_.yScaleSub));
    const V3 ray{view_.perspective ? way.px : zero, view_.perspective ? way.py : zero, hn::Set(d, -1.0f)};

    // How far along the ray the greatest depth is, on whichever side.
    const VF sinks = hn::Abs(dot(broadcast(frame_.normal), ray)), least = hn::Mul(hn::Sqrt(dot(ray, ray)), hn::Set(d, kFlattestRay));
    const VF depth = hn::Set(d, frame_.depth);
    way.span = hn::Div(depth, hn::IfThenElse(hn::Gt(sinks, least), sinks, least));
    way.falls = hn::Div(hn::Mul(sinks, way.span), depth);
    way.step1 = hn::Mul(dot(broadcast(frame_.gradient[0]), ray), way.span);
    way.step2 = hn::Mul(dot(broadcast(frame_.gradient[1]), ray), way.span);
    way.u = interpolate(way.seen, hn::Set(d, u_[0]), hn::Set(d, u_[1]), hn::Set(d, u_[2]));
    way.v = interpolate(way.seen, hn::Set(d, v_[0]), hn::Set(d, v_[1]), hn::Set(d, v_[2]));
    const auto slope = [&](const float a[3]) HWY_ATTR {
      return hn::Add(hn::Mul(hn::Set(d, a[1] - a[0]), way.step1), hn::Mul(hn::Set(d, a[2] - a[0]), way.step2));
    };
    way.du = slope(u_);
    way.dv = slope(v_);
    return way;
  }

  // body(lane, x, y) for the pixels of a vector.
  template <class Body>
  static HWY_INLINE void eachLane(const Pixels& p, const Body& body) {
    HWY_ALIGN int32_t lx[kLanes], ly[kLanes];
    hn::Store(p.lx, DI(), lx);
    hn::Store(p.ly, DI(), ly);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(DF(), p.mine, bits);
    for (int i = 0; i < kLanes; ++i)
      if (bits[i / 8] >> (i % 8) & 1) body(i, p.x + lx[i], p.y + ly[i]);
  }

  static HWY_INLINE void store(const Pixels& p, VF v, Plane<float>& plane) {
    if (plane.empty()) return;
    const Lanes lanes(v);
    eachLane(p, [&](int i, int x, int y) { plane.at(x, y) = lanes.v[i]; });
  }
  static HWY_INLINE void store3(const Pixels& p, const V3& v, Plane<float> planes[3]) {
    store(p, v.x, planes[0]);
    store(p, v.y, planes[1]);
    store(p, v.z, planes[2]);
  }

  // Of a texture coordinate, in view space along the plane.
  HWY_INLINE V3 gradientOf(const float a[3]) const {
    const DF d;
    const VF a1 = hn::Set(d, a[1] - a[0]), a2 = hn::Set(d, a[2] - a[0]);
    const V3 g1 = broadcast(frame_.gradient[0]), g2 = broadcast(frame_.gradient[1]);
    return {hn::Add(hn::Mul(a1, g1.x), hn::Mul(a2, g2.x)), hn::Add(hn::Mul(a1, g1.y), hn::Mul(a2, g2.y)),
            hn::Add(hn::Mul(a1, g1.z), hn::Mul(a2, g2.z))};
  }

  // Not inlined: it is called from seven places.
  HWY_NOINLINE VF heightOf(VF u, VF v) const { return heightAt(map_, u, v); }

  // As many as the ray crosses texels.
  HWY_INLINE VF stepsOf(VF du, VF dv) const {
    const DF d;
    const VF fewest = hn::Set(d, kFewestReliefSteps), most = hn::Set(d, kMostReliefSteps);
    const VF a = hn::Mul(hn::Abs(du), hn::Set(d, float(map_.width))), b = hn::Mul(hn::Abs(dv), hn::Set(d, float(map_.height)));
    VF steps = hn::IfThenElse(hn::Gt(a, fewest), a, fewest);
    steps = hn::IfThenElse(hn::Gt(b, steps), b, steps);
    return hn::IfThenElse(hn::Lt(steps, most), steps, most);
  }

  template <class Below>
  static HWY_INLINE VF firstBelow(MF mine, VF steps, const Below& below) {
    const DF d;
    const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d), step = hn::Div(one, steps);
    VF low = zero, high = zero;  // above the map, and not
    MF active = hn::AndNot(below(zero), mine);
    for (float k = 1; !hn::AllFalse(d, active); k += 1) {
      const VF tau = hn::Mul(hn::Set(d, k), step), next = hn::IfThenElse(hn::Lt(tau, one), tau, one);
      high = hn::IfThenElse(active, next, high);
      active = hn::And(hn::AndNot(below(next), active), hn::Lt(next, one));
      low = hn::IfThenElse(active, next, low);
    }
    for (int k = 0; k < kReliefHalvings; ++k) {
      const VF middle = hn::Mul(hn::Add(low, high), hn::Set(d, 0.5f));
      const MF sunk = below(middle);
      low = hn::IfThenElse(sunk, low, middle);
      high = hn::IfThenElse(sunk, middle, high);
    }
    return low;
  }

  HWY_INLINE void storeShape(const Pixels& p, VF px, VF py, VF zView, GBuffer& out) const {
    const DF d;
    store(p, zView, out.depth);
    if (out.position[0].empty()) return;
    if (view_.perspective) px = hn::Mul(px, zView), py = hn::Mul(py, zView);
    store3(p, {px, py, hn::Sub(hn::Zero(d), zView)}, out.position);
  }

  HWY_INLINE void storeColors(const Pixels& p, const Seen& s, GBuffer& out) const {
    const DF d;
    const Material& m = *draw_.material;
    const Wanted wanted(out);
    if (variesInColor(draw_, wanted)) {
      const Rgba color = baseColor(context_, draw_, s);
      store3(p, albedoOf(color.r, color.g, color.b), m.unlit ? out.emissive : out.albedo);
    }
    if (variesInEmission(draw_, wanted)) {
      const Rgba e = sampleSlot(context_, draw_, s, m.emissiveMap);
      const auto times = [&](float factor, VF v) HWY_ATTR { return hn::Mul(hn::Set(d, factor), v); };
      store3(p, emissionOf(times(m.emissive.r, e.r), times(m.emissive.g, e.g), times(m.emissive.b, e.b)), out.emissive);
    }
    if (variesInGloss(draw_, wanted)) {
      const Rgba texel = sampleSlot(context_, draw_, s, m.metallicRoughnessMap);
      const Gloss gloss = glossOf(m, texel.g, texel.b);
      store(p, gloss.metallic, out.metallic);
      store(p, gloss.roughness, out.roughness);
    }
  }

  // Those of the triangle, as resolve stored them.
  static HWY_INLINE V3 loadNormals(const Pixels& p, const GBuffer& out) {
    const DF d;
    HWY_ALIGN float read[3][kLanes] = {};
    for (int c = 0; c < 3; ++c) eachLane(p, [&](int i, int x, int y) { read[c][i] = out.normal[c].at(x, y); });
    return {hn::Load(d, read[0]), hn::Load(d, read[1]), hn::Load(d, read[2])};
  }

  // The triangle's normals n, tilted by the map.
  HWY_INLINE void storeNormals(const Pixels& p, const V3& n, VF u, VF v, const V3& gradientU, const V3& gradientV, GBuffer& out) const {
    const DF d;
    const float w = float(map_.width), h = float(map_.height);
    const VF stepU = hn::Set(d, 1 / w), stepV = hn::Set(d, 1 / h);
    const VF slopeU = hn::Mul(hn::Sub(heightOf(hn::Add(u, stepU), v), heightOf(hn::Sub(u, stepU), v)), hn::Set(d, 0.5f * w * frame_.depth));
    const VF slopeV = hn::Mul(hn::Sub(heightOf(u, hn::Add(v, stepV)), heightOf(u, hn::Sub(v, stepV))), hn::Set(d, 0.5f * h * frame_.depth));
    const V3 tilt{hn::Add(hn::Mul(slopeU, gradientU.x), hn::Mul(slopeV, gradientV.x)),
                  hn::Add(hn::Mul(slopeU, gradientU.y), hn::Mul(slopeV, gradientV.y)),
                  hn::Add(hn::Mul(slopeU, gradientU.z), hn::Mul(slopeV, gradientV.z))};
    store3(p, normalizeOr(sub(n, tilt), n), out.normal);
  }

  const SurfaceContext& context_;
  const View& view_;
  const Draw& draw_;
  const HeightView& map_;
  uint32_t vertex_[3];
  ReliefFrame frame_;
  float u_[3] = {}, v_[3] = {};  // in the height map, of the vertices
};

// body(relief, pixels) for each displaced triangle that shows in a vector.
template <class Body>
HWY_INLINE void eachRelief(const SurfaceContext& context, const TileBuffers& tile, int x, int y, int first, const Body& body) {
  const DU du;
  const DI di;
  const DF d;
  const VU id = hn::Load(du, tile.id + tile.at(x, y) + first);
  const VI pixel = hn::Iota(di, first), lx = hn::And(pixel, hn::Set(di, kBlock - 1)), ly = hn::ShiftRight<kBlockBits>(pixel);
  const auto inside = hn::And(hn::Lt(lx, hn::Set(di, tile.width - x)), hn::Lt(ly, hn::Set(di, tile.height - y)));
  auto rest = hn::And(hn::Ne(id, hn::Set(du, kNoTriangle)), hn::RebindMask(du, inside));
  while (!hn::AllFalse(du, rest)) {
    const uint32_t one = tile.id[tile.at(x, y) + first + int(hn::FindKnownFirstTrue(du, rest))];
    const auto mine = hn::And(hn::Eq(id, hn::Set(du, one)), rest);
    rest = hn::AndNot(mine, rest);
    const Draw& draw = drawOf(context, one);
    if (draw.material->heightMap.texture < 0) continue;
    const Relief relief(context, draw, one - draw.firstTriangle);
    if (relief.displaces()) body(relief, Relief::Pixels{tile.x + x, tile.y + y, lx, ly, hn::RebindMask(d, mine)});
  }
}

template <class Body>
HWY_INLINE void eachVector(const TileBuffers& tile, const Body& body) {
  for (int y = 0; y < tile.height; y += kBlock)
    for (int x = 0; x < tile.width; x += kBlock)
      for (int first = 0; first < kBlock * kBlock; first += kLanes) body(x, y, first);
}

void SinkTile(const SurfaceContext& context, const TileBuffers& displaced, const TileBuffers& tile) {
  eachVector(tile, [&](int x, int y, int first) HWY_ATTR {
    const DF d;
    const DU du;
    const int at = tile.at(x, y) + first;
    VF key = hn::Load(d, displaced.key + at), tau = hn::Zero(d);
    eachRelief(context, displaced, x, y, first,
               [&](const Relief& relief, const Relief::Pixels& pixels) HWY_ATTR { relief.sink(pixels, key, tau); });
    hn::Store(tau, d, displaced.key + at);
    const VF keptKey = hn::Load(d, tile.key + at);
    const VU id = hn::Load(du, displaced.id + at), keptId = hn::Load(du, tile.id + at);
    const MF wins = hn::Or(hn::Gt(key, keptKey), hn::And(hn::Eq(key, keptKey), hn::RebindMask(d, hn::Lt(id, keptId))));
    hn::Store(hn::IfThenElse(wins, key, keptKey), d, tile.key + at);
    hn::Store(hn::IfThenElse(hn::RebindMask(du, wins), id, keptId), du, tile.id + at);
  });
}

void StoreRelief(const SurfaceContext& context, const TileBuffers& tile, const TileBuffers& displaced, GBuffer& out) {
  eachVector(tile, [&](int x, int y, int first) HWY_ATTR {
    const DF d;
    const int at = tile.at(x, y) + first;
    const VF key = hn::Load(d, tile.key + at), tau = hn::Load(d, displaced.key + at);
    eachRelief(context, tile, x, y, first,
               [&](const Relief& relief, const Relief::Pixels& pixels) HWY_ATTR { relief.store(pixels, key, tau, out); });
  });
}

}  // namespace relief

using relief::SinkTile;
using relief::StoreRelief;

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(SinkTile);
HWY_EXPORT(StoreRelief);

ReliefFrame reliefFrame(const Draw& draw, const uint32_t vertex[3]) {
  ReliefFrame out{};
  glm::dvec3 object[3], view[3];
  for (int i = 0; i < 3; ++i) {
    object[i] = glm::dvec3(draw.mesh->positions[vertex[i]]);
    for (int r = 0; r < 3; ++r) {
      const float* m = draw.viewFromObject[r];
      view[i][r] = double(m[0]) * object[i].x + double(m[1]) * object[i].y + double(m[2]) * object[i].z + double(m[3]);
    }
  }
  const auto cross = [](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::dvec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  };
  const auto square = [](const glm::dvec3& a) { return a.x * a.x + a.y * a.y + a.z * a.z; };
  const glm::dvec3 e1 = view[1] - view[0], e2 = view[2] - view[0], n = cross(e1, e2), o = cross(object[1] - object[0], object[2] - object[0]);
  const double area = square(n), objectArea = square(o);
  if (!(area > 1e-60 && area < 1e60 && objectArea > 1e-60 && objectArea < 1e60)) return out;
  const glm::dvec3 unit = n / std::sqrt(area), objectUnit = o / std::sqrt(objectArea), g1 = cross(e2, n) / area, g2 = cross(n, e1) / area;
  double lifted = 0;  // how far a step along the mesh's own normal leads away from the plane
  for (int r = 0; r < 3; ++r) {
    const float* m = draw.viewFromObject[r];
    lifted += (double(m[0]) * objectUnit.x + double(m[1]) * objectUnit.y + double(m[2]) * objectUnit.z) * unit[r];
    out.normal[r] = float(unit[r]);
    out.gradient[0][r] = float(g1[r]);
    out.gradient[1][r] = float(g2[r]);
  }
  const double depth = double(draw.material->heightScale) * std::fabs(lifted);
  if (depth >= kLeastReliefDepth && depth <= kGreatestReliefDepth) out.depth = float(depth);
  return out;
}

void sinkTile(const SurfaceContext& context, const TileBuffers& displaced, const TileBuffers& tile, Target target) {
  OBSCURA_DISPATCH(SinkTile, target)(context, displaced, tile);
}

void clearRelief(const TileBuffers& tile, GBuffer& out) {
  for (int row = tile.y; row < tile.y + tile.height; ++row) {
    std::fill_n(out.heightMap.row(row) + tile.x, tile.width, kNoTriangle);
    for (Plane<float>& plane : out.relief) std::fill_n(plane.row(row) + tile.x, tile.width, 0.0f);
  }
}

void storeRelief(const SurfaceContext& context, const TileBuffers& tile, const TileBuffers& displaced, GBuffer& out, Target target) {
  OBSCURA_DISPATCH(StoreRelief, target)(context, tile, displaced, out);
}

}  // namespace obscura::raster
#endif
