#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/apps/sobol.h"
#include "obscura/apps/truth.h"

namespace obscura::apps {
namespace {

constexpr double kPi = 3.14159265358979323846;

double largest(const glm::dvec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

glm::dvec3 movedOut(const glm::dvec3& p, const glm::dvec3 (&corner)[3], const glm::dvec3& outside) {
  const double offset = kTruthOffset * std::max({largest(p), largest(corner[0]), largest(corner[1]), largest(corner[2])});
  const glm::dvec3 inward = (corner[0] + corner[1] + corner[2]) / 3.0 - p;
  const double length = glm::length(inward);
  return p + outside * offset + (length > offset ? inward * (offset / length) : glm::dvec3(0));
}

}  // namespace

TruthStarts::TruthStarts(const engine::Scene& scene, const RaySurface& surface, const engine::FrameSettings& settings,
                         const engine::Frame& frame)
    : surface_(surface), frame_(frame), camera_(settings.camera) {
  uint32_t first = 0;
  for (const engine::Instance& i : scene.instances) {
    firstTriangle_.push_back(first);
    first += uint32_t(scene.meshes[i.mesh].indices.size() / 3);
  }
}

uint32_t TruthStarts::seed(int x, int y) const { return hashed(uint32_t(x + frame_.x), uint32_t(y + frame_.y)); }

TruthStart TruthStarts::at(int x, int y) const {
  const raster::GBuffer& g = frame_.g;
  const uint32_t instance = g.instance.at(x, y), triangle = g.triangle.at(x, y) - firstTriangle_[instance];
  glm::dvec3 corner[3];
  surface_.corners(instance, triangle, corner);

  // Weights as in raster/surface.h: where the corners lie as seen from the pixel's centre.
  const bool perspective = camera_.projection == raster::Projection::Perspective;
  const double cx = (2.0 * (x + frame_.x) + 1) / frame_.imageWidth - 1 - camera_.xShift;
  const double cy = 1 - (2.0 * (y + frame_.y) + 1) / frame_.imageHeight - camera_.yShift;
  double hx[3], hy[3], weight[3], sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double depth = perspective ? -corner[i].z : 1;
    hx[i] = corner[i].x * camera_.xScale - depth * cx;
    hy[i] = corner[i].y * camera_.yScale - depth * cy;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum += weight[i] = hx[j] * hy[k] - hy[j] * hx[k];
  }
  weight[1] = sum != 0 ? std::clamp(weight[1] / sum, 0.0, 1.0) : 1.0 / 3;
  weight[2] = sum != 0 ? std::clamp(weight[2] / sum, 0.0, 1 - weight[1]) : 1.0 / 3;

  TruthStart start;
  const glm::dvec3 p = corner[0] + (corner[1] - corner[0]) * weight[1] + (corner[2] - corner[0]) * weight[2];
  start.outside = surface_.outside(instance, triangle);
  if (glm::dot(start.outside, perspective ? -p : glm::dvec3(0, 0, 1)) < 0) start.outside = -start.outside;
  start.position = movedOut(p, corner, start.outside);
  for (int c = 0; c < 3; ++c) {
    start.normal[c] = g.normal[c].at(x, y);
    start.albedo[c] = g.albedo[c].at(x, y);
  }
  return start;
}

TruthStart startAtHit(const RaySurface& surface, const TrianglePoint& hit, const glm::dvec3& direction) {
  TruthStart start;
  glm::dvec3 corner[3];
  surface.corners(hit.instance, hit.triangle, corner);
  const glm::dvec3 p = corner[0] + (corner[1] - corner[0]) * double(hit.u) + (corner[2] - corner[0]) * double(hit.v);
  start.outside = surface.outside(hit.instance, hit.triangle);
  start.normal = surface.normal(hit);
  if (glm::dot(start.outside, direction) > 0) start.outside = -start.outside, start.normal = -start.normal;
  start.position = movedOut(p, corner, start.outside);
  start.albedo = surface.albedo(hit);
  return start;
}

// Azimuth and squared sine, as the sample sets of the estimators have it; the frame about n after Duff et al. 2017. Shirley
// and Chiu's map of the square has the same error for O, and twice that for the tangent sphere.
namespace {

// z of it along n.
glm::dvec3 directionAbout(const glm::dvec3& n, double phi, double z, double across) {
  const double x = across * std::cos(phi), y = across * std::sin(phi);
  const double sign = std::copysign(1.0, n.z), f = -1 / (sign + n.z), g = n.x * n.y * f;
  return glm::dvec3(1 + sign * n.x * n.x * f, sign * g, -sign * n.x) * x +
         glm::dvec3(g, sign + n.y * n.y * f, -n.y) * y + n * z;
}

}  // namespace

glm::dvec3 cosineDirection(const glm::dvec3& n, const glm::dvec2& xi) {
  return directionAbout(n, 2 * kPi * xi.x, std::sqrt(1 - xi.y), std::sqrt(xi.y));
}

glm::dvec3 evenDirection(const glm::dvec3& n, const glm::dvec2& xi) {
  const double z = 1 - xi.y;
  return directionAbout(n, 2 * kPi * xi.x, z, std::sqrt(1 - z * z));
}

}  // namespace obscura::apps
