#include "obscura/post/ambient_transfer.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/ambient_transfer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/sample_sets.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Depth map as the containment test sees it.
struct DepthMap {
  const Projector& projector;
  const raster::GBuffer& g;
  VF bias, radius;

  // Element of the nearest texel, clamped to the G-buffer.
  HWY_INLINE VI texelOf(const V3& p) const {
    const DF d;
    const DI di;
    VF u = p.x, v = p.y;
    if (projector.perspective) {
      const VF inverse = hn::Div(hn::Set(d, 1.0f), p.z);
      u = hn::Mul(u, inverse);
      v = hn::Mul(v, inverse);
    }
    u = hn::Add(hn::Mul(u, hn::Set(d, projector.xScale)), hn::Set(d, projector.xCenter));
    v = hn::Add(hn::Mul(v, hn::Set(d, projector.yScale)), hn::Set(d, projector.yCenter));
    // The conversion truncates, which is the floor of what is not negative; NaN becomes the first.
    auto clamp = [&](VF c, int first, int size) HWY_ATTR {
      const VF least = hn::Set(d, float(first)), last = hn::Set(d, float(first + size - 1));
      if (HWY_UNLIKELY(first < 0)) c = hn::Floor(c);
      c = hn::IfThenElse(hn::Gt(c, least), c, least);
      return hn::Sub(hn::ConvertTo(di, hn::IfThenElse(hn::Lt(c, last), c, last)), hn::Set(di, first));
    };
    const VI column = clamp(u, projector.xFirst, projector.width), row = clamp(v, projector.yFirst, projector.height);
    return hn::Add(hn::Mul(row, hn::Set(di, int32_t(g.depth.stride()))), column);
  }

  // Inner exactly when bias < z - z* < R; the upper bound keeps far foreground objects from casting silhouettes.
  HWY_INLINE MF inner(const V3& p, VI texel) const {
    const DF d;
    const VF behind = hn::Sub(p.z, hn::GatherIndex(d, g.depth.data(), texel));
    const MF between = hn::And(hn::Gt(behind, bias), hn::Lt(behind, radius));
    return hn::And(between, hn::Gt(p.z, hn::Set(d, projector.zNear)));
  }
};

