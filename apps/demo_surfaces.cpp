#include "obscura/apps/demo_surfaces.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "obscura/apps/demo_random.h"
#include "obscura/apps/demo_shapes.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using glm::dvec3;

GlbMesh makeFloor(float half) {
  GlbMesh m;
  m.name = "floor";
  m.positions = {{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
  m.normals.assign(4, {0, 1, 0});
  m.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  m.indices = {0, 1, 2, 0, 2, 3};
  return m;
}

int addMaterial(GlbScene& scene, const char* name, dvec3 color) {
  GlbMaterial m;
  m.name = name;
  m.baseColor = color;
  scene.materials.push_back(m);
  return int(scene.materials.size()) - 1;
}

GlbNode& addRoot(GlbScene& scene, const char* name, dvec3 translation) {
  scene.roots.push_back(int(scene.nodes.size()));
  GlbNode& node = scene.nodes.emplace_back();
  node.name = name;
  node.translation = translation;
  return node;
}

void lookAt(GlbScene& scene, dvec3 eye, dvec3 target) {
  scene.camera.name = "view";
  scene.camera.eye = eye;
  scene.camera.target = target;
  scene.camera.yFov = 0.5;
  scene.camera.zFar = 100;
}

}  // namespace

GlbScene makeImplicitScene() {
  GlbScene scene;
  const int floor = addMaterial(scene, "floor", {0.7, 0.68, 0.62}), stone = addMaterial(scene, "stone", {0.4, 0.385, 0.365});
  const char* const names[] = {"red", "green", "blue", "yellow", "white"};
  const dvec3 colors[] = {{0.7, 0.15, 0.1}, {0.2, 0.55, 0.2}, {0.15, 0.3, 0.7}, {0.8, 0.6, 0.1}, {0.8, 0.8, 0.8}};
  for (int k = 0; k < 5; ++k) addMaterial(scene, names[k], colors[k]);
  scene.meshes = {makeFloor(6), makeStone(3, 200)};
  scene.meshes[0].material = floor;
  scene.meshes[1].material = stone;

  addRoot(scene, "floor", dvec3(0)).mesh = 0;
  addRoot(scene, "sphere", {-2.4, 0, 0.9}).extras = R"({"obscura_implicit": {"type": "sphere", "radius": 1, "material": 2}})";
  GlbNode& box = addRoot(scene, "box", {0.1, 0.25, 1.7});
  box.extras = R"({"obscura_implicit": {"type": "box", "size": [1, 0.9, 0.7], "material": 3}})";
  box.rotation = {0.1, 0.3, 0, 0.9486832980505138};
  GlbNode& torus = addRoot(scene, "torus", {1.9, 0.45, 1.3});
  torus.extras = R"({"obscura_implicit": {"type": "torus", "radius": 0.6, "tube": 0.22, "material": 4}})";
  torus.rotation = {0.5, 0, 0, 0.8660254037844386};
  addRoot(scene, "metaballs", {-0.5, 0.5, -1.1}).extras = R"({"obscura_implicit": {"type": "metaballs", "material": 5, "balls": [
    {"center": [-0.7, 0, 0], "radius": 0.6}, {"center": [0.1, 0.2, 0.3], "radius": 0.5}, {"center": [0.5, 0.7, -0.1], "radius": 0.4},
    {"center": [0.7, -0.3, 0.3], "radius": 0.35}]}})";
  addRoot(scene, "gyroid", {2.3, 0.95, -1.6}).extras =
      R"({"obscura_implicit": {"type": "gyroid", "period": 0.9, "thickness": 0.1, "radius": 1, "material": 6}})";
  GlbNode& inside = addRoot(scene, "stone", {-1.75, 0.3, 1.6});
  inside.mesh = 1;
  inside.scale = dvec3(0.5);
  lookAt(scene, {1.5, 4.6, 8.4}, {0, 0.2, 0});
  return scene;
}

