#include "obscura/apps/environment_sampler.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

namespace obscura::apps {
namespace {

constexpr double kPi = 3.14159265358979323846;

// The cell that holds xi of the whole, and where in it xi lies, [0, 1).
size_t cellOf(const double* upTo, size_t cells, double& xi) {
  const double at = xi * upTo[cells];
  const size_t cell = std::min(size_t(std::upper_bound(upTo + 1, upTo + cells, at) - (upTo + 1)), cells - 1);
  const double share = upTo[cell + 1] - upTo[cell];
  xi = share > 0 ? std::clamp((at - upTo[cell]) / share, 0.0, 1 - 0x1p-53) : 0.5;
  return cell;
}

// -1 to 1, of the density 1 - |x|: a texel's share of what is interpolated between it and its neighbours.
double tent(double xi) { return xi < 0.5 ? std::sqrt(2 * xi) - 1 : 1 - std::sqrt(2 - 2 * xi); }

}  // namespace

EnvironmentSampler::EnvironmentSampler(const engine::EnvironmentMap& map, const glm::dmat3& viewFromMap, double intensity,
                                       raster::Parallel& parallel)
    : map_(map), viewFromMap_(viewFromMap), mapFromView_(glm::transpose(viewFromMap)), intensity_(intensity) {
  constexpr auto kLatlong = engine::EnvironmentProjection::Latlong;
  const bool isLatlong = map.projector().projection == kLatlong;
  latlong_ = isLatlong ? map.projector() : engine::projectorOfTexels(kLatlong, engine::usedTexels(map.projector()));
  const engine::EnvironmentMap other = isLatlong ? engine::EnvironmentMap() : engine::convertEnvironment(map, latlong_, parallel);
  const engine::EnvironmentMap& texels = isLatlong ? map : other;

  const size_t width = size_t(latlong_.width), height = size_t(latlong_.height);
  upTo_.resize(height * (width + 1));
  rowsUpTo_.resize(height + 1);
  for (const bool even : {false, true}) {
    for (size_t y = 0; y < height; ++y) {
      const double solidAngle = latlong_.solidAngle(0, int(y));
      double* upTo = &upTo_[y * (width + 1)];
      for (size_t x = 0; x < width; ++x) {
        const glm::dvec3 l = texels.at(0, int(x), int(y));
        upTo[x + 1] = upTo[x] + (even ? 1 : l.x + l.y + l.z) * solidAngle;
      }
      rowsUpTo_[y + 1] = rowsUpTo_[y] + upTo[width];
    }
    if (rowsUpTo_[height] > 0) break;
  }
}

double EnvironmentSampler::weight(int x, int y) const {
  x = (x + latlong_.width) % latlong_.width, y = std::clamp(y, 0, latlong_.height - 1);
  const double* upTo = &upTo_[size_t(y) * size_t(latlong_.width + 1) + size_t(x)];
  return upTo[1] - upTo[0];
}

glm::dvec3 EnvironmentSampler::direction(const glm::dvec2& xi) const {
  double u = xi.x, v = xi.y;
  const size_t row = cellOf(rowsUpTo_.data(), size_t(latlong_.height), v);
  const size_t column = cellOf(&upTo_[row * size_t(latlong_.width + 1)], size_t(latlong_.width), u);
  double x = double(column) + 0.5 + tent(u), y = std::fabs(double(row) + 0.5 + tent(v));  // no further than the pole
  y = std::min(y, 2 * latlong_.height - y);
  x += x < 0 ? latlong_.width : x > latlong_.width ? -latlong_.width : 0;
  return viewFromMap_ * latlong_.directionAt({0, x, y});
}

double EnvironmentSampler::density(const glm::dvec3& direction) const {
  const glm::dvec3 d = mapFromView_ * direction;
  const engine::PanelPoint p = latlong_.pointOf(d);
  const int x = int(std::floor(p.x - 0.5)), y = int(std::floor(p.y - 0.5));
  const double u = p.x - 0.5 - x, v = p.y - 0.5 - y;
  const double here = (weight(x, y) * (1 - u) + weight(x + 1, y) * u) * (1 - v) + (weight(x, y + 1) * (1 - u) + weight(x + 1, y + 1) * u) * v;
  const double texel = 2 * kPi / latlong_.width * kPi / latlong_.height * std::sqrt(std::max(1 - d.y * d.y, 1e-20));  // steradians
  return here / rowsUpTo_[size_t(latlong_.height)] / texel;
}

}  // namespace obscura::apps
