// In:  the instances of a frame, and what is known to hide others.
// Out: the clusters that may be seen, nearest first as far as it matters.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "obscura/raster/occlusion.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/statistics.h"
#include "obscura/raster/view.h"

namespace obscura::raster {

struct Candidate {
  const Draw* draw;
  const Cluster* cluster;
  float nearestKey;  // that no point of it exceeds; 0 where nothing is skipped
};

struct Candidates {
  std::vector<Candidate> clusters;
  int64_t boxes = 0;  // pixels in their boxes, added up
};

// What to leave out. skip false: nothing. occlusion: what has been drawn before, or null.
struct Culling {
  bool skip = true;
  const OcclusionMap* occlusion = nullptr;
};

// Those in view, front to back. What is left out is counted.
std::vector<const Draw*> visibleInstances(const View& view, Span<const Draw> draws, bool skip, Statistics& statistics);

// Their clusters but those outside the view, facing away or hidden. In no particular order.
Candidates findCandidates(const View& view, Span<const Draw* const> draws, const Culling& culling, Parallel& parallel,
                          Statistics& statistics);

// Puts the nearest ones, one in `parts`, before the others, and tells how many they are. Both stay in the order of the
// memory that they read; which is in which part does not depend on the order.
size_t nearestFirst(Candidate* clusters, size_t count, size_t parts);

}  // namespace obscura::raster
