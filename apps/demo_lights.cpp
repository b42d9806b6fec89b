#include "obscura/apps/demo_lights.h"

#include <cmath>

#include "obscura/apps/demo_shapes.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using glm::dvec3;

constexpr double kPi = 3.141592653589793;

GlbMesh makeBox() {  // around the origin, 2 a side
  GlbMesh m;
  m.name = "box";
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-1.0f, 1.0f}) {
      glm::vec3 n(0), u(0), v(0);
      n[axis] = side, u[(axis + 1) % 3] = side, v[(axis + 2) % 3] = 1;
      const uint32_t first = uint32_t(m.positions.size());
      for (const glm::vec3& p : {n - u - v, n + u - v, n + u + v, n - u + v}) m.positions.push_back(p), m.normals.push_back(n);
      for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) m.indices.push_back(first + k);
    }
  return m;
}

// The outline (radius, height), turned around the y axis; its normals are those of the outline.
GlbMesh makeTurned(const char* name, const std::vector<glm::dvec2>& outline, int parts) {
  GlbMesh m;
  m.name = name;
  const size_t rows = outline.size();
  for (size_t i = 0; i < rows; ++i) {
    const glm::dvec2 along = outline[i + 1 < rows ? i + 1 : i] - outline[i > 0 ? i - 1 : i];
    const double length = std::sqrt(along.x * along.x + along.y * along.y);
    for (int k = 0; k <= parts; ++k) {
      const double c = raster::exactCos(2 * kPi * k / parts), s = raster::exactSin(2 * kPi * k / parts);
      m.positions.push_back(glm::vec3(dvec3(outline[i].x * c, outline[i].y, -outline[i].x * s)));
      m.normals.push_back(glm::vec3(dvec3(along.y * c, -along.x, -along.y * s) / length));
    }
  }
  const uint32_t width = uint32_t(parts) + 1;
  for (uint32_t i = 0; i + 1 < rows; ++i)
    for (uint32_t k = 0; k + 1 < width; ++k) {
      const uint32_t at = i * width + k;
      for (uint32_t v : {at, at + 1, at + width, at + 1, at + width + 1, at + width}) m.indices.push_back(v);
    }
  return m;
}

GlbMesh makeBall() {
  std::vector<glm::dvec2> outline;
  for (int i = 0; i <= 24; ++i) outline.push_back({raster::exactSin(kPi * i / 24), -raster::exactCos(kPi * i / 24)});
  return makeTurned("ball", outline, 48);
}

GlbMesh makeColumn() {
  return makeTurned("column", {{0.34, 0}, {0.34, 0.15}, {0.26, 0.25}, {0.25, 1.3}, {0.22, 2.35}, {0.34, 2.5}, {0.34, 2.65}}, 32);
}

class Builder {
 public:
  GlbScene scene;

  int material(const char* name, dvec3 color) {
    GlbMaterial m;
    m.name = name;
    m.baseColor = color;
    scene.materials.push_back(m);
    return int(scene.materials.size()) - 1;
  }
  GlbNode& place(GlbMesh mesh, int material, dvec3 at, dvec3 scale = dvec3(1)) {
    mesh.material = material;
    GlbNode& node = root(mesh.name.c_str(), at);
    node.mesh = int(scene.meshes.size());
    node.scale = scale;
    scene.meshes.push_back(std::move(mesh));
    return node;
  }
  GlbNode& root(const char* name, dvec3 at) {
    scene.roots.push_back(int(scene.nodes.size()));
    GlbNode& node = scene.nodes.emplace_back();
    node.name = name;
    node.translation = at;
    return node;
  }
  void light(const GlbLight& light, dvec3 at, std::array<double, 4> rotation) {
    GlbNode& node = root(light.name.c_str(), at);
    node.light = int(scene.lights.size());
    node.rotation = rotation;
    scene.lights.push_back(light);
  }
};

// Turns -z down by `down` and then to the right by `right`, radians.
std::array<double, 4> aimed(double right, double down) {
  const double cx = raster::exactCos(down / 2), sx = -raster::exactSin(down / 2), cy = raster::exactCos(right / 2), sy = -raster::exactSin(right / 2);
  return {cy * sx, sy * cx, -sy * sx, cy * cx};
}

}  // namespace

GlbScene makeLightsScene() {
  Builder b;
  const int floor = b.material("floor", {0.62, 0.6, 0.55}), white = b.material("white", {0.8, 0.8, 0.78}), red = b.material("red", {0.75, 0.12, 0.08});
  const int stone = b.material("stone", {0.45, 0.43, 0.4}), blue = b.material("blue", {0.15, 0.3, 0.65});
  b.place(makeBox(), floor, {0, -0.1, 0}, {6, 0.1, 5});
  b.place(makeBox(), red, {-4.1, 1.5, -0.5}, {0.1, 1.5, 3});
  b.place(makeBox(), white, {0, 1.7, -3.6}, {4.2, 1.7, 0.1});
  for (double x : {-2.4, -0.8, 0.8, 2.4}) b.place(makeColumn(), white, {x, 0, -2.4});
  b.place(makeBox(), white, {0, 2.75, -2.4}, {2.9, 0.1, 0.4});
  b.place(makeStone(4, 200), stone, {2.6, 0.45, 0.6}, dvec3(0.75));
  b.place(makeStone(3, 77), stone, {-2.9, 0.25, 1.6}, dvec3(0.45));
  b.place(makeBall(), white, {-0.6, 0.6, 0.9}, dvec3(0.6));
  b.place(makeBall(), blue, {0.7, 0.35, 1.7}, dvec3(0.35));
  b.place(makeBall(), red, {-1.6, 0.3, 2}, dvec3(0.3));
  b.light({"sun", "directional", {1, 0.82, 0.62}, 2.2}, dvec3(0), aimed(-0.85, 0.5));
  b.light({"lamp", "point", {1, 0.55, 0.2}, 2.6, 5}, {-0.2, 0.45, 2.3}, {0, 0, 0, 1});
  b.light({"spot", "spot", {0.5, 0.75, 1}, 60, 12, 0.2, 0.33}, {4.2, 4.6, 2.6}, aimed(-0.667, 1.07));
  b.scene.camera.name = "view";
  b.scene.camera.eye = {3.6, 3.4, 9};
  b.scene.camera.target = {-0.3, 0.7, -0.4};
  b.scene.camera.yFov = 0.62;
  return b.scene;
}

}  // namespace obscura::apps
