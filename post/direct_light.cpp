#include "obscura/post/direct_light.h"

#include <algorithm>
#include <vector>

#include "obscura/post/light_reach.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/direct_light.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/brdf-inl.h"
#include "obscura/post/shadow-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

constexpr int kBlockWidth = 64, kBlockHeight = 8;  // pixels that share the list of lights that may reach them

// Nearest and farthest depth that is seen in a block.
HWY_INLINE bool depthsOf(const raster::GBuffer& g, int x0, int x1, int y0, int y1, float& nearest, float& farthest) {
  const DF d;
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  VF least = infinity, most = hn::Zero(d);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; x += int(hn::Lanes(d))) {
      const VF depth = hn::LoadU(d, g.depth.row(y) + x);
      const MF inRow = hn::Lt(hn::ConvertTo(d, hn::Iota(DI(), x)), hn::Set(d, float(g.width)));
      const MF seen = hn::And(inRow, hn::Lt(depth, infinity));
      least = hn::IfThenElse(hn::And(seen, hn::Lt(depth, least)), depth, least);
      most = hn::IfThenElse(hn::And(seen, hn::Gt(depth, most)), depth, most);
    }
  HWY_ALIGN float lanes[2][16];
  hn::Store(least, d, lanes[0]);
  hn::Store(most, d, lanes[1]);
  nearest = *std::min_element(lanes[0], lanes[0] + hn::Lanes(d));
  farthest = *std::max_element(lanes[1], lanes[1] + hn::Lanes(d));
  return nearest < std::numeric_limits<float>::infinity();
}

// Calls body(x0, x1, y0, y1, lights): the lights that may reach something of the block.
template <class Body>
HWY_INLINE void forBlocks(const DirectLightInput& in, raster::Span<const PunctualLight> lights, int y0, int y1, const Body& body) {
  std::vector<const PunctualLight*> reaching;
  for (int top = y0; top < y1; top += kBlockHeight)
    for (int left = 0; left < in.g->width; left += kBlockWidth) {
      const int bottom = std::min(top + kBlockHeight, y1), right = std::min(left + kBlockWidth, in.g->width);
      reaching.clear();
      float nearest = 0, farthest = 0;
      const bool seen = depthsOf(*in.g, left, right, top, bottom, nearest, farthest);
      if (seen || !in.skip) {
        const ReachedBall ball = ballAround(in.projector, left, right, top, bottom, nearest, farthest);
        for (const PunctualLight& light : lights)
          if (!in.skip || mayReach(light, ball)) reaching.push_back(&light);
      }
      body(left, right, top, bottom, reaching);
    }
}

template <Brdf kBrdf>
HWY_INLINE V3 addLight(const DirectLightInput& in, const PunctualLight& light, const Points& at, const V3& n, int x, int y,
                       const Reflection<kBrdf>& surface, const V3& sum) {
  const DF d;
  const Arriving a = arriving(light, at, n);
  if (hn::AllFalse(d, a.lit)) return sum;
  VF weight = a.amount;
  if (light.maps > 0)
    weight = hn::Mul(weight, visiblePart(light, a.lit, a.q, load3(in.g->facet, x, y), offPlane(light, in.projector, at)));
  const V3 f = surface.towards(a.toLight, a.cosine);
  const auto reflected = [&](VF of, float color) HWY_ATTR {
    return hn::IfThenElseZero(a.lit, hn::Mul(of, hn::Mul(hn::Set(d, color), weight)));
  };
  return {hn::Add(sum.x, reflected(f.x, light.color.x)), hn::Add(sum.y, reflected(f.y, light.color.y)),
          hn::Add(sum.z, reflected(f.z, light.color.z))};
}

template <Brdf kBrdf>
void lightRows(const DirectLightInput& in, int y0, int y1, LinearColor& out) {
  const DF d;
  const VF zero = hn::Zero(d);
  const raster::GBuffer& g = *in.g;
  const ViewDirections directions(in.projector);
  forBlocks(in, in.lights, y0, y1, [&](int x0, int x1, int top, int bottom, const std::vector<const PunctualLight*>& lights) HWY_ATTR {
    if (lights.empty() && in.add) return;
    for (int y = top; y < bottom; ++y)
      for (int x = x0; x < x1; x += int(hn::Lanes(d))) {
        V3 sum = in.add ? load3(out.rgb, x, y) : V3{zero, zero, zero};
        const Points at = pointsAt(g.depth, in.projector, x, y);
        if (!lights.empty() && !hn::AllFalse(d, at.seen)) {
          const V3 n = load3(g.normal, x, y);
          // What the padding of rows holds must not look anything up.
          const VF metallic = isGlossy(kBrdf) ? hn::IfThenElseZero(at.seen, hn::LoadU(d, g.metallic.row(y) + x)) : zero;
          const VF roughness = isGlossy(kBrdf) ? hn::IfThenElseZero(at.seen, hn::LoadU(d, g.roughness.row(y) + x)) : zero;
          const Reflection<kBrdf> surface(load3(g.albedo, x, y), metallic, roughness, n, directions.at(x, y));
          for (const PunctualLight* light : lights) sum = addLight(in, *light, at, n, x, y, surface, sum);
        }
        hn::StoreU(sum.x, d, out.rgb[0].row(y) + x);
        hn::StoreU(sum.y, d, out.rgb[1].row(y) + x);
        hn::StoreU(sum.z, d, out.rgb[2].row(y) + x);
      }
  });
}