GlbScene makeReliefScene() {
  GlbScene scene;
  GlbTexture map;
  map.name = "heights";
  map.width = map.height = 256;
  Random random(11);
  struct Stone {
    double x, y, radius, height;
  };
  std::vector<Stone> stones;
  for (int i = 0; i < 60; ++i) {
    const double x = random.in(0, 256), y = random.in(0, 256), radius = random.in(8, 22);
    stones.push_back({x, y, radius, random.in(0.5, 1)});
  }
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      constexpr double kTurn = 6.283185307179586 / 256;
      double h = 0.15 + 0.07 * raster::exactSin(2 * kTurn * x) + 0.07 * raster::exactCos(3 * kTurn * y);
      for (const Stone& s : stones) {
        double dx = std::fabs(x - s.x), dy = std::fabs(y - s.y);
        dx = std::min(dx, 256 - dx), dy = std::min(dy, 256 - dy);  // the map repeats
        const double inside = 1 - (dx * dx + dy * dy) / (s.radius * s.radius);
        if (inside > 0) h = std::max(h, s.height * std::sqrt(inside));
      }
      map.grey.push_back(uint16_t(std::min(h, 1.0) * 65535 + 0.5));
    }
  scene.textures.push_back(std::move(map));
  const int floor = addMaterial(scene, "stones", {0.6, 0.55, 0.48}), block = addMaterial(scene, "block", {0.7, 0.3, 0.2});
  scene.materials[size_t(floor)].extras = R"({"obscura_height": {"index": 0, "scale": 0.25}})";
  scene.meshes = {makeFloor(3), makeStone(3, 200)};
  scene.meshes[0].material = floor;
  scene.meshes[1].material = block;
  for (glm::vec2& uv : scene.meshes[0].uvs) uv *= 2.0f;
  addRoot(scene, "floor", dvec3(0)).mesh = 0;
  GlbNode& stone = addRoot(scene, "block", {0.4, 0.3, 0.2});
  stone.mesh = 1;
  stone.scale = dvec3(0.5);
  lookAt(scene, {1.2, 1.5, 4.6}, {0, 0, 0.2});
  return scene;
}

GlbScene makeMaterialsScene() {
  GlbScene scene;
  GlbTexture tiles;  // two kinds of stone, polished and rough, and brass between them
  tiles.name = "tiles";
  tiles.width = tiles.height = 64;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool joint = x % 32 < 2 || y % 32 < 2, polished = (x / 32 + y / 32) % 2 == 0;
      const uint8_t metallic = joint ? 255 : 0, roughness = uint8_t(joint ? 80 : polished ? 20 : 230);
      tiles.rgba.insert(tiles.rgba.end(), {0, roughness, metallic, 255});
    }
  scene.textures.push_back(std::move(tiles));
  scene.meshes = {makeFloor(4)};
  for (glm::vec2& uv : scene.meshes[0].uvs) uv *= 4.0f;
  scene.meshes[0].material = addMaterial(scene, "tiles", {0.55, 0.45, 0.3});
  scene.materials[0].metallic = 1, scene.materials[0].gloss = 0;
  addRoot(scene, "floor", dvec3(0)).mesh = 0;
  const struct {
    const char* name;
    double metallic;
    dvec3 color;
  } rows[] = {{"gold", 1, {1, 0.77, 0.34}}, {"half", 0.5, {0.75, 0.2, 0.15}}, {"lacquer", 0, {0.05, 0.2, 0.6}}, {"black", 0, dvec3(0)}};
  for (int row = 0; row < 4; ++row)
    for (int k = 0; k < 6; ++k) {
      const std::string name = rows[row].name + std::to_string(k);
      const int material = addMaterial(scene, name.c_str(), rows[row].color);
      scene.materials[size_t(material)].metallic = rows[row].metallic;
      scene.materials[size_t(material)].roughness = 0.2 * k;
      addRoot(scene, name.c_str(), {1.1 * k - 2.75, 0.48, 1.15 * row - 1.9}).extras =
          R"({"obscura_implicit": {"type": "sphere", "radius": 0.48, "material": )" + std::to_string(material) + "}}";
    }
  lookAt(scene, {0.6, 8, 10}, {0, 0.1, 0});
  return scene;
}

}  // namespace obscura::apps
