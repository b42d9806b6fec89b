#include "obscura/raster/candidates.h"

#include <algorithm>
#include <functional>

#include "obscura/raster/cull.h"

namespace obscura::raster {
namespace {

void leaveOut(Statistics& s, uint64_t Statistics::*what, uint64_t triangles) {
  ++(s.*what);
  s.trianglesCulled += triangles;
}

void addCluster(const View& view, const Draw& draw, const Cluster& cluster, const Culling& culling, Candidates& out,
                Statistics& statistics) {
  Candidate candidate{&draw, &cluster, 0};
  if (culling.skip) {
    const ViewSphere sphere = viewSphere(draw, cluster.center, cluster.radius);
    if (!clusterFacesEye(draw, cluster) || !sphereVisible(view, sphere))
      return leaveOut(statistics, &Statistics::clustersCulled, cluster.triangleCount);
    const ScreenBound bound = screenBound(view, sphere);
    if (culling.occlusion && culling.occlusion->hides(bound))
      return leaveOut(statistics, &Statistics::clustersHidden, cluster.triangleCount);
    candidate.nearestKey = bound.nearestKey;
    out.boxes += int64_t(std::max(bound.x1 - bound.x0 + 1, 0)) * std::max(bound.y1 - bound.y0 + 1, 0);
  }
  out.clusters.push_back(candidate);
}

}  // namespace

std::vector<const Draw*> visibleInstances(const View& view, Span<const Draw> draws, bool skip, Statistics& statistics) {
  std::vector<std::pair<float, const Draw*>> found;
  for (const Draw& draw : draws) {
    ++statistics.instances;
    statistics.triangles += draw.triangleCount;
    const ViewSphere sphere = viewSphere(draw, draw.clusters->center, draw.clusters->radius);
    if (skip && !sphereVisible(view, sphere)) leaveOut(statistics, &Statistics::instancesCulled, draw.triangleCount);
    else found.push_back({-screenBound(view, sphere).nearestKey, &draw});
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const Draw*> visible;
  for (const auto& [key, draw] : found) visible.push_back(draw);
  return visible;
}

Candidates findCandidates(const View& view, Span<const Draw* const> draws, const Culling& culling, Parallel& parallel,
                          Statistics& statistics) {
  // Clusters of what is not hidden as a whole, numbered through: first[k] is the number of draw k's first.
  std::vector<const Draw*> open;
  std::vector<size_t> first;
  size_t count = 0;
  for (const Draw* draw : draws) {
    const Clusters& all = *draw->clusters;
    if (culling.occlusion && culling.occlusion->hides(screenBound(view, viewSphere(*draw, all.center, all.radius)))) {
      leaveOut(statistics, &Statistics::instancesHidden, draw->triangleCount);
      continue;
    }
    open.push_back(draw);
    first.push_back(count);
    count += all.clusters.size();
  }
  statistics.clusters += count;

  struct Part {
    Candidates candidates;
    Statistics statistics;
  };
  std::vector<Part> parts(size_t(parallel.workers()));
  constexpr size_t kClustersPerTask = 256;
  parallel.forRanges(count, kClustersPerTask, [&](size_t begin, size_t end, int worker) {
    Part& part = parts[size_t(worker)];
    size_t k = size_t(std::upper_bound(first.begin(), first.end(), begin) - first.begin()) - 1;
    for (size_t i = begin; i < end; ++i) {
      while (k + 1 < first.size() && i >= first[k + 1]) ++k;
      addCluster(view, *open[k], open[k]->clusters->clusters[i - first[k]], culling, part.candidates, part.statistics);
    }
  });
  Candidates all;
  for (const Part& part : parts) {
    all.clusters.insert(all.clusters.end(), part.candidates.clusters.begin(), part.candidates.clusters.end());
    all.boxes += part.candidates.boxes;
    statistics.add(part.statistics);
  }
  return all;
}

size_t nearestFirst(Candidate* clusters, size_t count, size_t parts) {
  if (parts <= 1 || count == 0) return count;
  std::vector<float> keys;
  keys.reserve(count);
  for (size_t i = 0; i < count; ++i) keys.push_back(clusters[i].nearestKey);
  const auto threshold = keys.begin() + std::ptrdiff_t(count / parts);
  std::nth_element(keys.begin(), threshold, keys.end(), std::greater<>());
  const auto isNear = [&](const Candidate& c) { return c.nearestKey > *threshold; };
  return size_t(std::stable_partition(clusters, clusters + count, isNear) - clusters);
}

}  // namespace obscura::raster