void DirectLight(const DirectLightInput& in, int y0, int y1, LinearColor& out) {
  switch (in.brdf) {
    case Brdf::Lambert: return lightRows<Brdf::Lambert>(in, y0, y1, out);
    case Brdf::Gltf: return lightRows<Brdf::Gltf>(in, y0, y1, out);
    case Brdf::BlinnPhong: return lightRows<Brdf::BlinnPhong>(in, y0, y1, out);
    case Brdf::BlinnPhongThresholded: return lightRows<Brdf::BlinnPhongThresholded>(in, y0, y1, out);
  }
}

uint32_t MapsReached(const DirectLightInput& in, const PunctualLight& light, int y0, int y1) {
  const DF d;
  uint32_t found = 0;
  const uint32_t all = light.maps == 6 ? 0x3F : 1;
  forBlocks(in, {&light, 1}, y0, y1, [&](int x0, int x1, int top, int bottom, const std::vector<const PunctualLight*>& lights) HWY_ATTR {
    for (int y = top; y < bottom && !lights.empty(); ++y)
      for (int x = x0; x < x1 && found != all; x += int(hn::Lanes(d))) {
        const Arriving a = arriving(light, pointsAt(in.g->depth, in.projector, x, y), load3(in.g->normal, x, y));
        if (hn::AllFalse(d, a.lit)) continue;
        if (light.maps < 6) found = 1;
        for (int map = 0; light.maps == 6 && map < 6; ++map)
          if (!(found >> map & 1) && !hn::AllFalse(d, hn::And(a.lit, belongsTo(map, a.q)))) found |= 1u << map;
      }
  });
  return found;
}

LightBounds BoundsInLight(const raster::Plane<float>& depth, const Projector& projector, const PunctualLight& light, int y0, int y1) {
  const DF d;
  LightBounds bounds;
  V3 least = set3(bounds.min), most = set3(bounds.max);
  const auto grow = [](MF seen, VF v, VF& lo, VF& hi) HWY_ATTR {
    lo = hn::IfThenElse(hn::And(seen, hn::Lt(v, lo)), v, lo);
    hi = hn::IfThenElse(hn::And(seen, hn::Gt(v, hi)), v, hi);
  };
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < depth.width(); x += int(hn::Lanes(d))) {
      const Points at = pointsAt(depth, projector, x, y);
      const V3 q = toLightSpace(light, at.p);
      grow(at.seen, q.x, least.x, most.x);
      grow(at.seen, q.y, least.y, most.y);
      grow(at.seen, q.z, least.z, most.z);
    }
  HWY_ALIGN float lanes[2][3][16];
  const VF lo[3] = {least.x, least.y, least.z}, hi[3] = {most.x, most.y, most.z};
  for (int c = 0; c < 3; ++c) {
    hn::Store(lo[c], d, lanes[0][c]);
    hn::Store(hi[c], d, lanes[1][c]);
    bounds.min[c] = *std::min_element(lanes[0][c], lanes[0][c] + hn::Lanes(d));
    bounds.max[c] = *std::max_element(lanes[1][c], lanes[1][c] + hn::Lanes(d));
  }
  return bounds;
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(DirectLight);
HWY_EXPORT(MapsReached);
HWY_EXPORT(BoundsInLight);

void directLight(const DirectLightInput& in, int y0, int y1, LinearColor& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(DirectLight, target)(in, y0, y1, out);
}

uint32_t mapsReached(const DirectLightInput& in, const PunctualLight& light, int y0, int y1, raster::Target target) {
  const raster::FloatEnvironment environment;
  return OBSCURA_DISPATCH(MapsReached, target)(in, light, y0, y1);
}

LightBounds boundsInLight(const raster::Plane<float>& depth, const Projector& projector, const PunctualLight& light, int y0, int y1,
                          raster::Target target) {
  const raster::FloatEnvironment environment;
  return OBSCURA_DISPATCH(BoundsInLight, target)(depth, projector, light, y0, y1);
}

void LightBounds::add(const LightBounds& b) {
  for (int c = 0; c < 3; ++c) min[c] = std::min(min[c], b.min[c]), max[c] = std::max(max[c], b.max[c]);
}

}  // namespace obscura::post
#endif
