// The containment tests beside the depth map, and their products.
#include <catch2/catch.hpp>

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using raster::ImplicitDraw;
using raster::ImplicitShape;
using raster::ImplicitSurface;

namespace {

ImplicitSurface placed(ImplicitShape shape, glm::dvec3 at) {
  ImplicitSurface s;
  s.shape = shape;
  s.radius = shape == ImplicitShape::Torus ? 0.3 : 0.45;
  s.tube = 0.15;
  s.halfSize = {0.4, 0.3, 0.2};
  s.balls = {{{-0.2, 0, 0}, 0.25}, {{0.2, 0.1, 0}, 0.3}};
  s.period = 0.4;
  s.thickness = 0.05;
  s.function = [](const glm::dvec3& p) { return p.x * p.x + p.y * p.y - 0.1; };
  s.worldFromObject = glm::rotate(glm::translate(glm::dmat4(1), at), 0.5, glm::dvec3(1, 2, 3));
  return s;
}

// A floor with a surface of each shape on it, one behind a wall.
TestScene surfacesScene(bool orthographic) {
  TestScene s;
  s.materials.resize(2);
  s.materials[0].baseColor = {0.7f, 0.6f, 0.5f, 1};
  s.materials[0].doubleSided = true;
  s.materials[1].baseColor = {0.3f, 0.9f, 0.2f, 1};
  TestMesh& floor = s.addMesh();
  TestScene::addQuad(floor, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5});
  TestScene::addQuad(floor, {-2, 0, 1}, {-1, 0, 1}, {-1, 1, 1}, {-2, 1, 1});
  s.place(floor);
  for (int k = 0; k < 6; ++k) {
    s.implicits.push_back(placed(ImplicitShape(k), {-1.5 + (k % 3) * 1.2, 0.2, 0.5 - k / 3 * 1.3}));
    s.implicits.back().material = 1;
  }
  s.width = 132, s.height = 87;
  s.camera = orthographic ? raster::orthographic(2.4, 1.6, 0.1, 50) : raster::perspective(0.6, 132.0 / 87, 0.1);
  s.camera.viewFromWorld = raster::lookAt({0.5, 2.5, 5}, {-0.2, 0.1, 0}, {0, 1, 0});
  return s;
}

post::AmbientSettings settings(float radius, int steps = 1) {
  post::AmbientSettings a;
  a.radius = radius;
  a.bias = radius / 100;
  a.steps = steps;
  a.filterThreshold = radius / 5;
  return a;
}

}  // namespace

TEST_CASE("containment: with implicit surfaces the kernels have the bits of their twin, sampled or skipped") {
  for (const bool orthographic : {false, true}) {
    const TestScene s = surfacesScene(orthographic);
    const std::vector<ImplicitDraw> draws = raster::makeImplicitDraws(s.list(), s.camera);
    PostFrame expected;
    expected.g = gbufferOf(s);
    expected.in.implicits = draws;
    const post::AmbientSettings a = settings(0.5f, orthographic ? 3 : 1);
    runPost(expected, s.camera, a, {});
    for (raster::Target target : raster::supportedTargets())
      for (const bool skip : {true, false}) {
        PostFrame f;
        f.g = gbufferOf(s);
        f.in.implicits = draws;
        runPost(f, s.camera, a, target, post::Occlusion::Transfer, skip);
        INFO(raster::targetName(target) << (skip ? "" : ", no skip"));
        REQUIRE(firstDifference(f, expected) == "");
      }
  }
}

