#include "obscura/engine/downsample_frame.h"

#include <utility>
#include <vector>

#include "obscura/post/downsample.h"

namespace obscura::engine {
namespace {

using Values = raster::Plane<float>;
using Ids = raster::Plane<uint32_t>;
template <class P>
using Pairs = std::vector<std::pair<const P*, P*>>;  // of sub-pixels, of pixels

struct Work {
  Pairs<Values> means, nearest;
  Pairs<Ids> nearestIds;
};

Work workOf(const Frame& full, const FrameSettings& settings, Frame& out) {
  Work work;
  const auto add = [&](auto& pairs, const auto& from, auto& to) {
    to.resize(out.width, out.height);
    pairs.emplace_back(&from, &to);
  };
  const auto addThree = [&](Pairs<Values>& pairs, const Values (&from)[3], Values (&to)[3]) {
    for (int c = 0; c < 3; ++c) add(pairs, from[c], to[c]);
  };
  bool color = settings.display;
  for (Aov aov : settings.aovs) {
    switch (aov) {
      case Aov::Color: color = true; break;
      case Aov::Depth: add(work.nearest, full.g.depth, out.g.depth); break;
      case Aov::Depth2: add(work.nearest, full.g.depth2, out.g.depth2); break;
      case Aov::DepthBack: add(work.nearest, full.g.depthBack, out.g.depthBack); break;
      case Aov::Normal: addThree(work.nearest, full.g.normal, out.g.normal); break;
      case Aov::Albedo: addThree(work.means, full.g.albedo, out.g.albedo); break;
      case Aov::Emissive: addThree(work.means, full.g.emissive, out.g.emissive); break;
      case Aov::Metallic: add(work.means, full.g.metallic, out.g.metallic); break;
      case Aov::Roughness: add(work.means, full.g.roughness, out.g.roughness); break;
      case Aov::Obscurance: add(work.means, full.transfer.obscurance, out.transfer.obscurance); break;
      case Aov::Transfer: addThree(work.means, full.transfer.w, out.transfer.w); break;
      case Aov::Position: addThree(work.nearest, full.g.position, out.g.position); break;
      case Aov::Triangle: add(work.nearestIds, full.g.triangle, out.g.triangle); break;
      case Aov::Instance: add(work.nearestIds, full.g.instance, out.g.instance); break;
      case Aov::Material: add(work.nearestIds, full.g.material, out.g.material); break;
    }
  }
  if (color) addThree(work.means, full.color.rgb, out.color.rgb);
  return work;
}

}  // namespace

void downsampleFrame(const Frame& full, const FrameSettings& settings, raster::Parallel& parallel,
                     std::optional<raster::Target> target, Frame& out) {
  constexpr size_t kRowsPerTask = 8;
  const int s = settings.supersample;
  out.width = full.width / s, out.height = full.height / s;
  out.x = full.x / s, out.y = full.y / s;
  out.imageWidth = settings.width, out.imageHeight = settings.height;
  out.g = raster::GBuffer(out.width, out.height, {});
  out.transfer = {};
  const Work work = workOf(full, settings, out);
  Ids nearest;
  const bool picks = !work.nearest.empty() || !work.nearestIds.empty();
  if (picks) nearest = Ids(out.width, out.height);

  parallel.forRanges(size_t(out.height), kRowsPerTask, [&](size_t begin, size_t end, int) {
    const int y0 = int(begin), y1 = int(end);
    const auto take = [&](const auto& from, auto& to) {
      target ? post::takeSubpixel(from, nearest, s, y0, y1, to, *target)
             : post::takeSubpixelRef(from, nearest, s, y0, y1, to);
    };
    for (const auto& [from, to] : work.means)
      target ? post::meanOfSubpixels(*from, s, y0, y1, *to, *target) : post::meanOfSubpixelsRef(*from, s, y0, y1, *to);
    if (!picks) return;
    target ? post::nearestSubpixel(full.g.depth, s, y0, y1, nearest, *target)
           : post::nearestSubpixelRef(full.g.depth, s, y0, y1, nearest);
    for (const auto& [from, to] : work.nearest) take(*from, *to);
    for (const auto& [from, to] : work.nearestIds) take(*from, *to);
  });
}

}  // namespace obscura::engine
