// Scalar twin of direct_light.cpp: every light at every pixel.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/post/brdf_ref.h"
#include "obscura/post/direct_light.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

float dot(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

glm::vec3 times(const glm::mat3& m, const glm::vec3& v) {
  glm::vec3 r;
  for (int k = 0; k < 3; ++k) r[k] = m[0][k] * v.x + m[1][k] * v.y + m[2][k] * v.z;
  return r;
}

glm::vec3 read(const raster::Plane<float> planes[3], int x, int y) { return {planes[0].at(x, y), planes[1].at(x, y), planes[2].at(x, y)}; }

glm::vec3 lightSpace(const PunctualLight& light, const glm::vec3& p) { return times(light.lightFromView, p) + light.origin; }

glm::vec3 positionAt(const Projector& p, int x, int y, float depth) {
  const float w = p.perspective ? depth : 1;
  return {(float(p.xFirst + x) + 0.5f - p.xCenter) * p.xInverse * w, (float(p.yFirst + y) + 0.5f - p.yCenter) * p.yInverse * w, -depth};
}

bool isSeen(float depth) { return depth < std::numeric_limits<float>::infinity(); }

// Unit, towards the light.
glm::vec3 directionTo(const PunctualLight& light, const glm::vec3& p) {
  if (light.kind == LightKind::Directional) return light.place;
  const glm::vec3 way = light.place - p;
  return way * (1 / std::sqrt(dot(way, way)));
}

// Falloff times cosine; 0: the light does not reach the point.
float arrives(const PunctualLight& light, const glm::vec3& p, float cosine) {
  if (light.kind == LightKind::Directional) return std::max(cosine, 0.0f);
  const glm::vec3 q = lightSpace(light, p);
  const float square = dot(q, q);
  const float ofRange = square * (light.range > 0 ? 1 / (light.range * light.range) : 0), window = 1 - ofRange * ofRange;
  if (!(cosine > 0 && window > 0 && square > 1e-30f)) return 0;
  float falloff = std::min(window / square, 1e15f);
  if (light.kind == LightKind::Spot) {
    const float s = dot(q, light.axis) / std::sqrt(square) * light.coneScale + light.coneOffset;
    if (!(s > 0)) return 0;
    falloff *= std::min(s, 1.0f) * std::min(s, 1.0f);
  }
  return falloff * cosine;
}

int mapOf(const PunctualLight& light, const glm::vec3& q) {
  if (light.maps < 6) return 0;
  const glm::vec3 a(std::fabs(q.x), std::fabs(q.y), std::fabs(q.z));
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return 2 * axis + (q[axis] < 0);
}

glm::vec3 inMap(const PunctualLight& light, int map, const glm::vec3& q) {
  if (light.maps < 6) return q;
  const int axis = map / 2, next = (axis + 1) % 3, last = (axis + 2) % 3;
  return map % 2 ? glm::vec3(q[next], q[last], -q[axis]) : glm::vec3(q[last], q[next], q[axis]);
}

struct Taps {
  int first;
  float offset;
  int weight[3];
};

Taps tapsAt(float texel, int size) {
  const float from = texel - 1, kept = !(from > 0) ? 0 : std::min(from, float(size - 3));
  const int first = int(kept), sixteenths = int((kept - float(first)) * 16);
  return {first, -0.5f - (kept - float(first)), {16 - sixteenths, 16, sixteenths}};
}

// q: the point, n: the normal of its triangle, in the map's space; slack: s of the header.
float litPart(const ShadowMap& map, const glm::vec3& q, const glm::vec3& n, float slack) {
  const Projector& p = map.projector;
  const raster::Plane<float>& stored = *map.depth;
  constexpr float t = 1.0f / 16, snap = 1.0f / 256;
  const float reach = 1.5f * std::sqrt(p.xInverse * p.xInverse + p.yInverse * p.yInverse);
  const float D = p.perspective ? dot(n, q) : n.z, V = p.perspective ? std::sqrt(dot(q, q)) : 1;
  const float size = std::max(std::fabs(D), V / 1024), turning = std::max(size, 2 * t * V), k = p.perspective ? 1 / q.z : -q.z;
  const glm::vec2 g = glm::vec2(n.x * p.xInverse, n.y * p.yInverse) / (D < 0 ? -size : size);
  const float bent = reach * t * (turning + V) / (turning * (turning - t * V)), off = slack / size * (p.perspective ? k : 1);
  const float key = k + ((std::fabs(g.x) + std::fabs(g.y)) * snap + (bent + off));
  const Taps u = tapsAt((p.perspective ? q.x / q.z : q.x) * p.xScale + p.xCenter, stored.width());
  const Taps v = tapsAt((p.perspective ? q.y / q.z : q.y) * p.yScale + p.yCenter, stored.height());
  int lit = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const float of = key + g.y * (v.offset + float(row)) + g.x * (u.offset + float(column));
      const float w = stored.at(u.first + column, v.first + row);
      const bool nearer = p.perspective ? w * (of > 0 ? of : 0) < 1 : w < -of;
      if (!nearer) lit += u.weight[column] * v.weight[row];
    }
  return float(lit) / 1024;
}

