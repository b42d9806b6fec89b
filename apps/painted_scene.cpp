#include "obscura/apps/painted_scene.h"

#include <map>

namespace obscura::apps {
namespace {

engine::Texture whitened(const engine::Texture& texture) {
  auto texels = std::make_shared<std::vector<uint32_t>>(texture.view.texels.begin(), texture.view.texels.end());
  for (uint32_t& t : *texels) t |= 0x00FFFFFFu;  // alpha is the highest byte
  engine::Texture white = texture;
  white.view.texels = *texels;
  white.texels = std::move(texels);
  return white;
}

}  // namespace

void removeLights(engine::Scene& scene) {
  scene.lights.clear();
  for (engine::Instance& i : scene.instances) i.ambient.reset();
  for (raster::Material& m : scene.materials) {
    m.emissive = glm::vec3(0);
    if (m.unlit) m.baseColor = glm::vec4(0, 0, 0, m.baseColor.w);
    m.unlit = false;
  }
}

void paint(engine::Scene& scene, glm::vec3 albedo) {
  std::map<int, int> white;  // by the texture that it is made of
  for (raster::Material& m : scene.materials) {
    m.baseColor = glm::vec4(albedo, m.baseColor.w);
    m.unlit = false;
    int& texture = m.baseColorMap.texture;
    if (m.alphaMode != raster::AlphaMode::Mask) texture = -1;
    if (texture < 0) continue;
    const auto [made, isNew] = white.emplace(texture, int(scene.textures.size()));
    if (isNew) scene.textures.push_back(whitened(scene.textures[size_t(texture)]));
    texture = made->second;
  }
  for (engine::Mesh& m : scene.meshes)
    for (glm::vec4& c : m.colors) c = glm::vec4(1, 1, 1, c.w);
}

}  // namespace obscura::apps
