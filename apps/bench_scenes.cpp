#include "obscura/apps/bench_scenes.h"

#include <algorithm>
#include <cmath>

#include "obscura/apps/demo_random.h"
#include "obscura/engine/cluster_mesh.h"
#include "obscura/raster/view.h"

namespace obscura::apps {
namespace {

using raster::kSub;

// Views, once the meshes stay where they are, and the one material.
void finish(BenchScene& scene) {
  scene.materials.resize(1);
  scene.materials[0].baseColor = {0.7f, 0.6f, 0.5f, 1};
  for (const engine::Mesh& mesh : scene.meshes) scene.views.push_back(mesh.view());
}

// Vertices of the grid, in sub-pixels from the image's upper left corner. It begins 3/8 of a cell to the left of it and
// 5/8 above: neither pixels nor tiles begin where cells do.
struct Grid {
  int cell, columns, rows;

  Grid(int width, int height, int cellPx)
      : cell(cellPx),
        columns((width * 8 + cell * 3 - 1) / (cell * 8) + 1),
        rows((height * 8 + cell * 5 - 1) / (cell * 8) + 1) {}

  // In [-0.3, 0.3] cells.
  int64_t jitter(int column, int row, uint64_t seed) const {
    const int64_t most = int64_t(cell) * kSub * 3 / 10;
    return int64_t(hash(column, row, seed) % uint64_t(2 * most + 1)) - most;
  }
  int64_t x(int column, int row) const {
    return int64_t(column) * cell * kSub - cell * (kSub * 3 / 8) +
           (column > 0 && column < columns ? jitter(column, row, 1) : 0);
  }
  int64_t y(int column, int row) const {
    return int64_t(row) * cell * kSub - cell * (kSub * 5 / 8) + (row > 0 && row < rows ? jitter(column, row, 2) : 0);
  }
  double zView(int column, int row) const { return 10 + double(hash(column, row, 3) >> 44) * 0x1p-20; }  // a float

 private:
  static uint64_t hash(int column, int row, uint64_t seed) {
    return scramble(scramble(uint64_t(row) << 32 | uint64_t(column)) + seed * 0x9E3779B97F4A7C15ull);
  }
};

// Twice the area of the smallest of triangles (p, q, r) and (p, r, s).
double leastArea(const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r, const glm::dvec2& s) {
  const auto area = [&](const glm::dvec2& a, const glm::dvec2& b) {
    return (a.x - p.x) * (b.y - p.y) - (b.x - p.x) * (a.y - p.y);
  };
  return std::min(area(q, r), area(r, s));
}

// Rows of quads from `first` to `last`, the latter not included.
engine::Mesh gridMesh(const Grid& grid, int first, int last, int width, int height, bool perspective) {
  engine::Mesh mesh;
  const int across = grid.columns + 1;
  std::vector<glm::dvec2> corners;  // pixels from the image's centre, y up
  for (int row = first; row <= last; ++row)
    for (int column = 0; column < across; ++column) {
      const glm::dvec2 at(double(grid.x(column, row)) / kSub - width * 0.5,
                          height * 0.5 - double(grid.y(column, row)) / kSub);
      const double z = grid.zView(column, row), scale = perspective ? z : 1;
      corners.push_back(at);
      mesh.positions.emplace_back(float(at.x * scale), float(at.y * scale), float(-z));
    }
  for (int row = 0; row < last - first; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const uint32_t a = uint32_t(row * across + column), b = a + uint32_t(across), c = b + 1, d = a + 1;
      // A quad that is not convex has one diagonal inside; the better one always leaves triangles of some area.
      const bool ac = leastArea(corners[a], corners[b], corners[c], corners[d]) >=
                      leastArea(corners[b], corners[c], corners[d], corners[a]);
      const uint32_t corner[] = {ac ? a : b, ac ? b : c, ac ? c : d, ac ? a : b, ac ? c : d, ac ? d : a};
      mesh.indices.insert(mesh.indices.end(), std::begin(corner), std::end(corner));
    }
  return mesh;
}

// A face of the cube, n x n quads, pushed out to the lumpy ball; faces share their border vertices bit for bit.
void addFace(engine::Mesh& mesh, int face, int n) {
  const int axis = face % 3, side = face < 3 ? 1 : -1;
  const uint32_t first = uint32_t(mesh.positions.size());
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      glm::dvec3 p;
      p[axis] = side;
      p[(axis + 1) % 3] = double(2 * i - n) / n;
      p[(axis + 2) % 3] = double(2 * j - n) / n;
      p = unit(p);
      mesh.positions.emplace_back(p * (1 + 0.12 * fractalNoise(p * 3.0, 4, 7)));
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const uint32_t a = first + uint32_t(j * (n + 1) + i), b = a + 1, c = b + uint32_t(n + 1), d = c - 1;
      const uint32_t q[] = {a, side > 0 ? b : d, c, a, c, side > 0 ? d : b};
      mesh.indices.insert(mesh.indices.end(), std::begin(q), std::end(q));
    }
}

// The box's sides and top, or with a flat one a plane.
void addBox(engine::Mesh& mesh, const glm::dvec3& lo, const glm::dvec3& hi) {
  const auto quad = [&](const glm::dvec3& corner, const glm::dvec3& along, const glm::dvec3& up) {
    const uint32_t first = uint32_t(mesh.positions.size());
    const glm::dvec3 normal = cross(along, up);
    const double length = std::sqrt(dot(normal, normal));
    for (const glm::dvec3& p : {corner, corner + along, corner + along + up, corner + up}) {
      mesh.positions.emplace_back(p);
      mesh.normals.emplace_back(normal / length);
    }
    for (const uint32_t k : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(first + k);
  };
  const glm::dvec3 x(hi.x - lo.x, 0, 0), y(0, hi.y - lo.y, 0), z(0, 0, hi.z - lo.z);
  quad(lo + y + z, x, -z);
  if (!(hi.y > lo.y)) return;
  quad(lo + z, x, y);
  quad(lo + x, -x, y);
  quad(lo + x + z, -z, y);
  quad(lo, z, y);
}

// A turn about any axis by any angle, both at random, times `scale`.
glm::dmat4 turned(Random& random, double scale) {
  const glm::dvec3 axis = random.direction();
  const double c = random.in(-1, 1), s = std::sqrt(1 - c * c);
  glm::dmat4 m(1.0);
  for (int k = 0; k < 3; ++k) {
    glm::dvec3 e(0);
    e[k] = 1;
    m[k] = glm::dvec4((e * c + cross(axis, e) * s + axis * (axis[k] * (1 - c))) * scale, 0);
  }
  return m;
}

}  // namespace

BenchScene makeGrid(int width, int height, int cell, raster::Projection projection) {
  constexpr int kMostQuads = 500000;
  const bool perspective = projection == raster::Projection::Perspective;
  const Grid grid(width, height, cell);
  BenchScene scene;
  const int band = std::max(1, kMostQuads / grid.columns);
  for (int row = 0; row < grid.rows; row += band) {
    scene.meshes.push_back(gridMesh(grid, row, std::min(row + band, grid.rows), width, height, perspective));
    engine::clusterMesh(scene.meshes.back());
  }
  finish(scene);
  for (const raster::MeshView& view : scene.views) {
    raster::Instance instance;
    instance.mesh = &view;
    scene.instances.push_back(instance);
    scene.triangles += view.triangleCount();
  }
  // x / zView is in pixels from the centre, or x is.
  scene.camera = raster::orthographic(width * 0.5, height * 0.5, 1, 100);
  scene.camera.projection = projection;
  return scene;
}

engine::Mesh makeBall(uint32_t triangles) {
  const int n = std::max(1, int(std::sqrt(triangles / 12.0) + 0.5));
  engine::Mesh mesh;
  for (int face = 0; face < 6; ++face) addFace(mesh, face, n);
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    const uint32_t* v = &mesh.indices[t];
    const glm::dvec3 p(mesh.positions[v[0]]), q(mesh.positions[v[1]]), r(mesh.positions[v[2]]);
    for (int k = 0; k < 3; ++k) mesh.normals[v[k]] += glm::vec3(cross(q - p, r - p));
  }
  engine::clusterMesh(mesh);
  return mesh;
}

