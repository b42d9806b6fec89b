// Implicit surfaces: traced into the same visibility buffer as triangles.
#include <catch2/catch.hpp>

#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "obscura/raster/implicit.h"
#include "raster_checks.h"

using namespace obscura::raster;
using namespace obscura::tests;

namespace {

ImplicitSurface sphere(double radius, glm::dvec3 center = glm::dvec3(0), uint32_t material = 0) {
  ImplicitSurface s;
  s.radius = radius;
  s.material = material;
  s.worldFromObject = glm::translate(glm::dmat4(1), center);
  return s;
}

ImplicitSurface shaped(ImplicitShape shape) {
  ImplicitSurface s;
  s.shape = shape;
  switch (shape) {
    case ImplicitShape::Sphere: break;
    case ImplicitShape::Box: s.halfSize = {1, 0.6, 0.8}; break;
    case ImplicitShape::Torus: s.radius = 0.8, s.tube = 0.3; break;
    case ImplicitShape::Metaballs: s.balls = {{{-0.5, 0, 0}, 0.5}, {{0.5, 0.2, 0}, 0.4}, {{0, 0.5, 0.4}, 0.3}}; break;
    case ImplicitShape::Gyroid: s.radius = 1, s.period = 0.9, s.thickness = 0.08; break;
    case ImplicitShape::Function:
      s.radius = 1.2;
      s.function = [](const glm::dvec3& p) { return p.x * p.x + 2 * p.y * p.y + p.z * p.z * p.z * p.z - 0.8; };
      s.steepness = 10;
      break;
  }
  return s;
}

constexpr ImplicitShape kShapes[] = {ImplicitShape::Sphere,    ImplicitShape::Box,    ImplicitShape::Torus,
                                     ImplicitShape::Metaballs, ImplicitShape::Gyroid, ImplicitShape::Function};

// A floor at y = 0, seen from above its edge, and nothing else.
TestScene floorScene() {
  TestScene s;
  s.materials.resize(2);
  s.materials[0].baseColor = {0.5f, 0.6f, 0.7f, 1};
  s.materials[0].emissive = {0.1f, 0, 2};
  s.materials[1].baseColor = {0.2f, 0.3f, 0.4f, 1};
  s.materials[1].doubleSided = true;
  s.materials[1].metallic = 0.3f, s.materials[1].roughness = 7;
  TestMesh& floor = s.addMesh();
  TestScene::addQuad(floor, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3});
  s.place(floor);
  s.width = 70, s.height = 53;
  s.camera = perspective(0.7, 70.0 / 53, 0.1);
  s.camera.viewFromWorld = lookAt({1, 2, 5}, {0, 0.2, 0}, {0, 1, 0});
  return s;
}

// The ray through a pixel's centre in world space.
struct Ray {
  glm::dvec3 eye, direction;  // a unit of zView long
};
Ray rayOf(const TestScene& s, double x, double y) {
  const glm::dmat4 worldFromView = glm::inverse(s.camera.viewFromWorld);
  const glm::dvec4 d((2 * (x + 0.5) / s.width - 1) / s.camera.xScale, (1 - 2 * (y + 0.5) / s.height) / s.camera.yScale, -1, 0);
  return {glm::dvec3(worldFromView[3]), glm::dvec3(worldFromView * d)};
}

// zView of where the ray meets a sphere; infinity if it does not.
double meetsSphere(const Ray& r, glm::dvec3 center, double radius, bool far = false) {
  const glm::dvec3 o = r.eye - center;
  const double a = glm::dot(r.direction, r.direction), b = glm::dot(o, r.direction), c = glm::dot(o, o) - radius * radius;
  const double square = b * b - a * c;
  return square > 0 ? (-b + (far ? 1 : -1) * std::sqrt(square)) / a : kInfinity;
}

}  // namespace