TEST_CASE("containment: a surface that is hidden, or off screen, occludes all the same") {
  // Looking down at a floor in which a sphere is sunk to its top; a plate in front hides the sphere.
  TestScene s;
  s.materials.resize(1);
  TestMesh& floor = s.addMesh();
  TestScene::addQuad(floor, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5});
  s.place(floor);
  s.camera = raster::orthographic(1.3, 1, 0.1, 50);
  s.camera.viewFromWorld = raster::lookAt({0, 5, 0.001}, {0, 0, 0}, {0, 1, 0});
  ImplicitSurface sphere;
  sphere.radius = 0.6;
  sphere.worldFromObject = glm::translate(glm::dmat4(1), {1.3 + 0.7, 0.2, 0});  // beyond the right edge of the image
  s.implicits = {sphere};
  const std::vector<ImplicitDraw> draws = raster::makeImplicitDraws(s.list(), s.camera);
  PostFrame without, with;
  without.g = gbufferOf(s), with.g = gbufferOf(s);
  for (int x = 0; x < s.width; ++x) REQUIRE(with.g.triangle.at(x, 20) < 2);
  with.in.implicits = draws;
  const post::AmbientSettings a = settings(0.6f);
  runPost(without, s.camera, a, raster::supportedTargets().front());
  runPost(with, s.camera, a, raster::supportedTargets().front());
  CHECK(without.transfer.obscurance.at(s.width - 1, s.height / 2) == 1);
  CHECK(with.transfer.obscurance.at(s.width - 1, s.height / 2) < 0.9f);
  CHECK(with.transfer.obscurance.at(s.width / 4, s.height / 2) == 1);
}

TEST_CASE("containment: both sides of the line where a sphere is sunk in a floor are darkened alike") {
  TestScene s = surfacesScene(false);
  ImplicitSurface sphere;
  sphere.radius = 0.8;
  sphere.material = 1;
  s.implicits = {sphere};
  const std::vector<ImplicitDraw> draws = raster::makeImplicitDraws(s.list(), s.camera);
  PostFrame f;
  f.g = gbufferOf(s);
  f.in.implicits = draws;
  runPost(f, s.camera, settings(0.5f), raster::supportedTargets().front());
  // Down the column through the sphere's middle: its top is open, its foot is not, nor is the floor there, later it is.
  const int x = 68;
  int foot = 0;
  for (int y = 1; y < s.height; ++y)
    if (f.g.triangle.at(x, y) < 4 && f.g.triangle.at(x, y - 1) == 4) foot = y;
  REQUIRE(foot > 20);
  CHECK(f.transfer.obscurance.at(x, foot - 1) < 0.8f);
  CHECK(f.transfer.obscurance.at(x, foot + 1) < 0.85f);
  CHECK(f.transfer.obscurance.at(x, foot - 14) > 0.95f);
  CHECK(f.transfer.obscurance.at(x, s.height - 3) > 0.95f);
}

TEST_CASE("containment: ground that no surface is near is still known to be open, and not sampled") {
  TestScene s;
  s.materials.resize(1);
  TestMesh& floor = s.addMesh();
  TestScene::addQuad(floor, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9});
  s.place(floor);
  s.implicits = {placed(ImplicitShape::Sphere, {-0.5, -0.5, 0})};  // hidden below the floor
  s.width = 200, s.height = 150;
  s.camera = raster::perspective(0.6, 4.0 / 3, 0.1);
  s.camera.viewFromWorld = raster::lookAt({0, 5, 5}, {0, 0, 0}, {0, 1, 0});
  const std::vector<ImplicitDraw> draws = raster::makeImplicitDraws(s.list(), s.camera);
  PostFrame with, without, all;
  with.g = gbufferOf(s), without.g = gbufferOf(s), all.g = gbufferOf(s);
  with.in.implicits = all.in.implicits = draws;
  const raster::Target target = raster::supportedTargets().front();
  runPost(with, s.camera, settings(0.5f), target);
  runPost(without, s.camera, settings(0.5f), target);
  runPost(all, s.camera, settings(0.5f), target, post::Occlusion::Transfer, false);
  CHECK(firstDifference(with, all) == "");
  CHECK(with.statistics.open > 5000);
  CHECK(with.statistics.open < without.statistics.open);
}