BenchScene makeField(uint64_t triangles, bool unique, double aspect) {
  BenchScene scene;
  const engine::Mesh ball = makeBall(uint32_t(std::min<uint64_t>(triangles, kBallTriangles)));
  const uint32_t each = uint32_t(ball.indices.size() / 3);
  const int count = triangles <= kBallTriangles ? 1 : int((triangles + each / 2) / each);
  scene.meshes.assign(unique ? size_t(count) : 1, ball);
  finish(scene);
  scene.triangles = uint64_t(count) * each;

  int side = 1;
  while (side * side < count) ++side;
  Random random(11);
  for (int k = 0; k < count; ++k) {
    raster::Instance instance;
    instance.mesh = &scene.views[unique ? size_t(k) : 0];
    instance.worldFromObject = turned(random, random.in(0.8, 1.2));
    const double x = random.in(-0.2, 0.2), y = random.in(-0.2, 0.2), z = random.in(-0.2, 0.2);
    instance.worldFromObject[3] =
        glm::dvec4((k % side - (side - 1) * 0.5) * 2.2 + x, y, (k / side - (side - 1) * 0.5) * 2.2 + z, 1);
    scene.instances.push_back(instance);
  }
  const double extent = 2.2 * side;
  scene.camera = raster::perspective(0.8, aspect, 0.05, 0);
  scene.camera.viewFromWorld = raster::lookAt({0, 0.6 * extent + 0.5, extent + 0.5}, {0, 0, 0}, {0, 1, 0});
  return scene;
}

engine::Scene makeGround(int boxes) {
  engine::Scene scene;
  scene.materials.resize(2);
  scene.materials[0].baseColor = {0.7f, 0.6f, 0.5f, 1};
  scene.materials[1].baseColor = {0.8f, 0.3f, 0.2f, 1};
  scene.materialNames = {"ground", "boxes"};
  scene.meshes.resize(2);
  scene.bounds = {{-40, 0, -40}, {40, 2, 40}, false};
  addBox(scene.meshes[0], {-40, 0, -40}, {40, 0, 40});
  Random random(5);
  for (int k = 0; k < boxes; ++k) {
    const double x = random.in(-5, 4), z = random.in(-5, 3);
    addBox(scene.meshes[1], {x, 0, z}, {x + random.in(0.5, 1.5), random.in(0.5, 1.5), z + random.in(0.5, 1.5)});
  }
  scene.meshes[1].material = 1;
  scene.nodeNames = {"ground", "boxes"};
  for (uint32_t k = 0; k < 2; ++k) {
    engine::clusterMesh(scene.meshes[k]);
    if (!scene.meshes[k].indices.empty()) scene.instances.push_back({k, k, glm::dmat4(1)});
  }
  engine::SceneCamera camera;
  camera.name = "across";
  camera.worldFromView[1] = {0, 0.8, -0.6, 0};  // looks down by 37 degrees
  camera.worldFromView[2] = {0, 0.6, 0.8, 0};
  camera.worldFromView[3] = {0, 6, 8, 1};
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace obscura::apps
