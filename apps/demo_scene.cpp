#include "obscura/apps/demo_scene.h"

#include <string>
#include <utility>

#include "obscura/apps/demo_random.h"
#include "obscura/apps/demo_shapes.h"
#include "obscura/apps/demo_tree.h"
#include "obscura/apps/glb_builder.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using glm::dvec3;

constexpr double kTau = 6.283185307179586;

std::array<double, 4> turnAbout(dvec3 axis, double angle) {  // unit axis
  const double s = raster::exactSin(angle / 2);
  return {axis.x * s, axis.y * s, axis.z * s, raster::exactCos(angle / 2)};
}

// Mostly about the vertical: things that stand on the ground, a little tilted.
std::array<double, 4> standing(Random& random, double tilt) {
  const dvec3 lean = random.direction();
  const dvec3 axis = unit(dvec3(0, 1, 0) + tilt * lean);
  return turnAbout(axis, random.in(0, kTau));
}

void addStone(GlbBuilder& b, int group, int mesh, double x, double z, dvec3 scale, double sunk, Random& random) {
  GlbNode node;
  node.name = "stone";
  node.mesh = mesh;
  node.rotation = standing(random, 0.35);
  node.scale = scale;
  node.translation = {x, groundHeight(x, z) + scale.y * (1 - 2 * sunk) * 0.8, z};
  b.addNode(node, group);
}

void addStones(GlbBuilder& b) {
  const int greys[] = {b.addMaterial("granite", {0.40, 0.385, 0.365}), b.addMaterial("slate", {0.25, 0.27, 0.30}),
                       b.addMaterial("limestone", {0.50, 0.455, 0.38})};
  std::vector<int> large, small;
  for (uint64_t i = 0; i < 3; ++i) large.push_back(b.addMesh(makeStone(4, 200 + i), greys[i]));
  for (uint64_t i = 0; i < 4; ++i) small.push_back(b.addMesh(makeStone(2, 300 + i), greys[i % 3]));
  const int group = b.addGroup("stones");
  Random random(5);
  const struct {
    double x, z, radius;
    int mesh;
  } kBoulders[] = {{-2.3, 1.5, 0.95, 0}, {2.7, 1.9, 0.62, 1}, {3.6, 0.9, 0.85, 2}, {-3.9, -1.2, 1.15, 2}};
  for (const auto& s : kBoulders)
    addStone(b, group, large[size_t(s.mesh)], s.x, s.z, dvec3(1.15, 0.8, 1.0) * s.radius, 0.32, random);
  for (int i = 0; i < 56; ++i) {
    // Rubble gathers around the boulders; some lies anywhere.
    const auto& near = kBoulders[i % 4];
    const bool loose = i >= 36;
    const double angle = random.in(0, kTau), u = random.in(0, 1);
    const double distance = loose ? mix(2.0, 11.0, u) : near.radius * (1.05 + 1.3 * u);
    const double x = (loose ? 0 : near.x) + distance * raster::exactCos(angle);
    const double z = (loose ? 0 : near.z) + distance * raster::exactSin(angle);
    const double t = random.in(0, 1), radius = mix(0.05, 0.30, t * t);
    const double wide = random.in(0.9, 1.4), high = random.in(0.6, 0.9), sunk = random.in(0.25, 0.45);
    const int mesh = small[size_t(random.below(4))];
    addStone(b, group, mesh, x, z, dvec3(wide, high, 1) * radius, sunk, random);
  }
}

void addTree(GlbBuilder& b) {
  const int barkTexture = b.addTexture(makeBarkTexture()), leafTexture = b.addTexture(makeLeafTexture());
  const int bark = b.addMaterial("bark", {0.52, 0.38, 0.27}, barkTexture);
  const int greens[] = {b.addMaterial("leaf, dark", {0.17, 0.32, 0.075}, leafTexture),
                        b.addMaterial("leaf", {0.28, 0.45, 0.10}, leafTexture),
                        b.addMaterial("leaf, young", {0.46, 0.53, 0.12}, leafTexture)};
  std::vector<int> clumps;
  for (uint64_t i = 0; i < 3; ++i) {
    b.scene.materials[size_t(greens[i])].alphaCutoff = 0.5;
    b.scene.materials[size_t(greens[i])].doubleSided = true;
    clumps.push_back(b.addMesh(makeLeafClump(14, 400 + i), greens[i]));
  }
  Tree tree = makeTree(7);
  const int wood = b.addGroup("tree", b.addMesh(std::move(tree.bark), bark));
  b.scene.nodes[size_t(wood)].translation = {0, groundHeight(0, 0) - 0.25, 0};
  Random random(9);
  for (const LeafSite& site : tree.leaves) {
    GlbNode node;
    node.name = "leaves";
    const double pick = random.in(0, 1);
    node.mesh = clumps[pick < 0.45 ? 0 : pick < 0.85 ? 1 : 2];
    node.translation = site.position;
    node.rotation = standing(random, 0.5);
    node.scale = dvec3(site.size);
    b.addNode(node, wood);
  }
}

void addGrass(GlbBuilder& b) {
  const int material = b.addMaterial("grass", {0.30, 0.42, 0.13});
  b.scene.materials[size_t(material)].doubleSided = true;
  const int tufts[] = {b.addMesh(makeGrassTuft(13, 500), material), b.addMesh(makeGrassTuft(17, 501), material)};
  const int group = b.addGroup("grass");
  Random random(13);
  for (int placed = 0; placed < 260;) {
    const double angle = random.in(0, kTau), distance = mix(1.0, 13.0, std::sqrt(random.in(0, 1)));
    const double x = distance * raster::exactCos(angle), z = distance * raster::exactSin(angle);
    if (noise({x * 0.45, 0, z * 0.45}, 41) > 0.25 * random.in(-1, 1)) continue;  // not where the ground is dry
    GlbNode node;
    node.name = "tuft";
    node.mesh = tufts[random.below(2)];
    node.translation = {x, groundHeight(x, z) - 0.02, z};
    node.rotation = standing(random, 0.12);
    node.scale = dvec3(random.in(0.8, 1.5));
    b.addNode(node, group);
    ++placed;
  }
}

}  // namespace

GlbScene makeDemoScene() {
  GlbBuilder b;
  const int soil = b.addMaterial("ground", dvec3(1), b.addTexture(makeSoilTexture()));
  b.addGroup("ground", b.addMesh(makeGround(), soil));
  addTree(b);
  addStones(b);
  addGrass(b);
  GlbCamera& camera = b.scene.camera;
  camera.name = "view";
  camera.eye = {3.2, groundHeight(3.2, 12.6) + 1.9, 12.6};
  camera.target = {0.0, 2.8, 0};
  camera.yFov = 0.6;
  camera.zFar = 60;
  return std::move(b.scene);
}

}  // namespace obscura::apps