void transferRow(const TransferInput& in, int y, TransferSums& out) {
  const DF d;
  const DI di;
  const int lanes = int(hn::Lanes(d));
  const raster::GBuffer& g = *in.g;
  const Projector& projector = in.projector;
  const bool neighbour = in.settings.albedo == TransferAlbedo::Neighbour;
  const int steps = in.settings.steps;
  const VF all = hn::Set(d, float(in.settings.samples)), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const DepthMap map{projector, g, hn::Set(d, in.settings.bias), hn::Set(d, in.settings.radius)};

  // The row's four rotations, repeated so that any vector of them can be loaded. The pattern is that of the whole image.
  HWY_ALIGN float cosines[32], sines[32];
  for (int x = 0; x < 32; ++x) {
    const glm::vec2 r = in.settings.interleave ? rotations()[size_t(((x + projector.xFirst) & 3) + 4 * ((y + projector.yFirst) & 3))] : glm::vec2(1, 0);
    cosines[x] = r.x;
    sines[x] = r.y;
  }
  const VF yRay = hn::Set(d, (float(y + projector.yFirst) + 0.5f - projector.yCenter) * projector.yInverse);

  for (int x = 0; x < g.width; x += lanes) {
    const VF z = hn::LoadU(d, g.depth.row(y) + x);
    const MF seen = hn::And(hn::Lt(z, hn::Set(d, std::numeric_limits<float>::infinity())),
                            hn::RebindMask(d, hn::Lt(hn::Iota(di, x), hn::Set(di, g.width))));
    VF numerator = all, denominator[3] = {all, all, all};
    if (!hn::AllFalse(d, seen)) {
      VF px = hn::Mul(hn::Sub(hn::Add(hn::ConvertTo(d, hn::Iota(di, x + projector.xFirst)), hn::Set(d, 0.5f)), hn::Set(d, projector.xCenter)),
                      hn::Set(d, projector.xInverse));
      VF py = yRay;
      if (projector.perspective) px = hn::Mul(px, z), py = hn::Mul(py, z);

      // T = normalize(N x (0, 1, 0.01)), B = N x T, turned by the pixel's angle.
      const V3 n{hn::LoadU(d, g.normal[0].row(y) + x), hn::LoadU(d, g.normal[1].row(y) + x),
                 hn::Neg(hn::LoadU(d, g.normal[2].row(y) + x))};
      const VF hundredth = hn::Set(d, 0.01f);
      V3 t{hn::Sub(hn::Mul(n.y, hundredth), n.z), hn::Neg(hn::Mul(n.x, hundredth)), n.x};
      const VF square = dot(t, t);
      const MF direction = hn::Gt(square, hn::Set(d, 1e-12f));
      const VF length = hn::Sqrt(hn::IfThenElse(direction, square, one));
      t = {hn::IfThenElse(direction, hn::Div(t.x, length), one), hn::IfThenElseZero(direction, hn::Div(t.y, length)),
           hn::IfThenElseZero(direction, hn::Div(t.z, length))};
      const V3 b = cross(n, t);
      const VF c = hn::LoadU(d, cosines + (x & 3)), s = hn::LoadU(d, sines + (x & 3));
      const V3 tTurned{hn::Add(hn::Mul(c, t.x), hn::Mul(s, b.x)), hn::Add(hn::Mul(c, t.y), hn::Mul(s, b.y)),
                       hn::Add(hn::Mul(c, t.z), hn::Mul(s, b.z))};
      const V3 bTurned{hn::Sub(hn::Mul(s, t.x), hn::Mul(c, b.x)), hn::Sub(hn::Mul(s, t.y), hn::Mul(c, b.y)),
                       hn::Sub(hn::Mul(s, t.z), hn::Mul(c, b.z))};

      numerator = zero;
      for (const glm::vec3& offset : in.offsets) {
        MF hit = hn::MaskFromVec(zero);
        VI hitTexel = hn::Zero(di);
        for (int k = 1; k <= steps; ++k) {
          const float part = float(k) / float(steps);
          const VF X = hn::Set(d, offset.x * part), Y = hn::Set(d, offset.y * part), Z = hn::Set(d, offset.z * part);
          auto shifted = [&](VF p, VF tc, VF bc, VF nc) HWY_ATTR {
            return hn::Add(p, hn::Add(hn::Add(hn::Mul(X, tc), hn::Mul(Y, bc)), hn::Mul(Z, nc)));
          };
          const V3 p{shifted(px, tTurned.x, bTurned.x, n.x), shifted(py, tTurned.y, bTurned.y, n.y),
                     shifted(z, tTurned.z, bTurned.z, n.z)};
          const VI texel = map.texelOf(p);
          const MF first = hn::AndNot(hit, map.inner(p, texel));
          hitTexel = hn::IfThenElse(hn::RebindMask(di, first), texel, hitTexel);
          hit = hn::Or(hit, first);
        }
        numerator = hn::Add(numerator, hn::IfThenZeroElse(hit, one));
        if (neighbour && !hn::AllFalse(d, hn::And(hit, seen)))
          for (int ch = 0; ch < 3; ++ch) {
            const VF a = hn::GatherIndex(d, g.albedo[ch].data(), hitTexel);
            denominator[ch] = hn::Sub(denominator[ch], hn::IfThenElseZero(hit, a));
          }
      }
      numerator = hn::IfThenElse(seen, numerator, all);
      for (VF& v : denominator) v = hn::IfThenElse(seen, v, all);
    }
    hn::StoreU(numerator, d, out.numerator.row(y) + x);
    if (neighbour)
      for (int ch = 0; ch < 3; ++ch) hn::StoreU(denominator[ch], d, out.denominator[ch].row(y) + x);
  }
}

void AmbientTransfer(const TransferInput& in, int y0, int y1, TransferSums& out) {
  for (int y = y0; y < y1; ++y) transferRow(in, y, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(AmbientTransfer);

void ambientTransfer(const TransferInput& in, int y0, int y1, TransferSums& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(AmbientTransfer, target)(in, y0, y1, out);
}

TransferSums makeTransferSums(const TransferInput& in, TransferSums used) {
  const bool denominators = in.settings.albedo == TransferAlbedo::Neighbour;
  used.numerator.resize(in.g->width, in.g->height);
  for (auto& plane : used.denominator) plane.resize(denominators ? in.g->width : 0, denominators ? in.g->height : 0);
  return used;
}

}  // namespace obscura::post
#endif
