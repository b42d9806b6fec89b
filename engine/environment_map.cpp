#include "obscura/engine/environment_map.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace obscura::engine {
namespace {

using Projection = EnvironmentProjection;
constexpr size_t kRowsPerTask = 8;

// From the middle of a panel, 1 at its circle.
double radiusOf(const EnvironmentProjector& p, const PanelPoint& at) {
  const double s = 2 * at.x / p.width - 1, t = 2 * at.y / p.height - 1;
  return std::sqrt(s * s + t * t);
}

}  // namespace

EnvironmentMap::EnvironmentMap(const EnvironmentProjector& projector)
    : projector_(projector), texels_(size_t(projector.panels()) * size_t(projector.width + 2) * size_t(projector.height + 2)) {}

glm::dvec3 EnvironmentMap::bilinear(const PanelPoint& p, bool shownOnly) const {
  const double x = p.x + 0.5, y = p.y + 0.5;  // from the centre of the border's first texel
  const int i = std::min(int(x), projector_.width), j = std::min(int(y), projector_.height);
  const double u = x - i, v = y - j;
  if (!shownOnly) {
    const glm::vec3* row = &texels_[index(p.panel, i - 1, j - 1)];
    const glm::vec3* next = row + projector_.width + 2;
    return (glm::dvec3(row[0]) * (1 - u) + glm::dvec3(row[1]) * u) * (1 - v) + (glm::dvec3(next[0]) * (1 - u) + glm::dvec3(next[1]) * u) * v;
  }
  glm::dvec3 sum(0);
  double weights = 0;
  for (int k = 0; k < 4; ++k) {
    const int cx = i - 1 + k % 2, cy = j - 1 + k / 2;
    if (!projector_.shows(cx, cy)) continue;
    const double weight = (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v);
    sum += weight * glm::dvec3(at(p.panel, cx, cy));
    weights += weight;
  }
  if (weights > 0) return sum / weights;
  const double inwards = 1 - 1.0 / projector_.width;  // no neighbour is shown: from nearer the middle
  return bilinear({p.panel, (p.x - 0.5 * projector_.width) * inwards + 0.5 * projector_.width,
                   (p.y - 0.5 * projector_.height) * inwards + 0.5 * projector_.height}, true);
}

glm::dvec3 EnvironmentMap::ringOfSphere() const {
  glm::dvec3 sum(0);
  int count = 0;
  for (int y = 0; y < projector_.height; ++y)
    for (int x = 0; x < projector_.width; ++x)
      if (projector_.shows(x, y) && radiusOf(projector_, {0, x + 0.5, y + 0.5}) >= 1 - 2.0 / projector_.width)
        sum += glm::dvec3(at(0, x, y)), ++count;
  return count ? sum / double(count) : glm::dvec3(0);
}

void EnvironmentMap::fillPoles() {
  const int w = projector_.width, h = projector_.height;
  for (int row : {0, h - 1}) {
    glm::dvec3 mean(0);
    for (int x = 0; x < w; ++x) mean += glm::dvec3(at(0, x, row));
    mean /= double(w);
    for (int x = -1; x <= w; ++x) at(0, x, row ? h : -1) = glm::vec3(2.0 * mean - glm::dvec3(at(0, x, row)));
  }
}

void EnvironmentMap::fillCubeCorners() {
  const int n = projector_.width;
  for (int panel = 0; panel < 6; ++panel)
    for (int k = 0; k < 4; ++k) {
      const int x = k % 2 ? n : -1, y = k / 2 ? n : -1, besideX = k % 2 ? n - 1 : 0, besideY = k / 2 ? n - 1 : 0;
      at(panel, x, y) = (at(panel, besideX, y) + at(panel, x, besideY) + at(panel, besideX, besideY)) / 3.0f;
    }
}

