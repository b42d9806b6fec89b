#include "obscura/engine/prefiltered_environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace obscura::engine {
namespace {

constexpr int kLevels = post::kRoughnessLevels;
// Texels a side: about three or more across the lobe's width at half its height, 1.28 alpha 2 radians.
constexpr int kSides[kLevels] = {0, 96, 48, 32, 24, 24, 16, 16, 16};
constexpr int kLeaves = 128;  // a side of a face
constexpr int kBlock = 4;     // texels a side that share a list of nodes
// A node's radius over its distance, or the lobe's width 2 alpha where that is more; and at most. 0.5 errs by 1.3 % at level 3;
// 0.25 takes twice as long and halves the errors.
constexpr double kCoarseness = 0.42, kMostRadius = 0.25;

// A part of the sphere.
struct Node {
  glm::dvec3 light{0};      // radiance times solid angle
  double solidAngle = 0;
  glm::dvec3 middle{0};     // unit: the mean of its directions
  glm::dvec3 brightest{0};  // unit: their mean by the light that they bring
  double radius = 0;        // of a ball around the middle that holds it: 9/10 of a square's side are enough anywhere on a cube
};

struct Tree {
  std::vector<LargeVector<Node>> levels;  // from the root of each face, 6 x 1 x 1, to the leaves
  const Node& at(size_t level, int face, int x, int y) const {
    return levels[level][(size_t(face) << (2 * level)) + (size_t(y) << level) + size_t(x)];
  }
};

// As sums: middle and brightest are not of unit length yet.
Node leafOf(const EnvironmentMap& map, double solidAngle, int face, int x, int y) {
  Node n;
  n.solidAngle = solidAngle;
  n.light = n.solidAngle * glm::dvec3(map.at(face, x, y));
  const glm::dvec3 d = map.projector().directionAt({face, x + 0.5, y + 0.5});
  n.middle = n.solidAngle * d;
  n.brightest = (n.light.x + n.light.y + n.light.z) * d;
  return n;
}

void addTo(Node& sum, const Node& part) {
  sum.light += part.light, sum.solidAngle += part.solidAngle;
  sum.middle += part.middle, sum.brightest += part.brightest;
}

void finish(Node& n) {
  n.middle = glm::normalize(n.middle);
  const double bright = glm::length(n.brightest);
  n.brightest = bright > 0 ? n.brightest / bright : n.middle;
  n.radius = 0.9 * std::sqrt(n.solidAngle);
}

Tree treeOf(const EnvironmentMap& cube, raster::Parallel& parallel) {
  const EnvironmentMap map = convertEnvironment(cube, {EnvironmentProjection::Cube, kLeaves, kLeaves}, parallel);
  std::vector<double> solidAngles(size_t(kLeaves) * kLeaves);  // the same on each face
  parallel.forRanges(kLeaves, 8, [&](size_t begin, size_t end, int) {
    for (size_t y = begin; y < end; ++y)
      for (size_t x = 0; x < kLeaves; ++x) solidAngles[y * kLeaves + x] = map.projector().solidAngle(int(x), int(y));
  });
  Tree tree;
  size_t last = 0;
  while ((1 << last) < kLeaves) ++last;
  tree.levels.resize(last + 1);
  for (size_t level = last + 1; level-- > 0;) {
    LargeVector<Node>& nodes = tree.levels[level];
    nodes.resize(size_t(6) << (2 * level));
    parallel.forRanges(size_t(6) << level, 8, [&](size_t begin, size_t end, int) {
      for (size_t row = begin; row < end; ++row)
        for (int x = 0; x < 1 << level; ++x) {
          const int face = int(row >> level), y = int(row & ((size_t(1) << level) - 1));
          Node& n = nodes[(row << level) + size_t(x)];
          if (level == last) n = leafOf(map, solidAngles[size_t(y) * kLeaves + size_t(x)], face, x, y);
          else
            for (int k = 0; k < 4; ++k) addTo(n, tree.at(level + 1, face, 2 * x + (k & 1), 2 * y + (k >> 1)));
        }
    });
  }
  for (LargeVector<Node>& nodes : tree.levels)
    parallel.forRanges(nodes.size(), 1024, [&](size_t begin, size_t end, int) {
      for (size_t k = begin; k < end; ++k) finish(nodes[k]);
    });
  return tree;
}

// Directions near one another, and the lobe around them.
struct Block {
  glm::dvec3 middle{0};
  double radius = 0, width = 0;
};

// The nodes that the sphere's half above the block consists of, in a fixed order.
void collect(const Tree& tree, const Block& block, size_t level, int face, int x, int y, std::vector<const Node*>& out) {
  const Node& n = tree.at(level, face, x, y);
  const double distance = glm::length(n.middle - block.middle);
  if (distance - n.radius - block.radius > 1.4142135623730951) return;  // below the horizon of all
  if (level + 1 == tree.levels.size() || n.radius <= std::min(kMostRadius, kCoarseness * std::max(block.width, distance - n.radius - block.radius))) {
    out.push_back(&n);
    return;
  }
  for (int k = 0; k < 4; ++k) collect(tree, block, level + 1, face, 2 * x + (k & 1), 2 * y + (k >> 1), out);
}

constexpr int kTexels = kBlock * kBlock;

// Of a block's texels, in float: each sums up its nodes one by one, and compilers do so for several texels at a time.
struct Texels {
  float x[kTexels], y[kTexels], z[kTexels];  // the direction r
  float red[kTexels] = {}, green[kTexels] = {}, blue[kTexels] = {}, all[kTexels] = {};
};

// D(h) max(0, r . l) but for a factor. With c = |l - r|^2 / 4: (r . h)^2 = 1 - c and r . l = 1 - 2 c.
inline float lobe(const Texels& r, int k, float x, float y, float z, float alpha2) {
  const float dx = x - r.x[k], dy = y - r.y[k], dz = z - r.z[k], c = 0.25f * (dx * dx + dy * dy + dz * dz);
  const float t = c + (1 - c) * alpha2, cosine = 1 - 2 * c;
  return (cosine > 0 ? cosine : 0.0f) / (t * t);
}

void add(const Node& n, float alpha2, Texels& t) {
  const glm::vec3 middle(n.middle), brightest(n.brightest), light(n.light);
  const float solidAngle = float(n.solidAngle);
  for (int k = 0; k < kTexels; ++k) {
    const float arriving = lobe(t, k, brightest.x, brightest.y, brightest.z, alpha2);
    t.red[k] += light.x * arriving, t.green[k] += light.y * arriving, t.blue[k] += light.z * arriving;
    t.all[k] += solidAngle * lobe(t, k, middle.x, middle.y, middle.z, alpha2);
  }
}

EnvironmentMap averagedMap(const Tree& tree, int side, double roughness, raster::Parallel& parallel) {
  EnvironmentMap map({EnvironmentProjection::Cube, side, side});
  const EnvironmentProjector& p = map.projector();
  const double alpha = roughness * roughness;
  const size_t across = size_t(side / kBlock);
  parallel.forRanges(6 * across * across, 4, [&](size_t begin, size_t end, int) {
    std::vector<const Node*> nodes;
    for (size_t b = begin; b < end; ++b) {
      const int face = int(b / (across * across)), x0 = int(b % across) * kBlock, y0 = int(b / across % across) * kBlock;
      Block block{p.directionAt({face, x0 + 0.5 * kBlock, y0 + 0.5 * kBlock}), 0, 2 * alpha};
      for (int k = 0; k < 4; ++k)
        block.radius = std::max(block.radius, glm::length(block.middle - p.directionAt({face, double(x0 + kBlock * (k & 1)), double(y0 + kBlock * (k >> 1))})));
      nodes.clear();
      for (int root = 0; root < 6; ++root) collect(tree, block, 0, root, 0, 0, nodes);
      Texels texels;
      for (int k = 0; k < kTexels; ++k) {
        const glm::vec3 r(p.directionAt({face, x0 + k % kBlock + 0.5, y0 + k / kBlock + 0.5}));
        texels.x[k] = r.x, texels.y[k] = r.y, texels.z[k] = r.z;
      }
      for (const Node* n : nodes) add(*n, float(alpha * alpha), texels);
      for (int k = 0; k < kTexels; ++k)
        map.at(face, x0 + k % kBlock, y0 + k / kBlock) = glm::vec3(texels.red[k], texels.green[k], texels.blue[k]) / texels.all[k];
    }
  });
  map.fillBorders(parallel);
  return map;
}

// Of a cube with its border.
size_t texelsOf(int side) { return 6 * size_t(side + 2) * size_t(side + 2); }

}  // namespace

post::EnvironmentChain PrefilteredEnvironment::view() const {
  post::EnvironmentChain chain;
  chain.levels = int(sides.size());
  std::copy(sides.begin(), sides.end(), chain.sizes);
  chain.texels = {texels.data(), texels.size()};
  return chain;
}

PrefilteredEnvironment mirrorOf(EnvironmentMap cube) { return {{cube.projector().width}, std::move(cube).taken()}; }

PrefilteredEnvironment prefiltered(EnvironmentMap cube, raster::Parallel& parallel) {
  const Tree tree = treeOf(cube, parallel);
  PrefilteredEnvironment out = mirrorOf(std::move(cube));
  size_t all = out.texels.size();
  for (int k = 1; k < kLevels; ++k) all += texelsOf(kSides[k]);
  out.texels.reserve(all);
  for (int k = 1; k < kLevels; ++k) {
    const EnvironmentMap level = averagedMap(tree, kSides[k], k / double(kLevels - 1), parallel);
    out.sides.push_back(kSides[k]);
    out.texels.insert(out.texels.end(), level.texels().begin(), level.texels().end());
  }
  return out;
}

}  // namespace obscura::engine
