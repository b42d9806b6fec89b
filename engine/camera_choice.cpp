#include "obscura/engine/camera_choice.h"

#include <cmath>
#include <stdexcept>

#include "obscura/raster/exact_math.h"

namespace obscura::engine {
namespace {

constexpr double kRadians = 0.017453292519943295;  // per degree
constexpr double kDefaultFov = 45;                 // degrees, of cameras made here

Error usage(const std::string& message) { return {ErrorCode::Usage, message, "", ""}; }

glm::dvec3 centerOf(const Scene& scene) { return (scene.bounds.min + scene.bounds.max) * 0.5; }

double length(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

// Inverse of a rigid transform: the transposed rotation, and the translation turned round.
glm::dmat4 inverseRigid(const glm::dmat4& m) {
  glm::dmat4 r(1.0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r[i][j] = m[j][i];
    r[3][i] = -(m[i][0] * m[3][0] + m[i][1] * m[3][1] + m[i][2] * m[3][2]);
  }
  return r;
}

// Near and far around everything there is, seen from `eye`; depth has the same precision at any near plane, as its
// key is 1 / z in floating point.
double nearFor(const Scene& scene, const glm::dvec3& eye) {
  const double size = sceneSize(scene), distance = length(eye - centerOf(scene));
  return std::fmax(size * 1e-4, distance * 1e-5);
}

raster::Camera freeCamera(const Scene& scene, const CameraRequest& q, double aspect) {
  const double size = sceneSize(scene), fov = q.yFovDegrees.value_or(kDefaultFov) * kRadians;
  const glm::dvec3 target = q.target.value_or(centerOf(scene));
  // From the front, a little to the right and above, as far as the bounds' sphere needs in the narrower direction.
  const double half = 0.5 * fov, narrow = aspect < 1 ? raster::exactTan(half) * aspect : raster::exactTan(half);
  const double sine = narrow / std::sqrt(1 + narrow * narrow);
  const glm::dvec3 direction(0.5, 0.4, 1);
  const glm::dvec3 eye = q.eye.value_or(target + direction * (0.5 * size / sine / length(direction)));
  raster::Camera c = raster::perspective(fov, aspect, nearFor(scene, eye));
  c.viewFromWorld = raster::lookAt(eye, target, q.up.value_or(glm::dvec3(0, 1, 0)));
  return c;
}

Result<raster::Camera> fileCamera(const SceneCamera& s, const CameraRequest& q, double aspect) {
  raster::Camera c;
  if (s.projection == raster::Projection::Perspective) {
    c = raster::perspective(q.yFovDegrees ? *q.yFovDegrees * kRadians : s.yFov, aspect, s.zNear, s.zFar);
  } else {
    // As much as the file's camera shows, and more on one side where the image has another shape.
    const double shape = s.xMag / s.yMag;
    c = raster::orthographic(aspect > shape ? s.yMag * aspect : s.xMag, aspect > shape ? s.yMag : s.xMag / aspect, s.zNear, s.zFar);
  }
  c.viewFromWorld = inverseRigid(s.worldFromView);
  return c;
}

Result<raster::Camera> matrixCamera(const CameraRequest& q) try {
  if (!q.view || !q.projection) return usage("a view matrix and a projection matrix need each other");
  if (q.eye || q.target || q.up || q.yFovDegrees || !q.name.empty())
    return usage("a camera given by matrices and another one cannot be had at once");
  return raster::cameraFromMatrices(*q.view, *q.projection);
} catch (const std::invalid_argument& e) {
  return usage(e.what());
}

}  // namespace

double sceneSize(const Scene& scene) {
  const double size = scene.bounds.empty ? 0 : length(scene.bounds.max - scene.bounds.min);
  return size > 0 && std::isfinite(size) ? size : 1;
}

Result<raster::Camera> chooseCamera(const Scene& scene, const CameraRequest& q, int width, int height) {
  const double aspect = double(width) / double(height);
  if (q.view || q.projection) return matrixCamera(q);
  if (q.yFovDegrees && !(*q.yFovDegrees > 0 && *q.yFovDegrees < 180)) return usage("the field of view must be between 0 and 180 degrees");
  const bool isFree = q.eye || q.target || q.up;
  if (isFree && !q.name.empty()) return usage("a camera of the file and one of your own cannot be had at once");
  if (q.eye && length(*q.eye - q.target.value_or(centerOf(scene))) == 0) return usage("the eye is where the target is");
  if (isFree || (q.name.empty() && scene.cameras.empty())) return freeCamera(scene, q, aspect);
  if (q.name.empty()) return fileCamera(scene.cameras[0], q, aspect);

  for (const SceneCamera& c : scene.cameras)
    if (c.name == q.name) return fileCamera(c, q, aspect);
  if (q.name.size() < 6 && q.name.find_first_not_of("0123456789") == std::string::npos && size_t(std::stoi(q.name)) < scene.cameras.size())
    return fileCamera(scene.cameras[size_t(std::stoi(q.name))], q, aspect);
  std::string names;
  for (size_t i = 0; i < scene.cameras.size() && i < 16; ++i)
    names += (i ? ", " : "") + std::to_string(i) + (scene.cameras[i].name.empty() ? "" : " \"" + scene.cameras[i].name + "\"");
  return usage("no camera \"" + q.name + "\"; " + (names.empty() ? "the scene has none" : "there are: " + names));
}

}  // namespace obscura::engine
