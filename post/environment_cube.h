// An environment as cube maps, for passes that look into it pixel by pixel.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "obscura/raster/span.h"

namespace obscura::post {

// A cube's faces are +x -x +y -y +z -z, each seen from inside, as in a map whose middle is -z (right-handed, y up):
//   face      +x   -x   +y   -y   +z   -z
//   right     +z   -z   +x   +x   -x   +x
//   up        +y   +y   +z   -z   +y   +y
// With m the largest of |d.x|, |d.y|, |d.z| (of equals the first), a direction d lies in the face of m's axis and sign, at
// s = d . right / m and t = d . up / m. A face has `size` x `size` texels, 1 ... 8192, row 0 on top, and around them a border
// of one that continues it, so that bilinear look-ups are seamless: in all 6 x (size + 2) x (size + 2) of linear radiance,
// >= 0 and finite.

// What surfaces reflect of an environment by their roughness: level k is for the roughness k / (kRoughnessLevels - 1), 0 is
// the mirror, and is also what is seen behind the scene.
constexpr int kRoughnessLevels = 9;
struct EnvironmentChain {
  int levels = 0;                        // 1: the mirror alone, or kRoughnessLevels
  int sizes[kRoughnessLevels] = {};      // texels a side
  raster::Span<const glm::vec3> texels;  // of all levels, one after the other; less than 2^31 / 3

  int first(int level) const {
    int texel = 0;
    for (int k = 0; k < level; ++k) texel += 6 * (sizes[k] + 2) * (sizes[k] + 2);
    return texel;
  }
};

// How a frame sees it.
struct EnvironmentView {
  EnvironmentChain chain;
  glm::mat3 mapFromView{1};  // from camera space (x right, y up, z towards the eye) to directions of the map
  float intensity = 1;       // a factor on the radiance
};

}  // namespace obscura::post
