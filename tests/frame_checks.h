// Whole frames of the engine for tests: scenes from those of raster's, frames that must succeed, their images.
#pragma once

#include <catch2/catch.hpp>

#include "obscura/apps/pictures.h"
#include "obscura/engine/ambient_directions.h"
#include "obscura/engine/frame.h"
#include "test_scene.h"

namespace obscura::tests {

// Every third instance has an ambient light of its own.
inline engine::Scene sceneFrom(const TestScene& from) {
  engine::Scene s;
  for (const TestMesh& m : from.meshes) {
    engine::Mesh& mesh = s.meshes.emplace_back();
    mesh.positions = m.positions, mesh.normals = m.normals, mesh.tangents = m.tangents, mesh.colors = m.colors;
    mesh.uvs[0] = m.uvs, mesh.indices = m.indices;
  }
  s.materials = from.materials;
  for (const raster::TextureView& t : from.textures) {
    auto texels = std::make_shared<std::vector<uint32_t>>(t.texels.begin(), t.texels.end());
    s.textures.push_back({"", texels, t});
    s.textures.back().view.texels = *texels;
  }
  // The engine keeps one material a mesh: as many meshes as instances.
  for (const raster::Instance& i : from.instances) {
    engine::Mesh mesh = s.meshes[0];
    mesh.material = i.material;
    s.instances.push_back({uint32_t(s.meshes.size()), 0, i.worldFromObject});
    if (s.instances.size() % 3 == 0) s.instances.back().ambient = glm::vec3(0.2f, 1, 3);
    s.meshes.push_back(std::move(mesh));
  }
  return s;
}

inline std::vector<engine::Aov> allAovs() {
  std::vector<engine::Aov> all;
  for (const engine::AovInfo& info : engine::allAovs()) all.push_back(info.aov);
  return all;
}

// Every plane of a frame and its display bytes, as images.
inline std::vector<engine::Image> imagesOf(const engine::Frame& frame) {
  std::vector<engine::Image> images;
  for (engine::Aov aov : allAovs()) images.push_back(apps::planeImage(frame, aov));
  images.push_back(apps::displayPicture(frame));
  return images;
}

inline engine::Frame frameOf(const engine::Scene& scene, const engine::FrameSettings& s, const raster::Settings& raster = {},
                      bool reference = false) {
  engine::Renderer renderer(raster, reference);
  engine::Frame frame;
  const auto done = renderer.render(scene, s, frame);
  INFO((done ? "" : done.error().text()));
  REQUIRE(done.ok());
  return frame;
}

// Ambient light by direction: factors of six sides.
constexpr std::array<glm::vec3, 6> kSixColors{glm::vec3{1, 0.5f, 0.5f}, {0.5f, 1, 0.5f}, {2, 2, 2}, {0, 0.1f, 0.2f}, {0.5f, 0.5f, 1}, {1, 1, 0}};
inline std::vector<post::AmbientDirection> sixDirections() { return engine::cubeOf(kSixColors); }
// Of that many directions, which also add light.
inline std::vector<post::AmbientDirection> addingDirections(int count) {
  std::vector<post::AmbientDirection> out;
  for (const glm::dvec3& d : engine::spreadDirections(count))
    out.push_back({glm::vec3(d), glm::vec3(0.5f) + 0.5f * glm::vec3(d), glm::vec3(0.3f) - 0.2f * glm::vec3(d)});
  return out;
}

}  // namespace obscura::tests
