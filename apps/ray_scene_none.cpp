// In the place of ray_scene_embree.cpp where Embree is not installed.
#include <stdexcept>

#include "obscura/apps/ray_scene.h"

namespace obscura::apps {

struct RayScene::State {};

RayScene::RayScene(const RaySurface&, int, const RayKeep*) {
  throw std::runtime_error("this program was built without Embree 3, which traces rays: install it and build again");
}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
void RayScene::intersect(RayBatch&) const {}
double RayScene::buildMs() const { return 0; }

}  // namespace obscura::apps
