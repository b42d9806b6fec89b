#include "obscura/apps/ray_surface.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "obscura/raster/surface_ref.h"

namespace obscura::apps {
namespace {

template <class T>
T interpolate(const std::vector<T>& values, const uint32_t* vertex, float u, float v) {
  return values[vertex[0]] * ((1 - u) - v) + values[vertex[1]] * u + values[vertex[2]] * v;
}

glm::dvec3 unitOr(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

}  // namespace

RaySurface::RaySurface(const engine::Scene& scene, const raster::Camera& camera) : scene_(scene) {
  for (const engine::Instance& instance : scene.instances) {
    const engine::Mesh& mesh = scene.meshes[instance.mesh];
    const glm::dmat4 viewFromObject = camera.viewFromWorld * instance.worldFromObject;
    std::vector<glm::vec3>& out = positions_.emplace_back();
    out.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) out.emplace_back(viewFromObject * glm::dvec4(p, 1));
    // Cofactors: the inverse transpose times the determinant, also where there is no inverse.
    const glm::dmat3 m(viewFromObject);
    glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const bool mirrored = glm::dot(m[0], cofactors[0]) < 0;
    viewFromNormal_.push_back(mirrored ? -cofactors : cofactors);
    mirrored_.push_back(mirrored);
  }
}

bool RaySurface::masked(size_t instance) const { return material(instance).alphaMode == raster::AlphaMode::Mask; }

void RaySurface::corners(uint32_t instance, uint32_t triangle, glm::dvec3 (&out)[3]) const {
  const uint32_t* vertex = &mesh(instance).indices[size_t(triangle) * 3];
  for (int k = 0; k < 3; ++k) out[k] = glm::dvec3(positions_[instance][vertex[k]]);
}

glm::dvec3 RaySurface::outside(uint32_t instance, uint32_t triangle) const {
  glm::dvec3 p[3];
  corners(instance, triangle, p);
  const glm::dvec3 n = unitOr(glm::cross(p[1] - p[0], p[2] - p[0]), glm::dvec3(0));
  return mirrored_[instance] ? -n : n;
}

glm::dvec3 RaySurface::normal(const TrianglePoint& p) const {
  const engine::Mesh& m = mesh(p.instance);
  const glm::dvec3 flat = outside(p.instance, p.triangle);
  if (m.normals.empty()) return flat;
  const glm::vec3 n = interpolate(m.normals, &m.indices[size_t(p.triangle) * 3], p.u, p.v);
  return unitOr(viewFromNormal_[p.instance] * glm::dvec3(n), flat);
}

glm::vec4 RaySurface::baseColor(const TrianglePoint& p) const {
  const engine::Mesh& m = mesh(p.instance);
  const raster::Material& material = scene_.materials[m.material];
  const uint32_t* vertex = &m.indices[size_t(p.triangle) * 3];
  glm::vec4 color = material.baseColor;
  const raster::TextureSlot& slot = material.baseColorMap;
  if (slot.texture >= 0) {
    const std::vector<glm::vec2>& uvs = m.uvs[slot.uvSet];
    const glm::vec2 at = uvs.empty() ? glm::vec2(0) : interpolate(uvs, vertex, p.u, p.v);
    const auto& t = slot.uvFromUv;
    color *= raster::ref::sampleTexture(scene_.textures[size_t(slot.texture)].view, srgb_.linear,
                                        t[0] * at.x + t[1] * at.y + t[2], t[3] * at.x + t[4] * at.y + t[5], 0);
  }
  return m.colors.empty() ? color : color * interpolate(m.colors, vertex, p.u, p.v);
}

glm::vec3 RaySurface::albedo(const TrianglePoint& p) const {
  if (material(p.instance).unlit) return glm::vec3(0);
  const glm::vec4 color = baseColor(p);
  glm::vec3 a;
  for (int c = 0; c < 3; ++c) a[c] = color[c] > 0 ? std::min(color[c], 1.0f) : 0.0f;
  return a;
}

bool RaySurface::covered(const TrianglePoint& p) const {
  return !masked(p.instance) || baseColor(p).w >= material(p.instance).alphaCutoff;
}

}  // namespace obscura::apps
