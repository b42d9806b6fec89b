// Scenes of quads and balls with a material each, as the rooms of the extended ambient term's paper.
#pragma once

#include <cmath>

#include "frame_checks.h"

namespace obscura::tests {

// One mesh, with a material of its own, in world space.
struct Builder {
  engine::Scene scene;
  void add(const TestMesh& from, const glm::vec3& albedo, const glm::vec3& emissive = glm::vec3(0)) {
    engine::Mesh mesh;
    mesh.positions = from.positions, mesh.normals = from.normals, mesh.indices = from.indices;
    mesh.material = uint32_t(scene.materials.size());
    raster::Material m;
    m.baseColor = glm::vec4(albedo, 1), m.emissive = emissive;
    scene.materials.push_back(m);
    scene.instances.push_back({uint32_t(scene.meshes.size()), 0, glm::dmat4(1)});
    scene.meshes.push_back(std::move(mesh));
  }
  void addQuad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d, const glm::vec3& albedo,
               const glm::vec3& emissive = glm::vec3(0)) {
    TestMesh mesh;
    TestScene::addQuad(mesh, a, b, c, d);
    add(mesh, albedo, emissive);
  }
};

// The inside of a cube of side 4; walls at -x and +x of their own.
inline Builder room(const glm::vec3& left, const glm::vec3& right, const glm::vec3& rest) {
  Builder b;
  b.addQuad({-2, -2, 2}, {-2, -2, -2}, {-2, 2, -2}, {-2, 2, 2}, left);    // faces +x
  b.addQuad({2, -2, -2}, {2, -2, 2}, {2, 2, 2}, {2, 2, -2}, right);       // faces -x
  b.addQuad({-2, -2, 2}, {2, -2, 2}, {2, -2, -2}, {-2, -2, -2}, rest);    // floor
  b.addQuad({-2, 2, -2}, {2, 2, -2}, {2, 2, 2}, {-2, 2, 2}, rest);        // ceiling
  b.addQuad({-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}, rest);    // faces +z
  b.addQuad({2, -2, 2}, {-2, -2, 2}, {-2, 2, 2}, {2, 2, 2}, rest);        // faces -z
  return b;
}

inline TestMesh ball(double radius) {
  TestMesh mesh;
  const int rows = 16, columns = 32;
  for (int i = 0; i <= rows; ++i)
    for (int k = 0; k <= columns; ++k) {
      const double u = 3.14159265358979 * i / rows, v = 2 * 3.14159265358979 * k / columns;
      const glm::vec3 n(std::sin(u) * std::sin(v), std::cos(u), std::sin(u) * std::cos(v));
      mesh.normals.push_back(n);
      mesh.positions.push_back(n * float(radius));
    }
  for (uint32_t i = 0; i < uint32_t(rows); ++i)
    for (uint32_t k = 0; k < uint32_t(columns); ++k) {
      const uint32_t a = i * (columns + 1) + k, b = a + columns + 1;
      for (uint32_t v : {a, b, a + 1, a + 1, b, b + 1}) mesh.indices.push_back(v);
    }
  return mesh;
}

}  // namespace obscura::tests
