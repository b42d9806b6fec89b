#include "obscura/engine/shadow_maps.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/raster/exact_math.h"

namespace obscura::engine {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;
using post::LightKind;

constexpr double kMargin = 4;         // texels of a map that lit points do not need, on both sides together
constexpr double kWidestCosine = 0.6;  // of a spot with one map
constexpr double kNearest = 1e-4;      // of the scene's size

dvec3 unit(const dvec3& v) { return v / std::sqrt(glm::dot(v, v)); }

// From the world to a space with these axes and this origin.
dmat4 rigid(const dvec3& x, const dvec3& y, const dvec3& z, const dvec3& origin) {
  const dvec3 axes[3] = {x, y, z};
  dmat4 m(1.0);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m[c][r] = axes[r][c];
    m[3][r] = -glm::dot(axes[r], origin);
  }
  return m;
}

// A view space that looks along `direction`.
dmat4 looking(const dvec3& direction, const dvec3& origin) {
  const dvec3 back = -unit(direction);
  const dvec3 right = unit(glm::cross(std::fabs(back.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(0, 0, -1), back));
  return rigid(right, glm::cross(back, right), back, origin);
}

// A view space along one of the world's axes, see post::PunctualLight.
dmat4 lookingAlong(int map, const dvec3& origin) {
  const auto axis = [](int k) { return dvec3(k % 3 == 0, k % 3 == 1, k % 3 == 2); };
  const int a = map / 2;
  return map % 2 ? rigid(axis(a + 1), axis(a + 2), axis(a), origin) : rigid(axis(a + 2), axis(a + 1), -axis(a), origin);
}

// lightFromWorld: into light space, w or the third axis included.
void place(const dmat4& lightFromWorld, const raster::Camera& camera, post::PunctualLight& light) {
  const dmat4 lightFromView = lightFromWorld * glm::inverse(camera.viewFromWorld);
  const dmat3 turn(lightFromView);
  double squares[3], all = 0;
  for (int c = 0; c < 3; ++c) all += squares[c] = glm::dot(turn[c], turn[c]);
  const double mean = all / 3;
  bool uniform = true;
  for (int c = 0; c < 3; ++c)
    uniform &= std::fabs(squares[c] - mean) < 1e-9 * mean && std::fabs(glm::dot(turn[c], turn[(c + 1) % 3])) < 1e-9 * mean;
  light.lightFromView = glm::mat3(turn);
  light.lightFromNormal = glm::mat3(glm::transpose(glm::inverse(turn)) * std::sqrt(mean));
  light.origin = glm::vec3(dvec3(lightFromView[3]));
  light.worldFromView = float(std::sqrt(uniform ? mean : all));  // at most so much longer
}

// z of a view space is -w.
dmat4 withDistance(const dmat4& viewFromWorld) {
  dmat4 m = viewFromWorld;
  for (int c = 0; c < 4; ++c) m[c][2] = -m[c][2];
  return m;
}

double sizeOf(const Bounds& b) {
  const dvec3 d = b.max - b.min;
  return b.empty ? 1 : std::max(std::sqrt(glm::dot(d, d)), 1e-20);
}

void addMap(const raster::Camera& camera, int size, LightViews& views) {
  views.light.map[views.cameras.size()].projector = post::makeProjector(camera, size, size);
  views.cameras.push_back(camera);
}

raster::Camera pinhole(const dmat4& viewFromWorld, double tangent, const SceneLight& light, const Bounds& scene, int size) {
  raster::Camera c;
  c.viewFromWorld = viewFromWorld;
  c.xScale = c.yScale = float((size - kMargin) / (size * tangent));
  c.zNear = float(std::max(kNearest * sizeOf(scene), 1e-25));
  if (light.range > 0) c.zFar = std::max(float(light.range * 1.001), c.zNear * 2);
  return c;
}

void addCone(const SceneLight& in, post::PunctualLight& light) {
  const double outer = raster::exactCos(in.outerCone), inner = raster::exactCos(in.innerCone);
  const double scale = 1 / std::max(0.001, inner - outer);
  light.coneScale = float(scale);
  light.coneOffset = float(-outer * scale);
}

}  // namespace

