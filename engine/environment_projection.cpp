#include "obscura/engine/environment_projection.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/raster/exact_math.h"

namespace obscura::engine {
namespace {

constexpr double kPi = 3.141592653589793;
using Projection = EnvironmentProjection;

// Of the cube's faces: what is in the middle, to the right of it and above it, seen from inside: right = forward x up.
struct Face {
  glm::dvec3 forward, right, up;
};
const Face kFaces[6] = {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                        {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                        {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};
const glm::ivec2 kCross[6] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {3, 1}, {1, 1}};  // in panels

int faceOf(const glm::dvec3& d) {
  const double x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  if (x >= y && x >= z) return d.x < 0 ? 1 : 0;
  if (y >= z) return d.y < 0 ? 3 : 2;
  return d.z < 0 ? 5 : 4;
}

// Solid angle over a rectangle from the middle of a plane to (s, t), by the density of the plane.
double ofCube(double s, double t) { return raster::exactAtan2(s * t, std::sqrt(s * s + t * t + 1)); }
// The integral of 4 / (1 + s^2 + t^2)^2, which is the density of the (stereographic) paraboloid.
double ofParaboloid(double s, double t) {
  const double a = std::sqrt(1 + s * s), b = std::sqrt(1 + t * t);
  return 2 * (s / a * raster::exactAtan2(t, a) + t / b * raster::exactAtan2(s, b));
}

template <class F>
double overRectangle(const F& f, double s0, double s1, double t0, double t1) {
  return (f(s1, t1) - f(s0, t1)) - (f(s1, t0) - f(s0, t0));
}

}  // namespace

int EnvironmentProjector::panels() const { return projection == Projection::Cube ? 6 : projection == Projection::Paraboloid ? 2 : 1; }

PanelPoint EnvironmentProjector::pointOf(const glm::dvec3& direction) const {
  const glm::dvec3 d = glm::normalize(direction);
  int panel = 0;
  double s = 0, t = 0;  // [-1, 1], right and up
  switch (projection) {
    case Projection::Latlong:
      s = raster::exactAtan2(d.x, -d.z) / kPi;
      t = raster::exactAtan2(d.y, std::sqrt(d.x * d.x + d.z * d.z)) / (0.5 * kPi);
      break;
    case Projection::Sphere: {
      const double m = std::sqrt(d.x * d.x + d.y * d.y + (d.z + 1) * (d.z + 1));
      s = m > 0 ? d.x / m : 1;
      t = m > 0 ? d.y / m : 0;
      break;
    }
    case Projection::Cube: {
      panel = faceOf(d);
      const Face& f = kFaces[panel];
      const double m = glm::dot(d, f.forward);
      s = glm::dot(d, f.right) / m;
      t = glm::dot(d, f.up) / m;
      break;
    }
    case Projection::Paraboloid:
      panel = d.z > 0 ? 1 : 0;
      s = d.x / (1 + std::fabs(d.z)) * (panel ? -1 : 1);
      t = d.y / (1 + std::fabs(d.z));
      break;
  }
  const auto inside = [](double v, int most) { return std::min(std::max(v, 0.0), double(most)); };
  return {panel, inside((0.5 + 0.5 * s) * width, width), inside((0.5 - 0.5 * t) * height, height)};
}

glm::dvec3 EnvironmentProjector::directionAt(const PanelPoint& p) const {
  const double s = 2 * p.x / width - 1, t = 1 - 2 * p.y / height;
  switch (projection) {
    case Projection::Latlong: {
      const double longitude = s * kPi, latitude = t * (0.5 * kPi), c = raster::exactCos(latitude);
      return {raster::exactSin(longitude) * c, raster::exactSin(latitude), -raster::exactCos(longitude) * c};
    }
    case Projection::Sphere: {
      const double r2 = s * s + t * t;
      if (r2 >= 1) return {0, 0, -1};
      const double m = 2 * std::sqrt(1 - r2);  // from d.z = 1 - 2 r^2, twice d + z's length over 2
      return {s * m, t * m, 1 - 2 * r2};
    }
    case Projection::Cube: {
      const Face& f = kFaces[p.panel];
      return glm::normalize(f.forward + f.right * s + f.up * t);
    }
    case Projection::Paraboloid: {
      const double r2 = s * s + t * t, side = p.panel ? -1 : 1;
      return glm::dvec3(2 * s * side, 2 * t, (r2 - 1) * side) / (1 + r2);
    }
  }
  return {};
}

TexelDirections::TexelDirections(const EnvironmentProjector& projector) : projector_(projector) {
  if (projector.projection != Projection::Latlong) return;
  for (int x = 0; x < projector.width; ++x) {
    const double longitude = (2 * (x + 0.5) / projector.width - 1) * kPi;
    longitudes_.push_back({raster::exactSin(longitude), raster::exactCos(longitude)});
  }
  for (int y = 0; y < projector.height; ++y) {
    const double latitude = (1 - 2 * (y + 0.5) / projector.height) * (0.5 * kPi);
    latitudes_.push_back({raster::exactSin(latitude), raster::exactCos(latitude)});
  }
}

glm::dvec3 TexelDirections::at(int panel, int x, int y) const {
  if (longitudes_.empty()) return projector_.directionAt({panel, x + 0.5, y + 0.5});
  const Angle &longitude = longitudes_[size_t(x)], &latitude = latitudes_[size_t(y)];
  return {longitude.sine * latitude.cosine, latitude.sine, -longitude.cosine * latitude.cosine};
}

bool EnvironmentProjector::shows(int x, int y) const {
  if (projection == Projection::Latlong || projection == Projection::Cube) return x >= 0 && x < width && y >= 0 && y < height;
  const double s = (2.0 * x + 1) / width - 1, t = (2.0 * y + 1) / height - 1;
  return s * s + t * t < 1;
}

double EnvironmentProjector::solidAngle(int x, int y) const {
  const double s0 = 2.0 * x / width - 1, s1 = 2.0 * (x + 1) / width - 1;
  const double t0 = 2.0 * y / height - 1, t1 = 2.0 * (y + 1) / height - 1;
  if (projection == Projection::Latlong)
    return 2 * kPi / width * (raster::exactSin(0.5 * kPi * t1) - raster::exactSin(0.5 * kPi * t0));
  if (projection == Projection::Cube) return overRectangle(ofCube, s0, s1, t0, t1);
  const bool sphere = projection == Projection::Sphere;
  const auto inside = [](double s, double t) { return s * s + t * t < 1; };
  if (inside(s0, t0) && inside(s1, t0) && inside(s0, t1) && inside(s1, t1))
    return sphere ? 4 * (s1 - s0) * (t1 - t0) : overRectangle(ofParaboloid, s0, s1, t0, t1);
  constexpr int kParts = 16;  // a side
  double sum = 0;
  for (int j = 0; j < kParts; ++j)
    for (int i = 0; i < kParts; ++i) {
      const double s = s0 + (s1 - s0) * (i + 0.5) / kParts, t = t0 + (t1 - t0) * (j + 0.5) / kParts, r = 1 + s * s + t * t;
      if (inside(s, t)) sum += sphere ? 4 : 4 / (r * r);
    }
  return sum * (s1 - s0) * (t1 - t0) / (kParts * kParts);
}

int EnvironmentProjector::imageWidth() const { return width * (projection == Projection::Cube ? 4 : panels()); }
int EnvironmentProjector::imageHeight() const { return height * (projection == Projection::Cube ? 3 : 1); }

glm::ivec2 EnvironmentProjector::originOf(int panel) const {
  return projection == Projection::Cube ? kCross[panel] * glm::ivec2(width, height) : glm::ivec2(panel * width, 0);
}

std::optional<EnvironmentProjector> projectorOfImage(EnvironmentProjection projection, int imageWidth, int imageHeight) {
  EnvironmentProjector p{projection, imageWidth, imageHeight};
  if (projection == Projection::Cube) p.width = imageWidth / 4, p.height = imageHeight / 3;
  if (projection == Projection::Paraboloid) p.width = imageWidth / 2;
  const bool shape = p.width == (projection == Projection::Latlong ? 2 * p.height : p.height);
  if (!shape || p.height < 1 || p.imageWidth() != imageWidth || p.imageHeight() != imageHeight) return std::nullopt;
  return p;
}

EnvironmentProjector projectorOfTexels(EnvironmentProjection projection, double texels) {
  const double ofOne = usedTexels({projection, projection == Projection::Latlong ? 2 : 1, 1});
  const int side = std::max(1, int(std::ceil(std::sqrt(texels / ofOne))));
  return {projection, projection == Projection::Latlong ? 2 * side : side, side};
}

double usedTexels(const EnvironmentProjector& p) {
  const double circle = p.projection == Projection::Sphere || p.projection == Projection::Paraboloid ? kPi / 4 : 1;
  return circle * p.panels() * double(p.width) * double(p.height);
}

}  // namespace obscura::engine
