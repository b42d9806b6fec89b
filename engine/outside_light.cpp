#include "obscura/engine/outside_light.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/engine/ambient_directions.h"
#include "obscura/engine/bounced_light.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {
namespace {

using glm::dvec3;

constexpr int kLights = 32, kMapSize = 512;
constexpr double kClosed = 1.0 / 256;  // where walls meet, the bias of shadow maps lets about a thousandth through
constexpr size_t kPoints = 16384, kPointsPerTask = 256;

// A triangle in the world, seen from its front.
struct Triangle {
  dvec3 a, b, c, normal;  // as long as the area
  double area = 0;
};

// Calls each(triangle) for all that has an area, in the scene's order; double-sided ones are two.
template <class Each>
void forTriangles(const Scene& scene, const Each& each) {
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const double side = glm::determinant(glm::dmat3(instance.worldFromObject)) < 0 ? -0.5 : 0.5;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto corner = [&](size_t k) { return dvec3(instance.worldFromObject * glm::dvec4(dvec3(mesh.positions[mesh.indices[i + k]]), 1)); };
      Triangle t{corner(0), corner(1), corner(2), {}, 0};
      t.normal = glm::cross(t.b - t.a, t.c - t.a) * side;
      t.area = std::sqrt(glm::dot(t.normal, t.normal));
      if (!(t.area > 0 && t.area < 1e200)) continue;
      each(t);
      t.normal = -t.normal;
      if (scene.materials[mesh.material].doubleSided) each(t);
    }
  }
}

struct Point {
  dvec3 place, normal;  // unit
};

// At equal steps of area, from one triangle to the next, within a triangle by the additive recurrence R2 (Roberts 2018), whose two
// constants are powers of the plastic number.
std::vector<Point> pointsOf(const Scene& scene) {
  double all = 0;
  forTriangles(scene, [&](const Triangle& t) { all += t.area; });
  const double step = all / double(kPoints);
  std::vector<Point> points;
  double next = step / 2, u = 0.5, v = 0.5;
  forTriangles(scene, [&](const Triangle& t) {
    next -= t.area;
    for (; next < 0 && points.size() < kPoints; next += step) {
      u += 0.7548776662466927, v += 0.5698402909980532;
      u -= std::floor(u), v -= std::floor(v);
      const bool beyond = u + v > 1;  // the other half of the parallelogram
      const double s = beyond ? 1 - u : u, r = beyond ? 1 - v : v;
      points.push_back({t.a + (t.b - t.a) * s + (t.c - t.a) * r, t.normal / t.area});
    }
  });
  return points;
}

struct Sums {
  double all = 0, open = 0;
  dvec3 sent{0}, passed{0};
  void add(const Sums& s, double weight) {
    all += weight * s.all, open += weight * s.open;
    sent += weight * s.sent, passed += weight * s.passed;
  }
  OutsidePart part() const {
    OutsidePart p;
    if (!(all > 0)) return p;
    if (open < all * kClosed) return {0, dvec3(0)};
    p.open = open / all;
    for (int c = 0; c < 3; ++c) p.passed[c] = sent[c] > 0 ? passed[c] / sent[c] : p.open;
    return p;
  }
};

std::vector<SceneLight> lightsAround() {
  std::vector<SceneLight> lights(kLights);
  const std::vector<dvec3> from = spreadDirections(kLights);
  for (size_t k = 0; k < lights.size(); ++k) lights[k].direction = -from[k];
  return lights;
}

}  // namespace

std::vector<OutsidePart> outsideParts(const Scene& scene, const std::vector<dvec3>& directions, const Harmonics& environment,
                                      const glm::dmat3& worldFromMap, const raster::Settings& settings) {
  const std::vector<Point> points = pointsOf(scene);
  const std::vector<SceneLight> lights = lightsAround();
  std::vector<dvec3> radiances;  // from where they are
  for (const SceneLight& l : lights) radiances.push_back(glm::max(radianceOf(environment, glm::transpose(worldFromMap) * -l.direction), 0.0));
  std::vector<Sums> atPoints(points.size());
  const raster::Parallel parallel(settings.threads);
  SceneShadows shadows(scene, settings);
  std::vector<raster::Plane<float>> maps;
  for (size_t k = 0; k < lights.size(); ++k) {
    const post::PunctualLight light = shadows.of(lights[k], kMapSize, maps);
    parallel.forRanges(points.size(), kPointsPerTask, [&](size_t first, size_t end, int) {
      for (size_t i = first; i < end; ++i) {
        const double cosine = glm::dot(points[i].normal, -lights[k].direction);
        if (!(cosine > 0)) continue;
        // Half a shadow is one: at outlines light would come through walls.
        const bool lit = double(post::arrivingAt(light, glm::vec3(points[i].place), glm::vec3(points[i].normal))) > 0.999 * cosine;
        const double arriving = lit ? cosine : 0;
        atPoints[i].add({cosine, arriving, cosine * radiances[k], arriving * radiances[k]}, 1);
      }
    });
  }
  std::vector<Sums> sums(directions.size());
  Sums everywhere;
  std::vector<double> weights(directions.size());
  for (size_t i = 0; i < points.size(); ++i) {
    double all = 0;
    for (size_t k = 0; k < directions.size(); ++k) all += weights[k] = std::max(0.0, glm::dot(points[i].normal, directions[k]));
    if (!(all > 0)) continue;
    everywhere.add(atPoints[i], 1);
    for (size_t k = 0; k < directions.size(); ++k) sums[k].add(atPoints[i], weights[k] / all);
  }
  std::vector<OutsidePart> parts;
  for (const Sums& s : sums) parts.push_back(s.all > 0 ? s.part() : everywhere.part());
  return parts;
}

}  // namespace obscura::engine
