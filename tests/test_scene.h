// Scenes for the tests of raster and post, made of plain spans, and the comparison of frames bit by bit.
#pragma once

#include <cstring>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "obscura/raster/rasterizer.h"

namespace obscura::tests {

struct TestMesh {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents, colors;
  std::vector<glm::vec2> uvs;
  std::vector<uint32_t> indices;
  raster::Clusters clusters;
  raster::MeshView view;
};

// Owns everything that a draw list points to; not to be copied.
struct TestScene {
  std::deque<TestMesh> meshes;
  std::vector<std::vector<uint32_t>> texels;
  std::vector<raster::TextureView> textures;
  std::vector<raster::Material> materials;
  std::vector<raster::Instance> instances;
  std::vector<raster::ImplicitSurface> implicits;
  std::vector<float> heights;
  std::vector<raster::HeightView> heightViews;
  raster::Camera camera;
  int width = 64, height = 48;

  TestScene() = default;
  TestScene(const TestScene&) = delete;
  TestScene(TestScene&&) = default;

  TestMesh& addMesh() { return meshes.emplace_back(); }
  // Fixes the mesh's view and places it.
  void place(TestMesh& mesh, uint32_t material = 0, const glm::dmat4& worldFromObject = glm::dmat4(1), bool clusters = true);
  raster::DrawList list() const { return {instances, materials, textures, implicits, heightViews}; }
  // a, b, c, d counter-clockwise seen from outside.
  static void addQuad(TestMesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
};

// Numbers that are the same with every standard library (its distributions are not).
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  float real(float lo, float hi) { return lo + (hi - lo) * (float(engine_() >> 8) * (1.0f / 16777216)); }
  int integer(int lo, int hi) { return lo + int(engine_() % uint32_t(hi - lo + 1)); }
  glm::vec3 vector(float lo, float hi) {
    const float x = real(lo, hi), y = real(lo, hi);
    return {x, y, real(lo, hi)};
  }
  uint32_t bits() { return uint32_t(engine_()); }

 private:
  std::mt19937 engine_;
};

// Triangle soup with everything on that the seed chooses: textures, wrap and filter modes, masks, mirrored and
// flattened instances, orthographic cameras, near and far planes through the geometry.
TestScene soupScene(uint32_t seed);

// Every plane of the first layer.
constexpr raster::PlaneSet kAllPlanes{true, true, true, true, true, true, true, true, false, false, 0, false, true, true, true};

// Those behind it as well, and depths alone. The separation is a tenth of a soup's size, so some layers are skipped.
constexpr raster::PlaneSet kAllLayers{true, true, true, true, true, true, true, true, true, true, 0.6f, false, true, true, true};
constexpr raster::PlaneSet kDepths{true, false, false, false, false, false, false, false, true, true, 0.6f};

// Empty if equal, else the first difference: "albedo[1] differs at (3, 7): 0.5 (3f000000) and ...".
std::string firstDifference(const char* name, const raster::Plane<float>& a, const raster::Plane<float>& b);
std::string firstDifference(const char* name, const raster::Plane<uint32_t>& a, const raster::Plane<uint32_t>& b);
std::string firstDifference(const raster::GBuffer& a, const raster::GBuffer& b);

}  // namespace obscura::tests
