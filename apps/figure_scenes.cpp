#include "obscura/apps/figure_scenes.h"

#include <algorithm>
#include <cmath>

#include "obscura/apps/figure_shapes.h"
#include "obscura/apps/glb_builder.h"

namespace obscura::apps {
namespace {

using glm::dvec3;
using raster::exactCos;
using raster::exactSin;

constexpr double kTau = 6.283185307179586;

// How deep the urn is carved at angle u (turns) and height t, 0 ... 1.
double carving(double u, double t) {
  const double around = kTau * u;
  const auto within = [&](double lo, double hi) { return smoothstep(lo, lo + 0.012, t) * (1 - smoothstep(hi - 0.012, hi, t)); };
  // Flutes below, a lattice of lozenges with a knob in each around the belly, zigzags on the shoulder, rings at the neck.
  const double flute = smoothstep(0.1, 0.8, std::fabs(exactSin(14 * around))) * within(0.05, 0.30);
  const double a = exactSin(9 * around + 26 * t), b = exactSin(9 * around - 26 * t);
  const double cell = std::min(std::fabs(a), std::fabs(b));
  const double lattice = smoothstep(0.2, 0.5, cell) * (1 - 0.8 * smoothstep(0.68, 0.9, cell)) * within(0.34, 0.62);
  const double fold = std::fabs(18 * u - std::floor(18 * u) - 0.5) * 2;  // 0 ... 1 ... 0
  const double zigzag = smoothstep(0.25, 0.4, std::fabs((t - 0.66) / 0.11 - fold * 0.6 - 0.2) * 4) * within(0.65, 0.77);
  const double rings = smoothstep(-0.2, 0.4, exactSin(kTau * (t - 0.8) / 0.035)) * within(0.80, 0.925);
  return flute + lattice + zigzag + rings;
}

double profileOf(double t) {  // radius of the urn by height
  const double belly = exactSin(kTau / 2 * clamp01((t + 0.05) / 0.95));
  const double foot = 0.42 * (1 - smoothstep(0.0, 0.10, t)), lip = 0.22 * smoothstep(0.92, 0.97, t);
  return 0.30 + 0.58 * belly * belly + 0.35 * foot + lip - 0.06 * smoothstep(0.7, 0.9, t);
}

}  // namespace

GlbScene makeCarvedScene() {
  GlbBuilder b;
  const int stone = b.addMaterial("stone", {0.6, 0.3, 0.3});
  constexpr double kDeep = 0.11;
  const GlbMesh urn = makeSurface("urn", 360, 220, true, [](double u, double v) {
    // The last rows close the top: inwards, and down into it.
    const double t = 1 - std::max(0.0, v - 0.06) / 0.94;
    const double inside = std::min(1.0, v / 0.06);
    const double r = v < 0.06 ? profileOf(1) * inside : profileOf(t) - kDeep * carving(u, t);
    const double y = 2 * t - 0.08 * (1 - smoothstep(0.5, 1.0, inside));
    return dvec3(r * exactSin(kTau * u), y, r * exactCos(kTau * u));
  });
  b.place(b.addMesh(urn, stone), {0, 0, 0});
  b.place(b.addMesh(makeBox({1.0, 0.15, 1.0}), stone), {0, -0.15, 0}, 0.5);
  b.lookAt({1.3, 1.75, 4.4}, {0, 0.92, 0}, 0.54);
  return std::move(b.scene);
}

GlbScene makeCorridorScene(bool door) {
  GlbBuilder b;
  const int plaster = b.addMaterial("plaster", {0.56, 0.54, 0.47}), tiles = b.addMaterial("tiles", {0.36, 0.24, 0.17});
  const int ceiling = b.addMaterial("ceiling", {0.62, 0.62, 0.60}), wood = b.addMaterial("wood", {0.42, 0.24, 0.12});
  const int green = b.addMaterial("doors", {0.16, 0.30, 0.28}), frame = b.addMaterial("frame", {0.42, 0.38, 0.28});
  constexpr double kHalf = 1.5, kHigh = 2.6, kNear = -1.5, kFar = -18;  // of the corridor
  const int corridor = b.addGroup("corridor");
  const auto put = [&](GlbMesh mesh, int material, dvec3 at) {
    GlbNode node;
    node.name = "corridor";
    node.mesh = b.addMesh(std::move(mesh), material);
    node.translation = at;
    b.addNode(node, corridor);
  };
  put(makeQuad({-kHalf, 0, kNear}, {kHalf, 0, kNear}, {kHalf, 0, kFar}, {-kHalf, 0, kFar}), tiles, dvec3(0));
  put(makeQuad({-kHalf, kHigh, kFar}, {kHalf, kHigh, kFar}, {kHalf, kHigh, kNear}, {-kHalf, kHigh, kNear}), ceiling, dvec3(0));
  put(makeQuad({-kHalf, 0, kNear}, {-kHalf, 0, kFar}, {-kHalf, kHigh, kFar}, {-kHalf, kHigh, kNear}), plaster, dvec3(0));
  put(makeQuad({kHalf, 0, kFar}, {kHalf, 0, kNear}, {kHalf, kHigh, kNear}, {kHalf, kHigh, kFar}), plaster, dvec3(0));
  put(makeQuad({-kHalf, 0, kFar}, {kHalf, 0, kFar}, {kHalf, kHigh, kFar}, {-kHalf, kHigh, kFar}), plaster, dvec3(0));
  for (int k = 0; k < 4; ++k)
    for (const double side : {-1.0, 1.0}) {
      const double z = -5.6 - 3.2 * k;
      put(makeBox({0.05, 1.02, 0.5}), green, {side * (kHalf - 0.03), 1.02, z});
      put(makeBox({0.09, 1.12, 0.06}), frame, {side * (kHalf - 0.04), 1.1, z - 0.56});
      put(makeBox({0.09, 1.12, 0.06}), frame, {side * (kHalf - 0.04), 1.1, z + 0.56});
    }
  put(makeBox({0.55, 1.05, 0.05}), green, {0, 1.05, kFar + 0.05});
  put(makeBox({0.3, 0.35, 0.3}), wood, {-1.1, 0.35, -8});
  if (door) {
    const int post = b.addMesh(makeBox({0.09, 1.15, 0.1}), frame), wall = b.addMesh(makeBox({0.8, 1.6, 0.08}), plaster);
    const int lintel = b.addMesh(makeBox({0.68, 0.09, 0.1}), frame), above = b.addMesh(makeBox({0.7, 0.4, 0.08}), plaster);
    const int leaf = b.addMesh(makeBox({0.4, 1.06, 0.03}), wood), knob = b.addMesh(makeBall(0.045, 16), frame);
    for (const double side : {-1.0, 1.0}) {
      b.place(post, {side * 0.62, 1.12, -1.5});
      b.place(wall, {side * 1.5, 1.2, -1.5});
    }
    b.place(lintel, {0, 2.28, -1.5});
    b.place(above, {0, 2.72, -1.5});
    // Ajar, towards the eye; hinged at the left post.
    const double turn = -1.95, s = exactSin(turn), c = exactCos(turn);
    b.place(leaf, dvec3(-0.5, 1.07, -1.42) + 0.4 * dvec3(c, 0, -s), turn);
    b.place(knob, dvec3(-0.5, 1.0, -1.42) + 0.72 * dvec3(c, 0, -s) + 0.07 * dvec3(s, 0, c));
  }
  b.lookAt({0.2, 1.5, 0.9}, {0.06, 1.30, -6}, 0.80);
  b.scene.camera.zFar = 60;
  return std::move(b.scene);
}

}  // namespace obscura::apps