void EnvironmentMap::fillBorders(raster::Parallel& parallel) {
  const EnvironmentProjector& p = projector_;
  const bool sphere = p.projection == Projection::Sphere, paraboloid = p.projection == Projection::Paraboloid;
  std::vector<PanelPoint> hidden;  // centres of the texels that are not shown
  for (int panel = 0; panel < p.panels(); ++panel)
    for (int y = -1; y <= p.height; ++y)
      for (int x = -1; x <= p.width; ++x)
        if (!p.shows(x, y)) hidden.push_back({panel, x + 0.5, y + 0.5});
  const glm::vec3 ring(sphere ? ringOfSphere() : glm::dvec3(0));
  // Along the rim of a paraboloid hidden texels of one half stand between those of the other: from a first guess they
  // settle within a dozen rounds. Each round reads what the last one left, whatever the threads.
  for (int round = 0; round < (paraboloid ? 12 : 1); ++round) {
    std::vector<glm::vec3> values(hidden.size());
    parallel.forRanges(hidden.size(), 1024, [&](size_t begin, size_t end, int) {
      for (size_t k = begin; k < end; ++k) {
        const PanelPoint from = p.pointOf(p.directionAt(hidden[k]));
        values[k] = sphere       ? ring
                    : paraboloid ? glm::vec3(bilinear(from, round == 0))
                                 : at(from.panel, std::min(int(from.x), p.width - 1), std::min(int(from.y), p.height - 1));
      }
    });
    for (size_t k = 0; k < hidden.size(); ++k) at(hidden[k].panel, int(hidden[k].x + 1) - 1, int(hidden[k].y + 1) - 1) = values[k];
    if (round == 0) hidden.erase(std::remove_if(hidden.begin(), hidden.end(), [&](const PanelPoint& h) { return radiusOf(p, h) > 1 + 4.0 / p.width; }), hidden.end());
  }
  if (p.projection == Projection::Latlong) fillPoles();
  if (p.projection == Projection::Cube) fillCubeCorners();
}

glm::dvec3 EnvironmentMap::lookUp(const glm::dvec3& direction) const {
  const PanelPoint p = projector_.pointOf(direction);
  const glm::dvec3 value = glm::max(bilinear(p, false), 0.0);  // beside a pole a rounding may be below
  if (projector_.projection != Projection::Sphere) return value;
  // The rim is a single direction: what surrounds it tends to one value over the last texel.
  const double part = 0.5 * projector_.width * (radiusOf(projector_, p) - 1) + 1;
  return part > 0 ? value * (1 - std::min(part, 1.0)) + glm::dvec3(at(0, -1, -1)) * std::min(part, 1.0) : value;
}

EnvironmentMap convertEnvironment(const EnvironmentMap& from, const EnvironmentProjector& to, raster::Parallel& parallel) {
  EnvironmentMap out(to);
  const double finer = std::sqrt(usedTexels(from.projector()) / usedTexels(to));
  const int points = std::min(16, std::max(1, int(std::ceil(finer - 0.25))));  // a side
  parallel.forRanges(size_t(to.panels()) * size_t(to.height), kRowsPerTask, [&](size_t begin, size_t end, int) {
    for (size_t row = begin; row < end; ++row) {
      const int panel = int(row / size_t(to.height)), y = int(row % size_t(to.height));
      for (int x = 0; x < to.width; ++x) {
        if (!to.shows(x, y)) continue;
        glm::dvec3 sum(0);
        for (int k = 0; k < points * points; ++k)
          sum += from.lookUp(to.directionAt({panel, x + (k % points + 0.5) / points, y + (k / points + 0.5) / points}));
        out.at(panel, x, y) = glm::vec3(sum / double(points * points));
      }
    }
  });
  out.fillBorders(parallel);
  return out;
}

EnvironmentDifference compareEnvironments(const EnvironmentMap& a, const EnvironmentMap& b, raster::Parallel& parallel) {
  struct Sums {
    double squares = 0, own = 0, weights = 0, clamped = 0, largest = 0;
  };
  const EnvironmentProjector& p = a.projector();
  std::vector<Sums> rows(size_t(p.panels()) * size_t(p.height));
  parallel.forRanges(rows.size(), kRowsPerTask, [&](size_t begin, size_t end, int) {
    for (size_t row = begin; row < end; ++row) {
      const int panel = int(row / size_t(p.height)), y = int(row % size_t(p.height));
      double weight = 0;
      for (int x = 0; x < p.width; ++x) {
        if (!p.shows(x, y)) continue;
        if (x == 0 || p.projection != Projection::Latlong) weight = p.solidAngle(x, y);  // the same all along a row
        const glm::dvec3 value(a.at(panel, x, y)), other = b.lookUp(p.directionAt({panel, x + 0.5, y + 0.5}));
        for (int c = 0; c < 3; ++c) {
          const double d = std::fabs(value[c] - other[c]);
          const double shown = std::min(value[c], 1.0) - std::min(other[c], 1.0);
          rows[row].squares += weight * d * d;
          rows[row].clamped += weight * shown * shown;
          rows[row].own += weight * value[c] * value[c];
          rows[row].weights += weight;
          rows[row].largest = std::max(rows[row].largest, d);
        }
      }
    }
  });
  Sums all;  // in the order of the rows, whatever the threads
  for (const Sums& r : rows) {
    all.squares += r.squares, all.own += r.own, all.weights += r.weights, all.clamped += r.clamped;
    all.largest = std::max(all.largest, r.largest);
  }
  return {std::sqrt(all.squares / all.weights), all.own > 0 ? std::sqrt(all.squares / all.own) : 0, all.largest,
          std::sqrt(all.clamped / all.weights)};
}

}  // namespace obscura::engine