TEST_CASE("implicit: every shape has the bits of its scalar twin, on every target, thread count and tile, skipped or not") {
  int seed = 0;
  for (ImplicitShape shape : kShapes) {
    TestScene s = floorScene();
    ImplicitSurface a = shaped(shape), b = a;
    glm::dmat4 m = glm::translate(glm::dmat4(1), glm::dvec3(-0.6, 0.4, 0));
    m = glm::scale(glm::rotate(m, 0.7, glm::dvec3(0.3, 1, 0.2)), glm::dvec3(1, -0.7, 1.2));
    a.worldFromObject = m;
    b.worldFromObject = glm::translate(glm::dmat4(1), glm::dvec3(0.9, 0.3, -0.4));
    b.material = 1;
    s.implicits = {a, b};
    if (++seed % 2 == 0) {
      s.camera = orthographic(2.6, 2, 0, 40);
      s.camera.viewFromWorld = lookAt({1, 2, 5}, {0, 0.2, 0}, {0, 1, 0});
    }
    INFO("shape " << int(shape));
    checkAgainstReference(s);
    GBuffer expected, layers;
    renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, expected);
    renderReference(s.list(), s.camera, s.width, s.height, kAllLayers, layers);
    for (Target target : supportedTargets())
      for (int tile : {16, 64}) {
        INFO(targetName(target) << ", tiles of " << tile);
        REQUIRE(firstDifference(render(s, {2, target, tile, tile == 64}), expected) == "");
        REQUIRE(firstDifference(render(s, {3, target, tile, tile == 16}, nullptr, kAllLayers), layers) == "");
      }
    CHECK(covered(expected) > s.width * s.height / 4);
    checkUsable(expected, s.camera.zNear, 1e30f);
  }
}

TEST_CASE("implicit: a sphere half sunk in a floor of triangles meets it where geometry says") {
  TestScene s = floorScene();
  s.implicits = {sphere(1, {0.2, 0, 0}, 1)};
  s.width = 280, s.height = 212;
  const GBuffer g = render(s);
  int spheres = 0, floors = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const Ray r = rayOf(s, x, y);
      const double z = meetsSphere(r, {0.2, 0, 0}, 1), zFloor = -r.eye.y / r.direction.y;
      const bool nearTie = std::fabs(z - zFloor) < 1e-4 * z;
      const glm::dvec3 onFloor = r.eye + r.direction * zFloor;
      const bool floor = r.direction.y < 0 && std::fabs(onFloor.x) < 2.99 && std::fabs(onFloor.z) < 2.99;
      if (nearTie || (!floor && z == double(kInfinity))) continue;
      INFO("pixel " << x << ", " << y);
      if (z < (floor ? zFloor : 1e30)) {
        ++spheres;
        REQUIRE(g.depth.at(x, y) == Approx(z).epsilon(1e-6));
        REQUIRE(g.triangle.at(x, y) == 2);   // after the floor's two triangles
        REQUIRE(g.instance.at(x, y) == 1);   // after the floor
        REQUIRE(g.material.at(x, y) == 1);
        REQUIRE(g.albedo[1].at(x, y) == 0.3f);
        REQUIRE(g.metallic.at(x, y) == 0.3f);
        REQUIRE(g.roughness.at(x, y) == 1);
        const glm::dvec3 n = (r.eye + r.direction * z - glm::dvec3(0.2, 0, 0));
        const glm::dvec3 view = glm::dvec3(s.camera.viewFromWorld * glm::dvec4(n, 0));
        for (int c = 0; c < 3; ++c) REQUIRE(g.normal[c].at(x, y) == Approx(view[c]).margin(2e-6));
      } else {
        ++floors;
        REQUIRE(g.triangle.at(x, y) < 2);
      }
    }
  CHECK(spheres > 4000);
  CHECK(floors > 4000);
}

TEST_CASE("implicit: of two surfaces in one place the first is seen, and triangles before both") {
  TestScene s = floorScene();
  s.implicits = {sphere(0.8), sphere(0.8)};
  const GBuffer g = render(s);
  int first = 0;
  eachPixel(g, [&](int x, int y) {
    CHECK(g.triangle.at(x, y) != 3);
    first += g.triangle.at(x, y) == 2;
  });
  CHECK(first > 100);

  // A box whose face has the key of a triangle, bit for bit: 1 / 4.
  TestScene tie = sceneOf({{-1, -1, -4}, {1, -1, -4}, {0, 1, -4}});
  tie.implicits = {shaped(ImplicitShape::Box)};
  tie.implicits[0].halfSize = {1, 1, 1};
  tie.implicits[0].worldFromObject = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -5));
  const GBuffer t = render(tie);
  int triangle = 0, box = 0;
  eachPixel(t, [&](int x, int y) { ++(t.triangle.at(x, y) == 0 ? triangle : box); });
  CHECK(triangle > 100);
  CHECK(box > 100);
}