const char* wrongLight(const SceneLight& l) {
  for (int c = 0; c < 3; ++c) {
    if (!(l.color[c] >= 0 && l.color[c] <= kMostLight)) return "a light's colour times its intensity must be 0 to 10^15";
    if (!(std::fabs(l.position[c]) < 1e30)) return "a light's position must be finite";
  }
  if (!(std::fabs(glm::dot(l.direction, l.direction) - 1) < 1e-6)) return "a light's direction must have the length 1";
  if (!(l.range >= 0 && l.range <= 1e15)) return "a light's range must be 0 to 10^15";
  if (!(l.innerCone >= 0 && l.innerCone <= l.outerCone && l.outerCone > 0 && l.outerCone <= 1.5707963267948968))
    return "a spot's cones must be 0 <= inner <= outer <= pi / 2";
  return nullptr;
}

LightViews viewsOf(const SceneLight& in, const raster::Camera& camera, const Bounds& scene, int size) {
  LightViews out;
  post::PunctualLight& light = out.light;
  light.kind = in.kind;
  light.color = in.color;
  light.range = float(in.range);
  const bool directional = in.kind == LightKind::Directional;
  light.place = directional ? glm::vec3(unit(dmat3(camera.viewFromWorld) * -in.direction))
                            : glm::vec3(dvec3(camera.viewFromWorld * dvec4(in.position, 1)));
  if (in.kind == LightKind::Spot) addCone(in, light);
  const double cosine = raster::exactCos(in.outerCone);
  if (directional || (in.kind == LightKind::Spot && cosine >= kWidestCosine)) {
    const dmat4 view = looking(in.direction, directional ? dvec3(0) : in.position);
    place(withDistance(view), camera, light);
    if (size == 0) return out;
    light.maps = 1;
    if (!directional) addMap(pinhole(view, raster::exactSin(in.outerCone) / cosine, in, scene, size), size, out);
    return out;
  }
  place(rigid({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, in.position), camera, light);
  light.axis = glm::vec3(in.direction);
  if (size == 0) return out;
  light.maps = 6;
  for (int map = 0; map < 6; ++map) addMap(pinhole(lookingAlong(map, in.position), 1, in, scene, size), size, out);
  return out;
}

void fitted(const SceneLight& light, const raster::Camera& camera, const Bounds& scene, int size, const post::LightBounds& seen,
            LightViews& views) {
  const dmat4 view = looking(light.direction, dvec3(0));
  double nearest = double(seen.min.z);
  for (int corner = 0; corner < 8 && !scene.empty; ++corner) {
    const dvec4 p(corner & 1 ? scene.max.x : scene.min.x, corner & 2 ? scene.max.y : scene.min.y, corner & 4 ? scene.max.z : scene.min.z, 1);
    nearest = std::min(nearest, -(view * p).z);
  }
  const dvec3 lo(seen.min), hi(seen.max), extent = hi - lo;
  const double depth = double(seen.max.z) - nearest;
  const double largest = std::max({extent.x, extent.y, depth, std::fabs(nearest) * 1e-6, 1e-20});
  const double pad = largest * 1e-3, widest = size / (size - kMargin);
  raster::Camera c = raster::orthographic(std::max(extent.x * 0.5, pad) * widest, std::max(extent.y * 0.5, pad) * widest, 0, depth + 2 * pad);
  const dvec3 middle((lo.x + hi.x) * 0.5, (lo.y + hi.y) * 0.5, -(nearest - pad));  // of the view space
  c.viewFromWorld = view;
  c.viewFromWorld[3] = dvec4(-middle, 1);
  place(withDistance(c.viewFromWorld), camera, views.light);
  addMap(c, size, views);
}

}  // namespace obscura::engine
