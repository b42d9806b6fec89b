// In:  the triangles of a scene.
// Out: the first that a ray meets, by Embree. Nothing else includes Embree; a build without it has ray_scene_none.cpp.
#pragma once

#include <cstdint>
#include <memory>

#include "obscura/apps/ray_surface.h"

namespace obscura::apps {

// Rays in camera space, structure of arrays.
struct RayBatch {
  static constexpr int kSize = 16;
  static constexpr uint32_t kMiss = 0xFFFFFFFFu;

  // In. Lanes from `count` on are not looked at; a lane whose reach is negative has no ray.
  int count = 0;
  alignas(64) float origin[3][kSize];
  float direction[3][kSize];  // unit
  float reach[kSize];         // how far it goes; out: the distance of what it meets
  // Out.
  uint32_t instance[kSize];   // kMiss: nothing within reach
  uint32_t triangle[kSize];
  float u[kSize], v[kSize];

  TrianglePoint point(int lane) const { return {instance[lane], triangle[lane], u[lane], v[lane]}; }
};

// By instance and triangle: 0 where it is not to be there.
using RayKeep = std::vector<std::vector<uint8_t>>;

// Triangles block from both sides, whether their material is double-sided or not: culling is the camera's business. What
// an alpha mask cuts out does not block.
class RayScene {
 public:
  // threads: of the tree's construction, 0: one per core. keep: null: all. The surface must outlive it. Throws
  // std::runtime_error where the program was built without Embree or it fails, std::bad_alloc.
  RayScene(const RaySurface& surface, int threads, const RayKeep* keep = nullptr);
  ~RayScene();
  RayScene(RayScene&&) noexcept;

  void intersect(RayBatch& rays) const;  // from any thread
  double buildMs() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace obscura::apps