TEST_CASE("implicit: a window shows the bits of the whole image") {
  TestScene s = floorScene();
  for (ImplicitShape shape : kShapes) s.implicits.push_back(shaped(shape));
  Rasterizer rasterizer;
  GBuffer part, expected;
  const GBuffer whole = render(s, {}, nullptr, kAllLayers);
  rasterizer.render(s.list(), s.camera, s.width, s.height, kAllLayers, part, Window{19, 13, 33, 30});
  cutOut(whole, {19, 13, 33, 30}, expected);
  CHECK(firstDifference(part, expected) == "");
}

TEST_CASE("implicit: an eye inside sees through what is single-sided, and the inner wall of what is not") {
  TestScene s = floorScene();
  s.instances.clear();
  const glm::dvec3 eye(1, 2, 5);
  s.implicits = {sphere(0.5, eye, 0)};
  CHECK(covered(render(s)) == 0);
  s.implicits[0].material = 1;
  const GBuffer g = render(s, {}, nullptr, kAllLayers);
  CHECK(covered(g) == s.width * s.height);
  eachPixel(g, [&](int x, int y) {
    const Ray r = rayOf(s, x, y);
    REQUIRE(g.depth.at(x, y) == Approx(0.5 / glm::length(r.direction)).epsilon(1e-6));
    REQUIRE(g.normal[2].at(x, y) > 0.5f);
    REQUIRE(g.depth2.at(x, y) == kInfinity);
  });
}

TEST_CASE("implicit: behind the first layer lie the floor, other surfaces and the far side") {
  TestScene s = floorScene();
  s.implicits = {sphere(0.5, {0, 1.4, 0}), sphere(0.3, {0, 1.4, 0.1}, 0)};
  PlaneSet planes = kAllLayers;
  planes.separation = 0.01f;
  const GBuffer g = render(s, {}, nullptr, planes);
  int backs = 0;
  eachPixel(g, [&](int x, int y) {
    if (g.triangle.at(x, y) != 2) return;
    const Ray r = rayOf(s, x, y);
    const double inner = meetsSphere(r, {0, 1.4, 0.1}, 0.3), back = meetsSphere(r, {0, 1.4, 0}, 0.5, true);
    if (inner < 1e30) {
      if (inner > g.depth.at(x, y) + 0.011) CHECK(g.depth2.at(x, y) == Approx(inner).epsilon(1e-5));
    } else {
      REQUIRE(g.depthBack.at(x, y) == Approx(back).epsilon(1e-5));
      CHECK(g.depth2.at(x, y) > g.depth.at(x, y) + 0.4f);  // the floor, or nothing
      ++backs;
    }
  });
  CHECK(backs > 20);
}

TEST_CASE("implicit: nothing that dense sampling finds is missed, whatever the shape, grazing rays included") {
  for (ImplicitShape shape : kShapes) {
    TestScene s = floorScene();
    s.instances.clear();
    s.implicits = {shaped(shape)};
    s.width = 40, s.height = 30;
    const GBuffer g = render(s);
    const std::vector<ImplicitDraw> draws = makeImplicitDraws(s.list(), s.camera);
    const double reach = draws[0].bound.radius;
    int seen = 0;
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        const Ray r = rayOf(s, x, y);
        const double middle = glm::dot(draws[0].bound.center - r.eye, r.direction) / glm::dot(r.direction, r.direction);
        double z = middle - reach, end = middle + reach;
        const double step = reach / 1500;
        int inside = 0;  // steps in a row; what is thinner than the tracer promises does not count
        for (; z < end && inside < 3; z += step) inside = ref::implicitValue(draws[0], r.eye + r.direction * z) < 0 ? inside + 1 : 0;
        if (inside < 3) continue;
        ++seen;
        INFO("shape " << int(shape) << ", pixel " << x << ", " << y);
        REQUIRE(g.depth.at(x, y) <= z);
        REQUIRE(g.depth.at(x, y) >= middle - reach);
      }
    CHECK(seen > 50);
  }
}

