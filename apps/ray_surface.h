// In:  a scene and a camera.
// Out: its triangles in camera space, and what is to be known of a point on one of them: place, sides, normal, albedo.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "obscura/engine/scene.h"
#include "obscura/raster/span.h"
#include "obscura/raster/srgb.h"

namespace obscura::apps {

// A point of a triangle of an instance: corner 0 + u (corner 1 - corner 0) + v (corner 2 - corner 0).
struct TrianglePoint {
  uint32_t instance = 0, triangle = 0;  // index into Scene::instances; of its mesh
  float u = 0, v = 0;
};

// Camera space: x right, y up, z towards the eye, which lies at 0 (perspective). The scene must outlive it.
class RaySurface {
 public:
  RaySurface(const engine::Scene& scene, const raster::Camera& camera);

  size_t instances() const { return positions_.size(); }
  raster::Span<const glm::vec3> positions(size_t instance) const { return positions_[instance]; }
  raster::Span<const uint32_t> indices(size_t instance) const { return mesh(instance).indices; }
  bool masked(size_t instance) const;  // some of its points may be cut out by their alpha

  void corners(uint32_t instance, uint32_t triangle, glm::dvec3 (&out)[3]) const;
  // Unit; the outer side by the winding, of a mirrored instance, too. 0 if the triangle has no area.
  glm::dvec3 outside(uint32_t instance, uint32_t triangle) const;
  // Interpolated, unit, on the outer side; of a mesh without normals the triangle's. Normal maps are left out.
  glm::dvec3 normal(const TrianglePoint& p) const;

  // Factor x texture x vertex colour, as the G-buffer has it, but of the texture's finest level: a ray has no pixel's
  // footprint.
  glm::vec4 baseColor(const TrianglePoint& p) const;
  glm::vec3 albedo(const TrianglePoint& p) const;  // [0, 1]; 0 of unlit materials
  bool covered(const TrianglePoint& p) const;      // alpha reaches the material's cutoff, or there is none

 private:
  const engine::Mesh& mesh(size_t instance) const { return scene_.meshes[scene_.instances[instance].mesh]; }
  const raster::Material& material(size_t instance) const { return scene_.materials[mesh(instance).material]; }

  const engine::Scene& scene_;
  std::vector<std::vector<glm::vec3>> positions_;
  std::vector<glm::dmat3> viewFromNormal_;  // up to a positive factor
  std::vector<uint8_t> mirrored_;
  raster::SrgbTable srgb_;
};

}  // namespace obscura::apps
