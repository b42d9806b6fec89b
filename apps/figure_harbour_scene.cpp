#include "obscura/apps/figure_harbour_scene.h"

#include <cmath>

#include "obscura/apps/figure_shapes.h"
#include "obscura/apps/glb_builder.h"

namespace obscura::apps {
namespace {

using glm::dvec3;
using raster::exactCos;
using raster::exactSin;

constexpr double kTau = 6.283185307179586;

class Harbour {
 public:
  GlbBuilder b;

  GlbScene make() {
    addWaterAndQuay();
    addHouses();
    addBoats();
    addGoods();
    addCrane();
    b.lookAt({-10.5, 6.0, 16.5}, {1.0, 2.6, -1.5}, 0.62);
    b.scene.camera.zFar = 200;
    return std::move(b.scene);
  }

 private:
  static constexpr double kQuay = 1.2;  // its height

  int named(const char* name, int node) {
    b.scene.nodes[size_t(node)].name = name;
    return node;
  }
  int paint(const char* name, dvec3 color) { return b.addMaterial(name, color); }

  void addWaterAndQuay() {
    const GlbMesh water = makeSurface("water", 120, 120, false, [](double u, double v) {
      const double x = 80 * (u - 0.5), z = 60 * (v - 0.35);
      return dvec3(x, 0.05 * fractalNoise({x * 0.7, 0, z * 1.1}, 2, 901), z);
    });
    named("water", b.place(b.addMesh(water, paint("water", {0.10, 0.21, 0.24})), dvec3(0)));
    const int stone = paint("quay", {0.42, 0.39, 0.34}), coping = paint("coping", {0.52, 0.49, 0.44});
    b.place(b.addMesh(makeBox({40, 1.5, 14}), stone), {0, kQuay - 1.5, -14.4});
    const int block = b.addMesh(makeBox({0.96, 0.12, 0.35}), coping);
    for (int i = -14; i < 15; ++i) b.place(block, {2.0 * i, kQuay + 0.03, -0.5});
    const int iron = paint("iron", {0.10, 0.10, 0.11});
    const int bollard = b.addMesh(makeTurned("bollard", 20, 12, [](double v) {
                                    const double r = v < 0.3 ? 0.26 * exactSin(kTau / 4 * v / 0.3) : 0.17 + 0.05 * (v - 0.3);
                                    return glm::dvec2(r, 0.6 * (1 - v));
                                  }),
                                  iron);
    for (int i = -3; i < 5; ++i) b.place(bollard, {4.0 * i + 1, kQuay + 0.12, -0.55});
  }

  // A body, a gable roof with eaves, windows and a door.
  void addHouse(dvec3 at, dvec3 half, int wall, int roof, int storeys) {
    b.place(b.addMesh(makeBox(half), wall), at + dvec3(0, half.y, 0));
    const double rise = half.x * 0.9, eave = 0.25;
    const dvec3 top{0, 2 * half.y + rise, 0}, left{-half.x - eave, 2 * half.y - eave * 0.9, 0}, right{half.x + eave, 2 * half.y - eave * 0.9, 0};
    const dvec3 front{0, 0, half.z + eave}, back{0, 0, -half.z - eave};
    for (const GlbMesh& side : {makeQuad(left + back, left + front, top + front, top + back), makeQuad(right + front, right + back, top + back, top + front)}) {
      const int mesh = b.addMesh(side, roof);
      b.place(mesh, at);
    }
    const dvec3 a{-half.x, 2 * half.y, half.z}, c{half.x, 2 * half.y, half.z}, d{0, 2 * half.y + rise, half.z};
    b.place(b.addMesh(makeQuad(a, c, mix(c, d, 0.999), d), wall), at);
    b.material(roof).doubleSided = true;
    for (int storey = 0; storey < storeys; ++storey)
      for (int k = -1; k <= 1; ++k) {
        const double y = 0.9 + storey * 1.9, x = k * half.x * 0.58;
        if (storey == 0 && k == 0) {
          b.place(door_, at + dvec3(x, 0.85, half.z));
          continue;
        }
        b.place(pane_, at + dvec3(x, y + 0.2, half.z));
        b.place(sill_, at + dvec3(x, y - 0.32, half.z + 0.08));
        b.place(lintel_, at + dvec3(x, y + 0.72, half.z + 0.03));
      }
  }