TEST_CASE("implicit: f is what the formula says, and nowhere steeper than 1") {
  Random random(5);
  for (ImplicitShape shape : kShapes) {
    TestScene s = floorScene();
    s.implicits = {shaped(shape)};
    const std::vector<ImplicitDraw> draws = makeImplicitDraws(s.list(), s.camera);
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 p(random.vector(-1.1f, 1.1f)), q = p + glm::dvec3(random.vector(-0.02f, 0.02f));
      const double f = ref::implicitValue(draws[0], p);
      INFO("shape " << int(shape) << " at " << p.x << ", " << p.y << ", " << p.z);
      REQUIRE(std::fabs(ref::implicitValue(draws[0], q) - f) <= glm::length(q - p) * (1 + 1e-9));
      CHECK(ref::implicitValue(draws[0], glm::vec3(p)) == Approx(f).margin(2e-6));
      if (shape != ImplicitShape::Gyroid) continue;
      const glm::dvec3 t = p * (6.283185307179586 / 0.9);
      const double sum = std::sin(t.x) * std::cos(t.y) + std::sin(t.y) * std::cos(t.z) + std::sin(t.z) * std::cos(t.x);
      const double wall = std::fabs(sum) * 0.9 / (6.283185307179586 * std::sqrt(3.0)) - 0.04;
      REQUIRE(std::fabs(f - std::max(wall, glm::length(p) - 1)) < 1e-13);
    }
  }
}

TEST_CASE("implicit: far from the eye and far from the origin a sphere stays round") {
  TestScene s = floorScene();
  s.instances.clear();
  const glm::dvec3 center(1e6, -2e6, 3e6);
  s.implicits = {sphere(2, center)};
  s.camera = perspective(0.0005, 70.0 / 53, 1);
  s.camera.viewFromWorld = lookAt(center + glm::dvec3(0, 0, 1e4), center, {0, 1, 0});
  const GBuffer g = render(s);
  int seen = 0, expected = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      seen += g.triangle.at(x, y) != kNoTriangle;
      const Ray r = rayOf(s, x, y);
      expected += meetsSphere({r.eye - center, r.direction}, {0, 0, 0}, 2) < 1e30;
    }
  CHECK(expected > 1000);
  CHECK(std::abs(seen - expected) <= 2);
  checkUsable(g, 9000, 11000);
}

TEST_CASE("implicit: what cannot be is refused, what shows nothing is left out") {
  TestScene s = floorScene();
  Rasterizer rasterizer;
  GBuffer g;
  const auto refused = [&](ImplicitSurface bad) {
    s.implicits = {bad};
    CHECK_THROWS_AS(rasterizer.render(s.list(), s.camera, s.width, s.height, kAllPlanes, g), std::invalid_argument);
  };
  for (double bad : {0.0, -1.0, double(kNan), double(kInfinity), 1e16}) {
    for (ImplicitShape shape : {ImplicitShape::Sphere, ImplicitShape::Torus, ImplicitShape::Function}) {
      ImplicitSurface i = shaped(shape);
      i.radius = bad;
      refused(i);
    }
    ImplicitSurface box = shaped(ImplicitShape::Box), torus = shaped(ImplicitShape::Torus), balls = shaped(ImplicitShape::Metaballs);
    ImplicitSurface thin = shaped(ImplicitShape::Gyroid), fine = thin, steep = shaped(ImplicitShape::Function);
    box.halfSize.y = torus.tube = balls.balls[1].radius = thin.thickness = fine.period = steep.steepness = bad;
    for (const ImplicitSurface& i : {box, torus, balls, thin, fine, steep}) refused(i);
  }
  refused(sphere(1, {0, 0, 0}, 2));
  ImplicitSurface empty = shaped(ImplicitShape::Metaballs), none = shaped(ImplicitShape::Function);
  empty.balls.clear();
  none.function = nullptr;
  refused(empty);
  refused(none);

  s.instances.clear();
  ImplicitSurface flat = sphere(1), astray = sphere(1), nowhere = shaped(ImplicitShape::Function);
  flat.worldFromObject[1][1] = 0;
  astray.worldFromObject[3][0] = double(kNan);
  nowhere.function = [](const glm::dvec3&) { return double(kNan); };
  s.implicits = {flat, astray, nowhere};
  CHECK(covered(render(s)) == 0);
  checkAgainstReference(s);
}
