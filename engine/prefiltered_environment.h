// In:  an environment as a cube map.
// Out: what rough surfaces reflect of it: a chain of cube maps, one per roughness, each the light averaged over the lobe of
//      GGX (Karis 2013, "Real Shading in Unreal Engine 4": the first sum of the split sum, with n = v = r).
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "obscura/engine/environment_map.h"
#include "obscura/post/environment_cube.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {

// Level 0 is the mirror, the cube map itself. Level k is that of the roughness q = k / 8, alpha = q^2:
//   L(r, q) = integral of L(l) D(h) max(0, r . l) dl over the same of D(h) max(0, r . l) dl,   h between r and l
struct PrefilteredEnvironment {
  std::vector<int> sides;         // texels a side of a face, by level: none, one (the mirror alone) or post::kRoughnessLevels
  LargeVector<glm::vec3> texels;  // level by level, as post::EnvironmentChain has them

  bool empty() const { return sides.empty(); }
  bool hasReflections() const { return int(sides.size()) == post::kRoughnessLevels; }
  post::EnvironmentChain view() const;
};

// `cube` has its borders. Level 0 alone.
PrefilteredEnvironment mirrorOf(EnvironmentMap cube);

// All levels. The lobe's integral is a sum over the sphere's parts: nodes of a quadtree of the map reduced to 128 texels a
// face, the smaller the nearer they are to the lobe's core. A node's light arrives from where its light is (the mean of its
// directions, by brightness), so that a sun is where it is, however large the node. No sampling, so no noise. The sums are in
// float. Against direct integration over all texels of the cube each level errs by less than 1 %: root mean square over the
// mean, for a sky with a sun of 10 degrees radius, and with one of 1 degree that is 30 times as bright. What is the same
// everywhere stays that but for roundings (10^-5). The same bits for any number of threads.
PrefilteredEnvironment prefiltered(EnvironmentMap cube, raster::Parallel& parallel);

}  // namespace obscura::engine
