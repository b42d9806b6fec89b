#include "obscura/apps/demo_tree.h"

#include <algorithm>

#include "obscura/apps/demo_random.h"
#include "obscura/apps/demo_shapes.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using glm::dvec3;

constexpr double kTau = 6.283185307179586;

// What differs between trunk, limbs, branches and twigs.
struct Level {
  int sides, rings;
  double wander;      // how far the axis strays per ring
  double rise;        // pull towards the light per ring
  double taper;       // radius at the end / at the start
  int children;
  double firstChild;  // where along the axis children begin
  double spread;      // tangent of the angle to the parent's axis
  double childLength, childRadius;  // relative to the parent's length, and to its radius at that place
};

constexpr Level kLevels[] = {
    {22, 18, 0.060, 0.02, 0.42, 9, 0.42, 1.05, 0.86, 0.58},
    {12, 13, 0.085, 0.05, 0.30, 6, 0.30, 0.90, 0.52, 0.62},
    {7, 8, 0.110, 0.06, 0.30, 5, 0.25, 0.95, 0.52, 0.65},
    {4, 4, 0.120, 0.04, 0.35, 0, 0, 0, 0, 0},
};
constexpr int kTwig = 3;

class Grower {
 public:
  explicit Grower(uint64_t seed) : random_(seed) {}

  void grow(int level, dvec3 start, dvec3 direction, double length, double radius) {
    const Level& shape = kLevels[level];
    std::vector<dvec3> axis{start}, directions{direction};
    for (int i = 1; i < shape.rings; ++i) {
      direction = unit(direction + shape.wander * random_.direction() + dvec3(0, shape.rise, 0));
      axis.push_back(axis.back() + direction * (length / (shape.rings - 1)));
      directions.push_back(direction);
    }
    const auto radiusAt = [&](double t) { return radius * mix(1, shape.taper, t); };
    addTube(level, axis, directions, radius, radiusAt);

    const double goldenTurn = kTau * 0.381966011250105;  // children never grow above one another
    double turn = random_.in(0, kTau);
    for (int c = 0; c < shape.children; ++c, turn += goldenTurn) {
      // The last child carries the axis on.
      const bool last = c + 1 == shape.children;
      const double t = last ? 1 : mix(shape.firstChild, 0.97, (c + random_.in(0.2, 0.8)) / (shape.children - 1));
      const double at = t * (shape.rings - 1);
      const size_t i = std::min(size_t(at), size_t(shape.rings - 2));
      const dvec3 d = directions[i + 1], side = unit(cross(d, random_.direction() * 0.1 + dvec3(0.31, 0.17, 0.93)));
      const dvec3 around = side * raster::exactCos(turn) + cross(d, side) * raster::exactSin(turn);
      const double spread = (last ? 0.25 : 1) * shape.spread * random_.in(0.8, 1.2);
      const double childLength = length * shape.childLength * random_.in(0.8, 1.15) * mix(1.1, 0.75, t);
      grow(level + 1, mix(axis[i], axis[i + 1], at - double(i)), unit(d + around * spread), childLength,
           radiusAt(t) * (last ? 0.95 : shape.childRadius));
    }
    if (level == kTwig) {
      tree.leaves.push_back({axis.back(), random_.in(0.85, 1.2)});
      tree.leaves.push_back({axis[2] + 0.1 * random_.direction(), random_.in(0.7, 1.0)});
    }
  }

  // The first and the last column of a tube are one line in space: they share the sum of their normals.
  void closeSeams() {
    setSmoothNormals(tree.bark);
    for (const Tube& tube : tubes_)
      for (uint32_t i = 0; i < tube.rings; ++i) {
        glm::vec3& a = tree.bark.normals[tube.first + i * tube.columns];
        glm::vec3& b = tree.bark.normals[tube.first + i * tube.columns + tube.columns - 1];
        a = b = glm::vec3(unit(dvec3(a) + dvec3(b)));
      }
  }

  Tree tree;

 private:
  struct Tube {
    uint32_t first, columns, rings;
  };

  template <class RadiusAt>
  void addTube(int level, const std::vector<dvec3>& axis, const std::vector<dvec3>& directions, double radius,
               RadiusAt radiusAt) {
    const Level& shape = kLevels[level];
    GlbMesh& mesh = tree.bark;
    const uint32_t first = uint32_t(mesh.positions.size()), columns = uint32_t(shape.sides) + 1;
    const double around = std::max(1.0, std::floor(radius * 7 + 0.5));  // whole repeats of the texture
    dvec3 side = unit(cross(directions[0], dvec3(0.31, 0.17, 0.93)));
    double along = 0;
    for (size_t i = 0; i < axis.size(); ++i) {
      if (i > 0) along += std::sqrt(dot(axis[i] - axis[i - 1], axis[i] - axis[i - 1]));
      // The frame is carried along the axis, so that the bark does not twist.
      side = unit(side - directions[i] * dot(side, directions[i]));
      const dvec3 other = cross(directions[i], side);
      const double t = double(i) / double(axis.size() - 1);
      for (uint32_t c = 0; c < columns; ++c) {
        const double angle = kTau * (c % uint32_t(shape.sides)) / shape.sides;
        double r = radiusAt(t);
        const dvec3 ring = side * raster::exactCos(angle) + other * raster::exactSin(angle);
        if (level == 0) {  // roots: lobes that flare out towards the foot
          const double foot = 1 - smoothstep(0, 0.32, t);
          const double lobes = raster::exactCos(5 * angle) + 0.5 * raster::exactCos(3 * angle);
          r *= 1 + foot * foot * (0.75 + 0.42 * lobes);
        }
        const dvec3 p = axis[i] + ring * r;
        r *= 1 + (level < 2 ? 0.10 : 0.05) * fractalNoise(p * (level == 0 ? 3.5 : 6.0), 2, 101);
        mesh.positions.emplace_back(axis[i] + ring * r);
        mesh.uvs.emplace_back(float(around * c / shape.sides), float(along * 1.1));
      }
    }
    for (uint32_t i = 0; i + 1 < uint32_t(axis.size()); ++i)
      for (uint32_t c = 0; c + 1 < columns; ++c) {
        const uint32_t a = first + i * columns + c, b = a + columns;
        mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    tubes_.push_back({first, columns, uint32_t(axis.size())});
  }

  Random random_;
  std::vector<Tube> tubes_;
};

}  // namespace

Tree makeTree(uint64_t seed) {
  Grower grower(seed);
  grower.tree.bark.name = "bark";
  grower.grow(0, {0, 0, 0}, unit({0.05, 1, 0.02}), 3.3, 0.34);
  grower.closeSeams();
  return std::move(grower.tree);
}

}  // namespace obscura::apps
