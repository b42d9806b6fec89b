// The small scene that the command line's tests render.
#pragma once

#include <string>
#include <vector>

#include "gltf_builder.h"

namespace obscura::tests {

// A rectangle from `corner` along `u` and `v`, facing u x v, with texture coordinates.
inline int addRectangle(GltfBuilder& b, const std::vector<float>& corner, const std::vector<float>& u,
                        const std::vector<float>& v, int material) {
  std::vector<float> positions;
  for (const auto& [s, t] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}})
    for (size_t c = 0; c < 3; ++c) positions.push_back(corner[c] + s * u[c] + t * v[c]);
  const int mesh = b.addMesh({{"attributes",
                               {{"POSITION", b.addFloats(positions, "VEC3")},
                                {"TEXCOORD_0", b.addFloats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2")}}},
                              {"indices", b.addAccessor(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, kUShort, "SCALAR")},
                              {"material", material}});
  return b.addNode({{"mesh", mesh}});
}

// Floor, two walls of a corner (one red, so that W has a colour) and, in front, a fence whose texture has holes; a
// camera named "front" at (1, 1, 5) that looks along -z.
inline GltfBuilder cornerScene() {
  GltfBuilder b;
  const auto colour = [](double red, double green, double blue) {
    return GltfBuilder::Json{{"pbrMetallicRoughness", {{"baseColorFactor", {red, green, blue, 1.0}}}}};
  };
  std::vector<uint32_t> fence;
  for (uint32_t i = 0; i < 64; ++i) fence.push_back((i % 8 < 4) == (i / 8 < 4) ? 0xFF40A0FFu : 0x00FFFFFFu);
  const int texture = b.addTexture(pngOf(fence, 8, 8));
  b.add("materials", colour(0.7, 0.7, 0.6));
  b.add("materials", colour(0.8, 0.1, 0.1));
  b.add("materials", {{"alphaMode", "MASK"},
                      {"doubleSided", true},
                      {"emissiveFactor", {0.0, 0.1, 0.2}},
                      {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  addRectangle(b, {0, 0, 2}, {2, 0, 0}, {0, 0, -2}, 0);
  addRectangle(b, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 0);
  addRectangle(b, {0, 0, 2}, {0, 0, -2}, {0, 2, 0}, 1);
  addRectangle(b, {0.5f, 0.25f, 1}, {1, 0, 0}, {0, 1, 0}, 2);
  const int camera = b.add("cameras", {{"type", "perspective"},
                                       {"name", "front"},
                                       {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"aspectRatio", 1.0}}}});
  b.addNode({{"camera", camera}, {"translation", {1.0, 1.0, 5.0}}});
  return b;
}

// A folder with scene.glb, and what is rendered from it.
struct SceneFolder {
  TemporaryFolder folder;
  std::string scene = folder / "scene.glb";

  SceneFolder() { writeBytes(scene, cornerScene().glb()); }
  std::string operator/(const std::string& name) const { return folder / name; }
};

}  // namespace obscura::tests
