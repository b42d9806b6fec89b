#include "obscura/engine/frame_needs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/engine/ambient_directions.h"
#include "obscura/engine/ambient_light.h"
#include "obscura/engine/direct_lights.h"
#include "obscura/raster/view.h"

namespace obscura::engine {
namespace {

// Some pixels may reflect nothing, whatever textures hold.
bool hasDarkThings(const Scene& scene, post::Brdf brdf) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [&](const raster::Material& m) {
    if (m.unlit || isGlossy(brdf)) return m.unlit;  // what is black is glossy all the same
    return !(m.baseColor.x > 0 || m.baseColor.y > 0 || m.baseColor.z > 0);
  }) || std::any_of(scene.instances.begin(), scene.instances.end(), [](const Instance& i) {
    return i.ambient && *i.ambient == glm::vec3(0);
  });
}

// No ambient light at all: nothing to be occluded.
bool isDark(const Scene& scene, const FrameSettings& s) {
  return s.ambientLight == glm::vec3(0) && !s.environment && !hasAmbientGroups(scene) && !post::addsLight(s.ambientDirections);
}

bool wants(const FrameSettings& s, Aov aov) { return std::find(s.aovs.begin(), s.aovs.end(), aov) != s.aovs.end(); }

}  // namespace

bool lightsByNormal(const FrameSettings& s) { return !s.ambientDirections.empty() || s.environment; }

FrameNeeds needsOf(const Scene& scene, const FrameSettings& s) {
  const auto wants = [&](Aov aov) { return engine::wants(s, aov); };
  FrameNeeds n;
  n.color = wants(Aov::Color) || s.display;
  const bool bounces = s.ambient == post::Occlusion::Transfer && s.transfer.albedo == post::TransferAlbedo::Radiance;
  if (n.color && (bounces || !isDark(scene, s))) n.occlusion = s.ambient;
  const bool w = wants(Aov::Transfer) || n.occlusion == post::Occlusion::Transfer;
  n.radiance = w && s.transfer.albedo == post::TransferAlbedo::Radiance;
  n.albedo = w && !n.radiance;
  n.transfer.bounced = n.radiance;
  n.transfer.w = n.radiance ? wants(Aov::Transfer) : w;
  n.reflections = n.color && isGlossy(s.brdf) && s.environment && s.environment->cubes.hasReflections();
  n.transfer.obscurance = wants(Aov::Obscurance) || n.radiance || n.occlusion == post::Occlusion::Obscurance ||
                          (n.reflections && n.occlusion != post::Occlusion::None);
  n.sums = w || n.transfer.obscurance;
  n.onlyLit = n.sums && !wants(Aov::Obscurance) && !wants(Aov::Transfer) && hasDarkThings(scene, s.brdf);
  const bool lights = n.color || n.radiance;
  n.direct = lights && hasLights(scene, s);
  if (lights) n.brdf = s.brdf;
  const bool glossy = isGlossy(n.brdf);
  n.planes.depth = wants(Aov::Depth) || n.sums || n.color || s.supersample > 1;  // the nearest sub-pixel
  n.planes.normal = wants(Aov::Normal) || n.sums || (lights && lightsByNormal(s)) || n.direct || glossy;
  n.planes.facet = n.direct && hasShadows(scene, s);
  n.planes.albedo = wants(Aov::Albedo) || n.albedo || lights;
  n.planes.emissive = wants(Aov::Emissive) || (lights && std::any_of(scene.materials.begin(), scene.materials.end(), raster::emits));
  n.planes.position = wants(Aov::Position);
  n.planes.relief = n.sums && s.displacement && !scene.heightMaps.empty();
  n.planes.triangle = wants(Aov::Triangle);
  n.planes.instance = wants(Aov::Instance) || (lights && hasAmbientGroups(scene));
  n.planes.material = wants(Aov::Material);
  n.planes.depth2 = wants(Aov::Depth2) || (n.sums && s.transfer.layers == 2);
  n.planes.depthBack = wants(Aov::DepthBack);
  n.planes.metallic = wants(Aov::Metallic) || glossy;
  n.planes.roughness = wants(Aov::Roughness) || glossy;
  n.planes.separation = s.separation;
  return n;
}

const char* wrongSetting(const FrameSettings& s) {
  const post::AmbientSettings& t = s.transfer;
  if (s.supersample != 1 && s.supersample != 2 && s.supersample != 4) return "supersample must be 1, 2 or 4";
  if (s.supersample > 1 && (std::min(s.width, s.height) < 1 ||
                            std::max(s.width, s.height) > raster::kMaxImageSize / s.supersample))
    return "width and height times supersample must be 1 to 16384: choose another size or less supersampling";
  if (t.samples < 1 || t.samples > 64) return "samples must be 1 to 64";
  if (t.steps < 1 || t.steps > post::kMaxSteps) return "steps must be 1 to 16";
  if (!(t.radius > 0 && t.radius < 1e30f)) return "the radius must be positive and finite";
  if (!(t.bias >= 0 && t.bias < 1e30f)) return "the bias must be 0 or more and finite";
  if (t.layers < 1 || t.layers > 2) return "layers must be 1 or 2";
  if ((wants(s, Aov::Depth2) || t.layers == 2) && !(s.separation > 0 && s.separation < 1e30f)) return "the separation must be positive and finite";
  if (t.estimator == post::Estimator::Lines && t.membership != post::Membership::Linear)
    return "line samples have the linear membership: choose that, or another estimator";
  if (!(t.filterThreshold > 0)) return "the filter threshold must be positive";
  if (!(s.environmentIntensity >= 0 && s.environmentIntensity <= kMostIntensity)) return "the environment's intensity must be 0 to 10^6";
  if (!(std::fabs(s.environmentRotation) <= kMostRotation)) return "the environment's rotation must be -10^6 to 10^6 degrees";
  if (s.environmentBackground && !(s.environment && !s.environment->cubes.empty())) return "an environment as background needs one with a cube";
  if (!(s.tone.exposure >= 0 && s.tone.exposure <= kMostExposure)) return "the exposure must be a factor of 0 to 2^64";
  const auto isColor = [](const glm::vec3& v) {
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && std::max({v.x, v.y, v.z}) < 1e30f;
  };
  if (s.ambientDirections.size() > size_t(kMostClasses)) return "the ambient light can have at most 256 directions";
  bool colors = isColor(s.ambientLight) && isColor(s.background);
  for (const post::AmbientDirection& k : s.ambientDirections) {
    colors &= isColor(k.color) && isColor(k.added);
    if (!(std::fabs(glm::dot(k.direction, k.direction) - 1) < 1e-3f)) return "the ambient light's directions must have the length 1";
  }
  return colors ? nullptr : "colours must be 0 or more and finite";
}

}  // namespace obscura::engine
