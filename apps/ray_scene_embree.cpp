#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "obscura/apps/ray_scene.h"
#include "obscura/raster/stopwatch.h"

namespace obscura::apps {
namespace {

struct MaskedGeometry {
  const RaySurface* surface;
  uint32_t instance;
};

// Lets a ray through where the mask has a hole.
void filterMask(const RTCFilterFunctionNArguments* a) {
  const auto& masked = *static_cast<const MaskedGeometry*>(a->geometryUserPtr);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] != -1) continue;
    const TrianglePoint p = {masked.instance, RTCHitN_primID(a->hit, a->N, i), RTCHitN_u(a->hit, a->N, i),
                             RTCHitN_v(a->hit, a->N, i)};
    if (!masked.surface->covered(p)) a->valid[i] = 0;
  }
}

}  // namespace

struct RayScene::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<MaskedGeometry> masked;
  double buildMs = 0;

  State(const RaySurface& surface, int threads, const RayKeep* keep) {
    device = rtcNewDevice(threads > 0 ? ("threads=" + std::to_string(threads)).c_str() : nullptr);
    check();
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // watertight: no ray slips through a shared edge
    masked.reserve(surface.instances());             // its elements must not move
    for (size_t i = 0; i < surface.instances(); ++i) add(surface, uint32_t(i), keep ? &(*keep)[i] : nullptr);
    raster::Stopwatch watch;
    rtcCommitScene(scene);
    buildMs = watch.lap();
    check();
  }
  State(const State&) = delete;
  ~State() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void add(const RaySurface& surface, uint32_t instance, const std::vector<uint8_t>* keep) {
    const auto positions = surface.positions(instance);
    const auto indices = surface.indices(instance);
    if (positions.empty() || indices.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Buffers of Embree's own, which are padded as it wants to read them.
    void* vertex = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, positions.size());
    void* index = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, indices.size() / 3);
    if (!vertex || !index) {
      rtcReleaseGeometry(geometry);
      throw std::bad_alloc();
    }
    std::memcpy(vertex, positions.data(), positions.size() * 12);
    std::memcpy(index, indices.data(), indices.size() / 3 * 12);
    for (size_t t = 0; keep && t < keep->size(); ++t)  // to a point, which no ray meets: the others keep their numbers
      if (!(*keep)[t]) std::memset(static_cast<uint32_t*>(index) + 3 * t, 0, 12);
    if (surface.masked(instance)) {
      masked.push_back({&surface, instance});
      rtcSetGeometryUserData(geometry, &masked.back());
      rtcSetGeometryIntersectFilterFunction(geometry, filterMask);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, instance);
    rtcReleaseGeometry(geometry);
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree failed: error " + std::to_string(int(error)));
  }
};

RayScene::RayScene(const RaySurface& surface, int threads, const RayKeep* keep)
    : state_(std::make_unique<State>(surface, threads, keep)) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

double RayScene::buildMs() const { return state_->buildMs; }

void RayScene::intersect(RayBatch& rays) const {
  static_assert(RayBatch::kMiss == RTC_INVALID_GEOMETRY_ID, "a miss is a miss");
  constexpr int kSize = RayBatch::kSize;
  alignas(64) int valid[kSize];
  RTCRayHit16 r;
  float* const origin[] = {r.ray.org_x, r.ray.org_y, r.ray.org_z};
  float* const direction[] = {r.ray.dir_x, r.ray.dir_y, r.ray.dir_z};
  for (int c = 0; c < 3; ++c) {
    std::memcpy(origin[c], rays.origin[c], sizeof rays.origin[c]);
    std::memcpy(direction[c], rays.direction[c], sizeof rays.direction[c]);
  }
  std::memcpy(r.ray.tfar, rays.reach, sizeof rays.reach);
  for (int i = 0; i < kSize; ++i) {
    valid[i] = i < rays.count && rays.reach[i] >= 0 ? -1 : 0;
    r.ray.tnear[i] = r.ray.time[i] = 0;
    r.ray.mask[i] = ~0u;
    r.ray.id[i] = r.ray.flags[i] = 0;
    r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect16(valid, state_->scene, &context, &r);
  std::memcpy(rays.reach, r.ray.tfar, sizeof rays.reach);
  std::memcpy(rays.instance, r.hit.geomID, sizeof rays.instance);
  std::memcpy(rays.triangle, r.hit.primID, sizeof rays.triangle);
  std::memcpy(rays.u, r.hit.u, sizeof rays.u);
  std::memcpy(rays.v, r.hit.v, sizeof rays.v);
}

}  // namespace obscura::apps
