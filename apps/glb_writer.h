// In: meshes, materials, textures, nodes.  Out: the bytes of a .glb file (glTF 2.0).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace obscura::apps {

struct GlbTexture {  // becomes an embedded PNG, repeated in both directions, with mip maps
  std::string name;
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;  // sRGB and straight alpha, or metallic in blue and roughness in green; row 0 on top
  std::vector<uint16_t> grey = {};  // instead of it: linear, 16 bits
};

struct GlbMaterial {
  std::string name;
  glm::dvec3 baseColor{1};  // linear
  glm::dvec3 emissive{0};   // linear; above 1 with KHR_materials_emissive_strength
  int texture = -1;         // into GlbScene::textures
  double metallic = 0, roughness = 1;
  int gloss = -1;           // alike: metallic and roughness are factors on it
  double alphaCutoff = 0;   // above 0: alphaMode MASK
  bool doubleSided = false;
  int normalMap = -1;       // a texture of linear bytes
  std::string extras;       // JSON, or empty
};

struct GlbMesh {
  std::string name;
  int material = 0;
  std::vector<glm::vec3> positions, normals;  // of the same length
  std::vector<glm::vec2> uvs;                 // of the same length, or empty
  std::vector<glm::vec3> colors;              // the same; linear, 0 ... 1, stored as 16-bit fractions
  std::vector<uint32_t> indices;
};

struct GlbLight {  // of KHR_lights_punctual; shines along its node's -z
  std::string name, type;  // "directional", "point" or "spot"
  glm::dvec3 color{1};
  double intensity = 1, range = 0;             // range 0: none
  double innerCone = 0, outerCone = 0.785398;  // of a spot, radians
};

struct GlbNode {
  std::string name;
  int mesh = -1, light = -1;
  std::string extras;         // JSON, or empty
  glm::dvec3 translation{0};
  std::array<double, 4> rotation{0, 0, 0, 1};  // unit quaternion x, y, z, w
  glm::dvec3 scale{1};
  std::vector<int> children;  // of higher index
};

struct GlbCamera {
  std::string name;
  glm::dvec3 eye{0}, target{0, 0, -1};  // up is +y
  double yFov = 0.8, aspect = 4.0 / 3, zNear = 0.1, zFar = 100;
};

struct GlbScene {
  std::vector<GlbTexture> textures;
  std::vector<GlbMaterial> materials;
  std::vector<GlbMesh> meshes;
  std::vector<GlbLight> lights;
  std::vector<GlbNode> nodes;
  std::vector<int> roots;  // into nodes; the camera becomes one more root
  GlbCamera camera;
};

std::vector<uint8_t> glbFromScene(const GlbScene& scene);

// A PNG of 8-bit RGBA or 16-bit grey whose data are stored, not compressed: its bytes depend on no library's version.
std::vector<uint8_t> storedPng(const GlbTexture& texture);

}  // namespace obscura::apps
