// Rays that are followed through the depth map: what stops them and what does not.
#include <catch2/catch.hpp>

#include <cmath>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using post::AmbientSettings;
using post::Estimator;

namespace {

AmbientSettings settingsOf(Estimator estimator, int steps) {
  AmbientSettings s;
  s.estimator = estimator;
  s.samples = 16;
  s.steps = steps;
  s.radius = 0.5f;
  s.bias = 0.005f;
  s.filterGuide = post::FilterGuide::Plane;
  return s;
}

TestScene groundSeenFrom(glm::dvec3 eye, bool orthographic) {
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  s.width = 120, s.height = 90;
  TestMesh& ground = s.addMesh();
  TestScene::addQuad(ground, {-40, 0, 40}, {40, 0, 40}, {40, 0, -40}, {-40, 0, -40});
  s.place(ground);
  s.camera = orthographic ? raster::orthographic(2, 1.5, 0.1, 200) : raster::perspective(0.8, 4.0 / 3, 0.1);
  s.camera.viewFromWorld = raster::lookAt(eye, {0, 0, 0}, {0, 1, 0});
  return s;
}

// A plate of this thickness and half side 2 that floats over the ground at this height, seen from above.
TestScene plateOverGround(float height, float thickness) {
  TestScene s = groundSeenFrom({0, 4, 4}, false);
  const float a = 2, y0 = height, y1 = height + thickness;
  TestMesh& plate = s.addMesh();
  TestScene::addQuad(plate, {-a, y1, 0}, {a, y1, 0}, {a, y1, -2 * a}, {-a, y1, -2 * a});
  TestScene::addQuad(plate, {-a, y0, 0}, {a, y0, 0}, {a, y1, 0}, {-a, y1, 0});
  TestScene::addQuad(plate, {-a, y0, 0}, {a, y0, 0}, {a, y0, -2 * a}, {-a, y0, -2 * a});
  s.place(plate);
  return s;
}

PostFrame framed(const TestScene& s, const AmbientSettings& settings) {
  PostFrame f;
  f.g = gbufferOf(s);
  runPost(f, s.camera, settings, raster::Target::Auto);
  return f;
}

double darkest(const PostFrame& f) {
  double o = 1;
  for (int y = 0; y < f.g.height; ++y)
    for (int x = 0; x < f.g.width; ++x) o = std::min(o, double(f.transfer.obscurance.at(x, y)));
  return o;
}

// O where the camera sees the world point.
double at(const PostFrame& f, const TestScene& s, glm::dvec3 p) {
  const glm::dvec4 v = s.camera.viewFromWorld * glm::dvec4(p, 1);
  const post::Projector& q = f.in.projector;
  return f.transfer.obscurance.at(int(v.x / -v.z * q.xScale + q.xCenter), int(v.y / -v.z * q.yScale + q.yCenter));
}

}  // namespace

TEST_CASE("march: bare ground is open from any angle, with any number of steps, where test points alone see its stairs") {
  for (double height : {0.3, 1.0, 3.0})
    for (bool orthographic : {false, true})
      for (int steps : {1, 3, 16}) {
        INFO("from " << height << ", orthographic " << orthographic << ", steps " << steps);
        CHECK(darkest(framed(groundSeenFrom({0, height, 3}, orthographic), settingsOf(Estimator::March, steps))) == 1);
      }
  CHECK(darkest(framed(groundSeenFrom({0, 0.3, 3}, false), settingsOf(Estimator::Box, 4))) < 0.9);
}

TEST_CASE("march: a thin plate stops rays that pass it between the papers' test points, the more surely the more steps there are") {
  // Under the edge of a plate 0.2 R over the ground: rays to the plate's side meet it at once; half of the directions are free.
  const TestScene s = plateOverGround(0.1f, 0.02f);
  const glm::dvec3 before(0, 0, 0.02);
  const double paper = at(framed(s, settingsOf(Estimator::Box, 1)), s, before);
  double last = 1;
  for (int steps : {1, 2, 4, 8}) {
    const double o = at(framed(s, settingsOf(Estimator::March, steps)), s, before);
    INFO("steps " << steps << ": " << o << ", one test point " << paper);
    CHECK(o <= last + 0.02);
    CHECK(o < 1);
    last = o;
  }
  CHECK(last < paper - 0.15);
  CHECK(last > 0.5);
}

TEST_CASE("march: what is farther before a ray than the shell is thick does not stop it, unless there is no bound") {
  // A small plate two R over the ground hides some of it; beside it the ground is as open as without it.
  TestScene s = groundSeenFrom({0, 8, 0.01}, false);
  TestMesh& plate = s.addMesh();
  TestScene::addQuad(plate, {-0.5f, 2, 0.5f}, {0.5f, 2, 0.5f}, {0.5f, 2, -0.5f}, {-0.5f, 2, -0.5f});
  s.place(plate);
  AmbientSettings settings = settingsOf(Estimator::March, 4);
  CHECK(at(framed(s, settings), s, {0.75, 0, 0}) == 1);
  settings.silhouetteBound = false;
  CHECK(at(framed(s, settings), s, {0.75, 0, 0}) < 0.95);
}

TEST_CASE("march: a second layer stops the rays under what it is hidden by") {
  // A wall on the ground that a floating sheet hides; the ground before it is seen.
  TestScene s = groundSeenFrom({0, 4, 4}, false);
  TestMesh& sheet = s.addMesh();
  TestScene::addQuad(sheet, {-2, 0.45f, 0}, {2, 0.45f, 0}, {2, 0.45f, -4}, {-2, 0.45f, -4});
  s.place(sheet);
  TestMesh& wall = s.addMesh();
  TestScene::addQuad(wall, {-2, 0, -0.5f}, {2, 0, -0.5f}, {2, 0.44f, -0.5f}, {-2, 0.44f, -0.5f});
  s.place(wall);
  AmbientSettings settings = settingsOf(Estimator::March, 4);
  raster::PlaneSet planes = kAllLayers;
  planes.separation = 0.1f;
  raster::Rasterizer rasterizer;
  PostFrame one, two;
  for (PostFrame* f : {&one, &two}) {
    settings.layers = f == &one ? 1 : 2;
    rasterizer.render(s.list(), s.camera, s.width, s.height, planes, f->g);
    runPost(*f, s.camera, settings, raster::Target::Auto);
  }
  int darker = 0, brighter = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const float a = one.transfer.obscurance.at(x, y), b = two.transfer.obscurance.at(x, y);
      darker += b < a, brighter += b > a;
    }
  CHECK(darker > 20);
  CHECK(brighter == 0);
}
