// Per target: the ambient light of what belongs to an instance that has its own, see AmbientLight::instances.
#if defined(OBSCURA_POST_INSTANCE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_INSTANCE_LIGHT_INL_H_
#undef OBSCURA_POST_INSTANCE_LIGHT_INL_H_
#else
#define OBSCURA_POST_INSTANCE_LIGHT_INL_H_
#endif

#include <glm/vec3.hpp>

#include "obscura/post/vector-inl.h"
#include "obscura/raster/plane.h"
#include "obscura/raster/span.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// lights: not empty. Of pixel x and those right of it; elsewhere `otherwise`.
HWY_INLINE V3 orOfInstance(raster::Span<const glm::vec3> lights, const raster::Plane<uint32_t>& instance, int x, int y, const V3& otherwise) {
  const DF d;
  const DI di;
  const VI id = hn::BitCast(di, hn::LoadU(hn::RebindToUnsigned<DF>(), instance.row(y) + x)), zero = hn::Zero(di);
  const auto known = hn::And(hn::Gt(id, hn::Set(di, -1)), hn::Lt(id, hn::Set(di, int32_t(lights.size()))));
  const VI first = hn::IfThenElse(known, hn::Add(hn::Add(id, id), id), zero);
  const float* table = &lights[0].x;
  const VF red = hn::GatherIndex(d, table, first);
  const MF own = hn::And(hn::RebindMask(d, known), hn::Ge(red, hn::Zero(d)));
  return {hn::IfThenElse(own, red, otherwise.x), hn::IfThenElse(own, hn::GatherIndex(d, table + 1, first), otherwise.y),
          hn::IfThenElse(own, hn::GatherIndex(d, table + 2, first), otherwise.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