TEST_CASE("containment: what is double-sided has no inside") {
  TestScene s = surfacesScene(false);
  ImplicitSurface room;
  room.radius = 30;  // around eye and floor; material 0 is double-sided
  s.implicits = {room};
  const std::vector<ImplicitDraw> draws = raster::makeImplicitDraws(s.list(), s.camera);
  PostFrame with, without;
  with.g = gbufferOf(s), without.g = gbufferOf(s);
  with.in.implicits = draws;
  runPost(with, s.camera, settings(0.5f), raster::supportedTargets().front());
  runPost(without, s.camera, settings(0.5f), raster::supportedTargets().front());
  CHECK(firstDifference(with, without) == "");
}

namespace {

// A square with bumps, seen from above or at a grazing angle, and a ball on it.
TestScene bumpyScene(bool grazing) {
  TestScene s;
  Random random(3);
  for (int i = 0; i < 16 * 16; ++i) s.heights.push_back(random.real(0, 1));
  s.heightViews = {{s.heights, 16, 16}};
  s.materials.resize(2);
  s.materials[0].baseColor = {0.7f, 0.6f, 0.5f, 1};
  s.materials[0].heightMap.texture = 0;
  s.materials[0].heightScale = 0.2f;
  TestMesh& mesh = s.addMesh();
  TestScene::addQuad(mesh, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  s.place(mesh);
  TestMesh& plain = s.addMesh();
  TestScene::addQuad(plain, {-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9});
  s.place(plain, 1);
  s.implicits = {placed(ImplicitShape::Sphere, {0, 0.2, 0})};
  s.width = 131, s.height = 90;
  s.camera = raster::perspective(0.7, 131.0 / 90, 0.1);
  s.camera.viewFromWorld = raster::lookAt(grazing ? glm::dvec3(0.5, 0.5, 4) : glm::dvec3(0.2, 4, 2), {0, 0, 0}, {0, 1, 0});
  return s;
}

raster::GBuffer reliefOf(const TestScene& s) {
  raster::PlaneSet planes = kAllPlanes;
  planes.relief = true;
  raster::Rasterizer rasterizer;
  raster::GBuffer g;
  rasterizer.render(s.list(), s.camera, s.width, s.height, planes, g);
  return g;
}

}  // namespace

TEST_CASE("containment: with a height field, implicit surfaces and the depth map the kernels have the bits of their twin") {
  for (const bool grazing : {false, true}) {
    const TestScene s = bumpyScene(grazing);
    const std::vector<ImplicitDraw> draws = raster::makeImplicitDraws(s.list(), s.camera);
    PostFrame expected;
    expected.g = reliefOf(s);
    expected.in.implicits = draws;
    expected.in.heights = s.heightViews;
    const post::AmbientSettings a = settings(0.2f, grazing ? 3 : 1);
    runPost(expected, s.camera, a, {});
    for (raster::Target target : raster::supportedTargets())
      for (const bool skip : {true, false}) {
        PostFrame f;
        f.g = reliefOf(s);
        f.in.implicits = draws;
        f.in.heights = s.heightViews;
        runPost(f, s.camera, a, target, post::Occlusion::Transfer, skip);
        INFO(raster::targetName(target) << (skip ? "" : ", no skip"));
        REQUIRE(firstDifference(f, expected) == "");
      }
  }
}

TEST_CASE("containment: a height field shadows what the depth map cannot see, and never opens what it can") {
  const TestScene s = bumpyScene(true);
  PostFrame with, without;
  with.g = reliefOf(s), without.g = reliefOf(s);
  with.in.heights = s.heightViews;
  runPost(with, s.camera, settings(0.05f), raster::supportedTargets().front());
  runPost(without, s.camera, settings(0.05f), raster::supportedTargets().front());
  int darker = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      REQUIRE(with.sums.numerator.at(x, y) <= without.sums.numerator.at(x, y));
      if (with.g.heightMap.at(x, y) == raster::kNoTriangle) REQUIRE(with.sums.numerator.at(x, y) == without.sums.numerator.at(x, y));
      darker += with.sums.numerator.at(x, y) < without.sums.numerator.at(x, y);
    }
  CHECK(darker > 50);
}
