// Scenes that the benchmarks make for themselves, the same bytes everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "obscura/engine/scene.h"
#include "obscura/raster/draw.h"

namespace obscura::apps {

// Meshes with their clusters, and a draw list that points into them. Can be moved, not copied.
struct BenchScene {
  std::vector<engine::Mesh> meshes;
  std::vector<raster::MeshView> views;
  std::vector<raster::Material> materials;
  std::vector<raster::Instance> instances;
  raster::Camera camera;
  uint64_t triangles = 0;  // of all instances

  BenchScene() = default;
  BenchScene(BenchScene&&) = default;
  BenchScene& operator=(BenchScene&&) = default;
  raster::DrawList list() const { return {instances, materials, {}}; }
};

// Quads of about cell x cell pixels, two triangles each, that cover a width x height image: every pixel exactly once.
// Inner vertices lie up to 0.3 cells from their place on the grid, in x and in y, at whole sub-pixels, which the
// rasterizer's snapping hits exactly in images of up to kMostGridSize pixels a side. Depths lie in [10, 11]. At most
// some 1,000,000 triangles a mesh; meshes share their border vertices bit for bit.
constexpr int kMostGridSize = 4096;
BenchScene makeGrid(int width, int height, int cell, raster::Projection projection);

// A closed lumpy ball of radius about 1 and the number of triangles 12 n^2 that is nearest to the one asked for.
engine::Mesh makeBall(uint32_t triangles);

// A field of balls, turned at random, that a camera looks across. Up to kBallTriangles it is one ball of about that
// many triangles, beyond that as many balls of about kBallTriangles as it takes: instances of one mesh, or (`unique`)
// each with a copy of its own. Both draw the same image.
constexpr uint32_t kBallTriangles = 200000;
BenchScene makeField(uint64_t triangles, bool unique, double aspect);

// A plane of 80 x 80 units with `boxes` boxes about 1 unit high, and a camera 6 units above it: mostly open ground.
engine::Scene makeGround(int boxes);

}  // namespace obscura::apps