// pixel: how wide 1/256 of one is at the point, camera space.
float visiblePart(const PunctualLight& light, const glm::vec3& p, const glm::vec3& facet, float pixel) {
  const glm::vec3 q = lightSpace(light, p);
  const int map = mapOf(light, q);
  if (light.maps == 0 || !light.map[map].depth) return 1;
  const float shift = std::fabs(light.origin.x) + std::fabs(light.origin.y) + std::fabs(light.origin.z);
  const float rounding = ((std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z)) * light.worldFromView + shift) * 0x1p-20f;
  const glm::vec3 n = times(light.lightFromNormal, facet);
  return litPart(light.map[map], inMap(light, map, q), inMap(light, map, n), pixel * light.worldFromView + rounding);
}

float visiblePart(const DirectLightInput& in, const PunctualLight& light, int x, int y, const glm::vec3& p) {
  if (light.maps == 0) return 1;
  const float w = in.projector.perspective ? in.g->depth.at(x, y) : 1;
  return visiblePart(light, p, read(in.g->facet, x, y), (std::fabs(in.projector.xInverse) + std::fabs(in.projector.yInverse)) * (1.0f / 256) * w);
}

}  // namespace

void directLightRef(const DirectLightInput& in, int y0, int y1, LinearColor& out) {
  const raster::FloatEnvironment environment;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) {
      const float depth = in.g->depth.at(x, y);
      glm::vec3 sum = in.add ? read(out.rgb, x, y) : glm::vec3(0);
      if (isSeen(depth)) {
        const glm::vec3 p = positionAt(in.projector, x, y, depth), n = read(in.g->normal, x, y);
        ref::Surface surface{read(in.g->albedo, x, y), 0, 1, n, ref::viewDirection(in.projector, x, y)};
        if (isGlossy(in.brdf)) surface.metallic = in.g->metallic.at(x, y), surface.roughness = in.g->roughness.at(x, y);
        for (const PunctualLight& light : in.lights) {
          const glm::vec3 l = directionTo(light, p);
          const float nl = dot(n, l), amount = arrives(light, p, nl);
          if (amount > 0) sum += ref::reflection(in.brdf, surface, l, nl) * (light.color * (amount * visiblePart(in, light, x, y, p)));
        }
      }
      for (int c = 0; c < 3; ++c) out.rgb[c].at(x, y) = sum[c];
    }
}

float arrivingAt(const PunctualLight& light, const glm::vec3& p, const glm::vec3& n) {
  const raster::FloatEnvironment environment;
  const float amount = arrives(light, p, dot(n, directionTo(light, p)));
  return amount > 0 ? amount * visiblePart(light, p, n, 0) : 0;
}

uint32_t mapsReachedRef(const DirectLightInput& in, const PunctualLight& light, int y0, int y1) {
  const raster::FloatEnvironment environment;
  uint32_t found = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) {
      const float depth = in.g->depth.at(x, y);
      if (!isSeen(depth)) continue;
      const glm::vec3 p = positionAt(in.projector, x, y, depth);
      const float nl = dot(read(in.g->normal, x, y), directionTo(light, p));
      if (arrives(light, p, nl) > 0) found |= 1u << mapOf(light, lightSpace(light, p));
    }
  return found;
}

LightBounds boundsInLightRef(const raster::Plane<float>& depth, const Projector& projector, const PunctualLight& light, int y0, int y1) {
  const raster::FloatEnvironment environment;
  LightBounds bounds;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < depth.width(); ++x) {
      if (!isSeen(depth.at(x, y))) continue;
      const glm::vec3 q = lightSpace(light, positionAt(projector, x, y, depth.at(x, y)));
      bounds.add({q, q});
    }
  return bounds;
}

}  // namespace obscura::post
