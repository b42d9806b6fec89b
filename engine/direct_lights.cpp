#include "obscura/engine/direct_lights.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "obscura/engine/draw_list.h"
#include "obscura/raster/stopwatch.h"

namespace obscura::engine {
namespace {

constexpr size_t kRowsPerTask = 8;
constexpr size_t kMostTexels = size_t(1) << 26;  // of the maps that are there at a time, unless one light has more

template <class Visit>
void forLights(const Scene& scene, const FrameSettings& s, const Visit& visit) {
  if (s.sceneLights)
    for (const SceneLight& light : scene.lights) visit(light);
  for (const SceneLight& light : s.lights) visit(light);
}

void renderMap(const DirectLights::Input& in, const raster::DrawList& casters, const raster::Camera& camera, raster::Rasterizer& rasterizer,
               raster::Plane<float>& map) {
  const int size = in.settings.shadowSize;
  if (!in.reference) return rasterizer.renderDepth(casters, camera, size, size, map);
  raster::PlaneSet planes;
  planes.depth = true;
  raster::GBuffer g;
  raster::renderReference(casters, camera, size, size, planes, g);
  map = std::move(g.depth);
}

// The sums over rows of what `of` gives, put together by `add`: in any order.
template <class Part, class Of>
Part overRows(raster::Parallel& parallel, int first, int end, const Of& of, void (*add)(Part&, const Part&)) {
  Part all{};
  std::mutex adding;
  parallel.forRanges(size_t(end - first), kRowsPerTask * 4, [&](size_t y0, size_t y1, int) {
    const Part part = of(first + int(y0), first + int(y1));
    const std::lock_guard<std::mutex> lock(adding);
    add(all, part);
  });
  return all;
}

}  // namespace

bool hasLights(const Scene& scene, const FrameSettings& s) { return !s.lights.empty() || (s.sceneLights && !scene.lights.empty()); }

bool hasShadows(const Scene& scene, const FrameSettings& s) {
  bool any = false;
  forLights(scene, s, [&](const SceneLight& light) { any |= light.shadows && s.shadows; });
  return any;
}

const char* wrongLights(const Scene& scene, const FrameSettings& s) {
  const char* wrong = s.shadowSize >= 16 && s.shadowSize <= kMostShadowSize ? nullptr : "shadow maps must have 16 to 8192 texels a side";
  forLights(scene, s, [&](const SceneLight& light) { wrong = wrong ? wrong : wrongLight(light); });
  return wrong;
}

LightStatistics DirectLights::draw(const Input& in, raster::Rasterizer& rasterizer, raster::Parallel& parallel, post::LinearColor& out,
                                   FrameTimings& timings) {
  raster::Stopwatch watch;
  const raster::DrawList casters = castersOf(in.list, casting_);
  LightStatistics found;
  std::vector<post::PunctualLight> batch;
  std::vector<std::pair<size_t, int>> mapOf;  // of the maps in use: light of the batch, number
  bool drawn = false;
  const auto flush = [&] {
    for (size_t k = 0; k < mapOf.size(); ++k) batch[mapOf[k].first].map[mapOf[k].second].depth = &maps_[k];
    timings.shadows += watch.lap();
    const post::DirectLightInput input{&in.g, in.projector, batch, in.settings.brdf, in.skip, drawn};
    parallel.forRanges(size_t(in.endRow - in.firstRow), kRowsPerTask, [&](size_t begin, size_t end, int) {
      const int y0 = in.firstRow + int(begin), y1 = in.firstRow + int(end);
      in.reference ? post::directLightRef(input, y0, y1, out) : post::directLight(input, y0, y1, out, in.target);
    });
    timings.direct += watch.lap();
    drawn = true;
    batch.clear();
    mapOf.clear();
  };
  forLights(in.scene, in.settings, [&](const SceneLight& light) {
    ++found.lights;
    if (light.color == glm::vec3(0)) return;
    const int size = light.shadows && in.settings.shadows ? in.settings.shadowSize : 0;
    LightViews views = viewsOf(light, in.settings.camera, in.scene.bounds, size);
    if (size > 0) {
      const post::DirectLightInput input{&in.g, in.projector, {}, in.settings.brdf, in.skip, false};
      const uint32_t needed = overRows<uint32_t>(
          parallel, in.firstRow, in.endRow,
          [&](int y0, int y1) {
            return in.reference ? post::mapsReachedRef(input, views.light, y0, y1) : post::mapsReached(input, views.light, y0, y1, in.target);
          },
          [](uint32_t& all, const uint32_t& part) { all |= part; });
      found.unseen += needed == 0;
      if (needed == 0) return;
      if (light.kind == post::LightKind::Directional) {
        const auto seen = overRows<post::LightBounds>(
            parallel, 0, in.whole.height(),
            [&](int y0, int y1) {
              return in.reference ? post::boundsInLightRef(in.whole, in.wholeProjector, views.light, y0, y1)
                                  : post::boundsInLight(in.whole, in.wholeProjector, views.light, y0, y1, in.target);
            },
            [](post::LightBounds& all, const post::LightBounds& part) { all.add(part); });
        fitted(light, in.settings.camera, in.scene.bounds, size, seen, views);
      }
      const size_t texels = size_t(size) * size_t(size);
      if (!batch.empty() && (mapOf.size() + views.cameras.size()) * texels > kMostTexels) flush();
      for (size_t map = 0; map < views.cameras.size(); ++map) {
        if (!(needed >> map & 1)) continue;
        if (maps_.size() == mapOf.size()) maps_.emplace_back();
        renderMap(in, casters, views.cameras[map], rasterizer, maps_[mapOf.size()]);
        mapOf.emplace_back(batch.size(), int(map));
        ++found.shadowMaps;
      }
    }
    batch.push_back(views.light);
  });
  if (!batch.empty() || !drawn) flush();
  return found;
}

}  // namespace obscura::engine