  void addHouses() {
    const int dark = paint("glass", {0.05, 0.07, 0.09}), trim = paint("trim", {0.72, 0.70, 0.64}), wood = paint("door", {0.20, 0.11, 0.06});
    pane_ = b.addMesh(makeBox({0.32, 0.5, 0.02}), dark);
    sill_ = b.addMesh(makeBox({0.42, 0.05, 0.12}), trim);
    lintel_ = b.addMesh(makeBox({0.40, 0.06, 0.05}), trim);
    door_ = b.addMesh(makeBox({0.45, 0.85, 0.04}), wood);
    const int roofs[] = {paint("tiles", {0.42, 0.16, 0.10}), paint("slate", {0.17, 0.19, 0.22})};
    const dvec3 walls[] = {{0.62, 0.50, 0.34}, {0.55, 0.22, 0.16}, {0.70, 0.66, 0.56}, {0.30, 0.38, 0.42}, {0.66, 0.56, 0.30}, {0.60, 0.36, 0.30}, {0.5, 0.5, 0.46}};
    Random random(31);
    double x = -17;
    for (int i = 0; i < 9; ++i) {
      const double half = random.in(1.7, 2.3);
      const int storeys = 2 + random.below(2);
      const int roof = roofs[random.below(2)];
      const double z = -6.5 + random.in(-0.4, 0.4);
      addHouse({x + half, kQuay, z}, {half, 0.5 + 0.95 * storeys, 2.2}, paint("wall", walls[i % 7]), roof, storeys);
      x += 2 * half + 0.12;
    }
  }

  // Half-width of the hull at s (0 stern ... 1 bow) and depth t (0 gunwale ... 1 keel).
  GlbMesh makeHull() {
    return makeSurface("hull", 48, 20, false, [](double u, double v) {
      // u runs along, from the bow to the stern; v across, from port over the keel to starboard.
      const double s = 1 - u, across = 2 * v - 1, side = across < 0 ? -1 : 1, t = 1 - std::fabs(across);
      const double plan = std::sqrt(clamp01(1 - s * s * s * s)) * (0.82 + 0.18 * smoothstep(0, 0.3, s));
      const double section = std::sqrt(clamp01(1 - t * t * (0.9 + 0.1 * s)));
      const double sheer = 0.25 + 0.55 * (s - 0.35) * (s - 0.35);
      return dvec3(2.2 * (s - 0.45) + 0.35 * s * s * (1 - t), mix(sheer + 0.35, -0.35, t), side * 0.72 * plan * section);
    });
  }

  void addBoats() {
    const dvec3 hulls[] = {{0.16, 0.30, 0.45}, {0.62, 0.60, 0.55}, {0.50, 0.13, 0.10}, {0.13, 0.36, 0.28}};
    const int plank = paint("planks", {0.48, 0.33, 0.19}), mast = paint("mast", {0.42, 0.29, 0.17}), cabinPaint = paint("cabin", {0.70, 0.68, 0.62});
    const int deck = b.addMesh(makeSurface("deck", 48, 4, false, [](double u, double v) {
                                 const double s = 1 - u, plan = std::sqrt(clamp01(1 - s * s * s * s)) * (0.82 + 0.18 * smoothstep(0, 0.3, s));
                                 return dvec3(2.2 * (s - 0.45) + 0.3 * s * s, 0.25 + 0.55 * (s - 0.35) * (s - 0.35) + 0.12, (2 * v - 1) * 0.68 * plan);
                               }),
                               plank);
    b.material(plank).doubleSided = true;
    const int pole = b.addMesh(makeTurned("mast", 12, 2, [](double v) { return glm::dvec2(0.045 + 0.03 * v, 4.4 * (1 - v)); }), mast);
    const int boom = b.addMesh(makeBox({1.0, 0.05, 0.05}), mast), furled = b.addMesh(makeBox({0.85, 0.11, 0.1}), cabinPaint);
    const int cabin = b.addMesh(makeBox({0.45, 0.32, 0.38}), cabinPaint), roof = b.addMesh(makeBox({0.55, 0.04, 0.46}), plank);
    const int bench = b.addMesh(makeBox({0.12, 0.04, 0.55}), plank);
    const struct {
      double x, z, yaw, size;
      int color, kind;  // 0 sailing boat, 1 with a cabin, 2 rowing boat
    } kBoats[] = {{-5.2, 1.6, 0.06, 1.5, 0, 0}, {0.6, 1.5, 3.08, 1.55, 1, 1}, {5.6, 1.7, 0.1, 1.45, 2, 0}, {-2.2, 4.6, 0.7, 0.9, 3, 2}, {3.4, 4.4, 2.5, 0.95, 1, 2},
                  {10.8, 1.9, 3.0, 1.5, 3, 1}};
    for (const auto& boat : kBoats) {
      const int color = paint("hull", hulls[boat.color]);
      b.material(color).doubleSided = true;
      GlbNode node;
      node.name = "boat";
      node.mesh = b.addMesh(makeHull(), color);
      node.translation = {boat.x, 0.1, boat.z};
      node.rotation = {0, exactSin(boat.yaw / 2), 0, exactCos(boat.yaw / 2)};
      node.scale = dvec3(boat.size);
      const int hull = b.addNode(node);
      const auto fit = [&](int mesh, dvec3 at) {
        GlbNode part;
        part.name = "fitting";
        part.mesh = mesh;
        part.translation = at;
        b.addNode(part, hull);
      };
      if (boat.kind == 2) {
        for (const double x : {-0.5, 0.1, 0.6}) fit(bench, {x, 0.38, 0});
        continue;
      }
      fit(deck, dvec3(0));
      if (boat.kind == 0) {
        fit(pole, {0.35, 0.3, 0});
        fit(boom, {-0.6, 1.0, 0});
        fit(furled, {-0.65, 1.12, 0});
        fit(cabin, {0.1, 0.5, 0});
      } else {
        fit(cabin, {-0.1, 0.7, 0});
        fit(roof, {-0.1, 1.04, 0});
        fit(pole, {-0.75, 0.3, 0});
      }
    }
  }

