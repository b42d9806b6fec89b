#include "obscura/engine/gltf_lights.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace obscura::engine::gltf {
namespace {

using post::LightKind;

constexpr double kHalfPi = 1.57079632679489662, kRounding = 1e-6, kMostRange = 1e15;

void check(bool holds, const std::string& path, const std::string& otherwise) {
  if (!holds) fail(path, otherwise);
}

void readCones(const tinygltf::SpotLight& in, const std::string& path, SceneLight& out) {
  const double inner = in.innerConeAngle, outer = in.outerConeAngle;
  check(outer > 0 && outer <= kHalfPi + kRounding, path + "/outerConeAngle", "not between 0 and pi / 2");
  check(inner >= 0 && inner <= outer + kRounding, path + "/innerConeAngle", "not between 0 and outerConeAngle");
  out.outerCone = std::min(outer, kHalfPi);
  out.innerCone = std::min(inner, out.outerCone);
}

}  // namespace

SceneLight readLight(const Document& document, int index, const std::string& user) {
  const tinygltf::Light& in = at(document.model.lights, index, "light", user);
  const std::string path = pointer("/extensions/KHR_lights_punctual/lights", uint64_t(index));
  SceneLight out;
  out.name = in.name;
  out.kind = in.type == "directional" ? LightKind::Directional : in.type == "point" ? LightKind::Point : LightKind::Spot;
  check(in.intensity >= 0 && in.intensity <= double(kMostLight), path + "/intensity", "below 0 or above 10^15");
  for (int c = 0; c < 3; ++c) {
    const double color = in.color.empty() ? 1 : in.color[size_t(c)], product = color * in.intensity;
    check(color >= 0 && product >= 0 && product <= double(kMostLight), path + "/color", "below 0, or with the intensity above 10^15");
    out.color[c] = float(product);
  }
  check(in.range >= 0 && in.range <= kMostRange, path + "/range", "below 0 or above 10^15");
  out.range = in.range;
  if (out.kind == LightKind::Spot) readCones(in.spot, path + "/spot", out);
  return out;
}

bool placeAt(const glm::dmat4& worldFromNode, SceneLight& light) {
  light.position = glm::dvec3(worldFromNode[3]);
  for (int c = 0; c < 3; ++c)
    if (!(std::fabs(light.position[c]) < 1e30)) return false;
  if (light.kind == LightKind::Point) return true;
  const glm::dvec3 forward = -glm::dvec3(worldFromNode[2]);
  const double length = std::sqrt(glm::dot(forward, forward));
  if (!(length > 0 && length < 1e150)) return false;
  light.direction = forward / length;
  return true;
}

}  // namespace obscura::engine::gltf
