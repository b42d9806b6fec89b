// Scalar twin of implicit.cpp and implicit-inl.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/raster/implicit.h"
#include "obscura/raster/reference.h"

namespace obscura::raster::ref {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class T>
using Vec3 = glm::tvec3<T>;

template <class T>
T length(const Vec3<T>& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

template <class T>
T boxDistance(const Vec3<T>& half, const Vec3<T>& p) {
  Vec3<T> q;
  for (int c = 0; c < 3; ++c) q[c] = std::fabs(p[c]) - half[c];
  const T inside = std::min(std::max({q.x, q.y, q.z}), T(0));
  for (int c = 0; c < 3; ++c) q[c] = q[c] > 0 ? q[c] : 0;
  return length(q) + inside;
}

// sin(2 pi t) by the Taylor series over a quarter turn to either side.
template <class T>
T sineOfTurns(T t) {
  T u = t - std::floor(t + T(0.5));
  if (std::fabs(u) > T(0.25)) u = (std::signbit(u) ? T(-0.5) : T(0.5)) - u;
  const T x = u * T(6.283185307179586), z = x * x;
  T p = T(1 / 355687428096000.0);  // 1 / 17!
  p = p * z + T(-1 / 1307674368000.0);
  p = p * z + T(1 / 6227020800.0);
  p = p * z + T(-1 / 39916800.0);
  p = p * z + T(1 / 362880.0);
  p = p * z + T(-1 / 5040.0);
  p = p * z + T(1 / 120.0);
  p = p * z + T(-1 / 6.0);
  return x + x * z * p;
}

template <class T>
T valueOf(const ImplicitDraw& draw, const Vec3<T>& p) {
  const ImplicitSurface& s = *draw.surface;
  const T radius = T(s.radius);
  switch (s.shape) {
    case ImplicitShape::Sphere: return length(p) - radius;
    case ImplicitShape::Box: return boxDistance(Vec3<T>(s.halfSize), p);
    case ImplicitShape::Torus: {
      const T ring = std::sqrt(p.x * p.x + p.z * p.z) - radius;
      return std::sqrt(ring * ring + p.y * p.y) - T(s.tube);
    }
    case ImplicitShape::Metaballs: {
      T sum = 0;
      for (const ImplicitBall& b : s.balls) {
        const Vec3<T> q = p - Vec3<T>(b.center);
        const double reach = 2 * b.radius;
        const T field = 1 - (q.x * q.x + q.y * q.y + q.z * q.z) * T(1 / (reach * reach));
        if (field > 0) sum += field * field * field;
      }
      return (T(0.421875) - sum) * T(draw.perSteepness);
    }
    case ImplicitShape::Gyroid: {
      const T x = p.x * T(draw.perPeriod), y = p.y * T(draw.perPeriod), z = p.z * T(draw.perPeriod), quarter = T(0.25);
      const T sum = sineOfTurns(x) * sineOfTurns(y + quarter) + sineOfTurns(y) * sineOfTurns(z + quarter) +
                    sineOfTurns(z) * sineOfTurns(x + quarter);
      const T wall = std::fabs(sum) * T(draw.perSlope) - T(0.5 * s.thickness);
      return std::max(wall, s.radius > 0 ? length(p) - radius : boxDistance(Vec3<T>(s.halfSize), p));
    }
    case ImplicitShape::Function: break;
  }
  const T f = T(s.function(glm::dvec3(p)) * draw.perSteepness), ball = length(p) - radius;
  return ball > f ? ball : f;
}

struct Ray {
  glm::dvec3 origin, direction;
};

Ray rayOf(const View& view, const ImplicitDraw& s, int x, int y) {
  const double xView = (view.xCenterSub(x) - double(view.xShiftSub)) / view.xScaleSub;
  const double yView = (view.yCenterSub(y) - double(view.yShiftSub)) / view.yScaleSub;
  Ray ray;
  for (int r = 0; r < 3; ++r) {
    const double* m = s.objectFromView[r];
    const double across = m[0] * xView + m[1] * yView;
    ray.origin[r] = (view.perspective ? 0 : across) + m[3];
    ray.direction[r] = (view.perspective ? across : 0) - m[2];
  }
  return ray;
}

double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Crossing {
  bool found = false, enters = false;
  double z = 0;
};

Crossing trace(const View& view, const ImplicitDraw& s, const Ray& ray, double from, bool entries, bool exits) {
  const glm::dvec3 o = ray.origin - s.bound.center;
  const double a = dot(ray.direction, ray.direction), b = dot(o, ray.direction);
  const double square = b * b - a * (dot(o, o) - s.bound.radius * s.bound.radius);
  if (!(square > 0)) return {};
  const double begin = std::max((0 - b - std::sqrt(square)) / a, std::max(from, double(view.zNear)));
  const double end = std::min((0 - b + std::sqrt(square)) / a, double(view.zFar));
  const double perLength = 1 / std::sqrt(a), least = (end - begin) * (1.0 / 1024);
  const auto f = [&](double z) { return valueOf(s, ray.origin + ray.direction * z); };
  if (!(begin < end)) return {};
  double z = begin, free = f(z);
  for (int step = 0; step < 2048 && z < end; ++step) {
    const double next = z + std::max(least, std::fabs(free) * perLength), there = f(next);
    const bool enters = !(free < 0) && there < 0, leaves = free < 0 && !(there < 0);
    if ((entries && enters) || (exits && leaves)) {
      double low = z, high = next;
      for (int k = 0; k < 30; ++k) {
        const double middle = (low + high) * 0.5;
        ((f(middle) < 0) == enters ? high : low) = middle;
      }
      return {high <= end, enters, high};
    }
    z = next;
    free = there;
  }
  return {};
}

glm::vec3 normalOf(const ImplicitDraw& s, const glm::dvec3& p) {
  const double h = s.bound.radius / 16384;
  glm::dvec3 g, n;
  for (int c = 0; c < 3; ++c) {
    glm::dvec3 after = p, before = p;
    after[c] += h;
    before[c] -= h;
    g[c] = valueOf(s, after) - valueOf(s, before);
  }
  for (int c = 0; c < 3; ++c) n[c] = s.objectFromView[0][c] * g.x + s.objectFromView[1][c] * g.y + s.objectFromView[2][c] * g.z;
  const double square = dot(n, n);
  if (!(square > 1e-290 && square < 1e290)) return {0, 0, 1};
  return glm::vec3(n / std::sqrt(square));
}

float keyOf(const View& view, double z) { return float(view.perspective ? 1 / z : 0 - z); }

}  // namespace

double implicitValue(const ImplicitDraw& surface, const glm::dvec3& p) { return valueOf(surface, p); }
float implicitValue(const ImplicitDraw& surface, const glm::vec3& p) { return valueOf(surface, p); }

void drawImplicits(const View& view, Span<const ImplicitDraw> surfaces, Visibility& seen, GBuffer& out) {
  for (const ImplicitDraw& s : surfaces)
    for (int y = 0; y < seen.height; ++y)
      for (int x = 0; x < seen.width; ++x) {
        const Ray ray = rayOf(view, s, x, y);
        const Crossing c = trace(view, s, ray, view.zNear, true, s.doubleSided);
        const float key = c.found ? keyOf(view, c.z) : -kInfinity;
        if (!(key > seen.key.at(x, y))) continue;
        seen.key.at(x, y) = key;
        seen.triangle.at(x, y) = s.id;
        const glm::vec3 outwards = normalOf(s, ray.origin + ray.direction * c.z);
        resolveImplicit(view, s, c.enters ? outwards : -outwards, key, x, y, out);
      }
}

void drawImplicitsBehind(const View& view, Span<const ImplicitDraw> surfaces, bool back, const LimitOf& limitOf, Plane<float>& best) {
  for (const ImplicitDraw& s : surfaces)
    for (int y = 0; y < best.height() && !(back && s.doubleSided); ++y)
      for (int x = 0; x < best.width(); ++x) {
        const double limit = limitOf(x, y);
        if (limit == -kInfinity) continue;
        const double from = limit == kInfinity ? view.zNear : view.perspective ? 1 / limit : 0 - limit;
        const Crossing c = trace(view, s, rayOf(view, s, x, y), from, !back, back || s.doubleSided);
        const float key = keyOf(view, c.z);
        if (c.found && key > best.at(x, y) && key <= limit) best.at(x, y) = key;
      }
}

}  // namespace obscura::raster::ref