  void addGoods() {
    const dvec3 woods[] = {{0.50, 0.36, 0.20}, {0.42, 0.28, 0.15}, {0.56, 0.44, 0.28}};
    int crate[3], barrel[2];
    for (int k = 0; k < 3; ++k) crate[k] = b.addMesh(makeCrate(), paint("crate", woods[k]));
    for (int k = 0; k < 2; ++k)
      barrel[k] = b.addMesh(makeTurned("barrel", 28, 24, [](double v) {
                              if (v < 0.12) return glm::dvec2(0.27 * v / 0.12, 0.86);
                              const double t = (v - 0.12) / 0.88, hoop = t < 0.06 || std::fabs(t - 0.3) < 0.05 || std::fabs(t - 0.7) < 0.05 || t > 0.94 ? 0.015 : 0;
                              return glm::dvec2(0.29 + 0.09 * exactSin(kTau / 2 * t) + hoop, 0.92 * (1 - t));
                            }),
                            paint("barrel", woods[k]));
    Random random(47);
    const double y = kQuay;
    // Each number is drawn in a statement of its own: compilers differ in the order in which they evaluate arguments.
    const auto put = [&](int mesh, dvec3 at, double yaw, double size) { named("goods", b.place(mesh, at, yaw, dvec3(size))); };
    for (const double pile : {-7.8, -1.2, 3.6, 9.2}) {
      for (int i = 0; i < 3; ++i) {
        const double yaw = random.in(-0.1, 0.1), z = -2.4 + random.in(-0.08, 0.08);
        put(crate[random.below(3)], {pile + 1.06 * i, y + 0.5, z}, yaw, 1);
      }
      for (int i = 0; i < 2; ++i) {
        const double yaw = random.in(-0.2, 0.2);
        put(crate[random.below(3)], {pile + 0.5 + 1.1 * i, y + 1.5, -2.4}, yaw, 1);
      }
      const double yaw = random.in(0, 0.7);
      put(crate[random.below(3)], {pile + 0.3, y + 0.4, -1.35}, yaw, 0.8);
      for (int i = 0; i < 4; ++i) {
        const double x = pile + 2.0 + 0.74 * (i % 2) + random.in(-0.05, 0.05);
        put(barrel[random.below(2)], {x, y, -1.3 - 0.72 * (i / 2)}, 0, 1);
      }
      put(barrel[random.below(2)], {pile + 2.4, y + 0.92, -1.66}, 0, 0.95);
    }
  }

  static GlbMesh makeCrate() {  // a box in a frame of beams
    GlbMesh all = makeBox({0.46, 0.46, 0.46});
    const auto add = [&](dvec3 half, dvec3 at) {
      const GlbMesh beam = makeBox(half);
      const uint32_t first = uint32_t(all.positions.size());
      for (const glm::vec3& p : beam.positions) all.positions.push_back(p + glm::vec3(at));
      all.normals.insert(all.normals.end(), beam.normals.begin(), beam.normals.end());
      all.uvs.insert(all.uvs.end(), beam.uvs.begin(), beam.uvs.end());
      for (const uint32_t i : beam.indices) all.indices.push_back(first + i);
    };
    for (const double a : {-0.44, 0.44})
      for (const double c : {-0.44, 0.44}) {
        add({0.5, 0.06, 0.06}, {0, a, c});
        add({0.06, 0.5, 0.06}, {a, 0, c});
        add({0.06, 0.06, 0.5}, {a, c, 0});
      }
    all.name = "crate";
    return all;
  }

  void addCrane() {
    const int iron = paint("crane", {0.16, 0.20, 0.22});
    const auto beam = [&](dvec3 half, dvec3 at, std::array<double, 4> turn = {0, 0, 0, 1}) {
      GlbNode node;
      node.name = "crane";
      node.mesh = b.addMesh(makeBox(half), iron);
      node.translation = at;
      node.rotation = turn;
      b.addNode(node);
    };
    const double x = 7.6, z = -2.1;
    beam({0.6, 0.3, 0.6}, {x, kQuay + 0.3, z});
    beam({0.22, 2.3, 0.22}, {x, kQuay + 2.6, z});
    // The jib leans over the water.
    beam({0.13, 0.13, 2.6}, {x, kQuay + 5.6, z + 1.6}, {-exactSin(0.17), 0, 0, exactCos(0.17)});
    beam({0.02, 1.4, 0.02}, {x, kQuay + 5.0, z + 3.9});
    named("goods", b.place(b.addMesh(makeCrate(), paint("load", {0.50, 0.36, 0.20})), {x, kQuay + 3.3, z + 3.9}, 0.4, dvec3(0.8)));
  }

  int pane_ = 0, sill_ = 0, lintel_ = 0, door_ = 0;
};

}  // namespace

GlbScene makeHarbourScene() { return Harbour().make(); }

}  // namespace obscura::apps
