// Cameras from matrices, as other programs have them.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "obscura/raster/camera.h"
#include "test_scene.h"

using namespace obscura::raster;
using Catch::Contains;
using obscura::tests::soupScene;

namespace {

// OpenGL's matrix of a camera: [-1, 1] from near to far.
glm::dmat4 projectionOf(const Camera& c) {
  glm::dmat4 p(0);
  const double n = c.zNear, f = c.zFar;
  p[0][0] = c.xScale;
  p[1][1] = c.yScale;
  if (c.projection == Projection::Perspective) {
    p[2][0] = -double(c.xShift);
    p[2][1] = -double(c.yShift);
    p[2][2] = f > 0 ? (f + n) / (n - f) : -1;
    p[3][2] = f > 0 ? 2 * f * n / (n - f) : -2 * n;
    p[2][3] = -1;
  } else {
    p[3][0] = c.xShift;
    p[3][1] = c.yShift;
    p[2][2] = 2 / (n - f);
    p[3][2] = (f + n) / (n - f);
    p[3][3] = 1;
  }
  return p;
}

void checkEqual(const Camera& a, const Camera& b) {
  CHECK(a.viewFromWorld == b.viewFromWorld);
  CHECK(a.projection == b.projection);
  CHECK(a.xScale == b.xScale);
  CHECK(a.yScale == b.yScale);
  CHECK(a.xShift == b.xShift);
  CHECK(a.yShift == b.yShift);
  CHECK(a.zNear == b.zNear);
  CHECK(a.zFar == b.zFar);
}

// Near and far change places at the ends of [-1, 1].
glm::dmat4 reversed(glm::dmat4 p) {
  p[2][2] = -p[2][2];
  p[3][2] = -p[3][2];
  return p;
}

std::vector<Camera> cameras() {
  std::vector<Camera> all = {perspective(0.7, 1.5, 0.1), perspective(2.5, 0.3, 0.01, 100), perspective(0.1, 1, 3, 3.5),
                             perspective(1, 2, 1e-6, 1e3), orthographic(3, 2, 0, 10), orthographic(0.01, 500, 2, 2.5)};
  const size_t plain = all.size();
  for (size_t i = 0; i < plain; ++i) {
    Camera c = all[i];
    c.xShift = 0.25f;
    c.yShift = -1.5f;
    c.viewFromWorld = lookAt({1, 2, 3}, {-4, 0.5, 0.1}, {0, 1, 0});
    all.push_back(c);
  }
  return all;
}

}  // namespace

TEST_CASE("camera: from its matrices a camera comes back, whatever their scale and with depth reversed") {
  for (const Camera& c : cameras())
    for (double scale : {1.0, 1e-3, 640.0}) {
      const glm::dmat4 p = projectionOf(c) * scale;
      INFO("perspective " << (c.projection == Projection::Perspective) << " near " << c.zNear << " far " << c.zFar);
      Camera plain = cameraFromMatrices(c.viewFromWorld, p), turned = cameraFromMatrices(c.viewFromWorld, reversed(p));
      // A scale that is no power of two rounds every element.
      if (scale != 1)
        for (Camera* found : {&plain, &turned})
          for (float Camera::*m : {&Camera::xScale, &Camera::yScale, &Camera::xShift, &Camera::yShift, &Camera::zNear, &Camera::zFar}) {
            REQUIRE(std::fabs(found->*m - c.*m) <= 2e-7f * std::fabs(c.*m));
            found->*m = c.*m;
          }
      checkEqual(plain, c);
      checkEqual(turned, c);
    }
}

TEST_CASE("camera: matrices in single precision give the same but for their rounding") {
  for (const Camera& c : cameras()) {
    const glm::mat4 p(projectionOf(c));
    const Camera found = cameraFromMatrices(glm::dmat4(glm::mat4(c.viewFromWorld)), glm::dmat4(p));
    CHECK(found.xScale == c.xScale);
    CHECK(found.zNear == Approx(c.zNear).epsilon(1e-6).margin(1e-6));
    if (c.zFar < 1000 * c.zNear) CHECK(found.zFar == Approx(c.zFar).epsilon(1e-3));
  }
}

TEST_CASE("camera: a projection that never reaches its far plane has none") {
  glm::dmat4 p = projectionOf(perspective(1, 1, 0.5));
  p[2][2] = -1 + 1e-6;  // the far plane of a matrix that was kept from rounding
  p[3][2] = -0.5 * (2 - 1e-6);
  checkEqual(cameraFromMatrices(glm::dmat4(1), p), perspective(1, 1, 0.5));
  p[2][2] = -1.0000000000000002;
  p[3][2] = -2e20;
  checkEqual(cameraFromMatrices(glm::dmat4(1), p), perspective(1, 1, 1e20));  // it would be at 1e36
}

TEST_CASE("camera: the same pixels as from the camera that the matrices are of") {
  for (uint32_t seed : {3u, 4u, 6u, 7u, 11u}) {
    const obscura::tests::TestScene s = soupScene(seed);
    Rasterizer rasterizer;
    Plane<float> a, b;
    rasterizer.renderDepth(s.list(), s.camera, s.width, s.height, a);
    const Camera found = cameraFromMatrices(s.camera.viewFromWorld, projectionOf(s.camera));
    rasterizer.renderDepth(s.list(), found, s.width, s.height, b);
    CHECK(obscura::tests::firstDifference("depth", a, b) == "");
  }
}

TEST_CASE("camera: what is no camera is refused, with the element and the reason") {
  const glm::dmat4 view = lookAt({1, 2, 3}, {0, 0, 0}, {0, 1, 0}), persp = projectionOf(perspective(1, 1, 0.1, 50));
  const glm::dmat4 ortho = projectionOf(orthographic(2, 2, 1, 50));
  const auto withView = [&](int column, int row, double v) {
    glm::dmat4 m = view;
    m[column][row] = v;
    cameraFromMatrices(m, persp);
  };
  const auto with = [&](glm::dmat4 p, int column, int row, double v) {
    p[column][row] = v;
    const Camera c = cameraFromMatrices(view, p);
    obscura::raster::checkArguments({}, c, 8, 8);
  };
  CHECK_THROWS_WITH(withView(2, 3, 0.5), Contains("column 2, row 3: 0.5") && Contains("affine"));
  CHECK_THROWS_WITH(withView(3, 3, 2), Contains("column 3, row 3: 2") && Contains("affine"));
  CHECK_THROWS_WITH(withView(3, 0, std::nan("")), Contains("nan"));
  CHECK_THROWS_WITH(withView(3, 0, 1e31), Contains("1e+31"));
  CHECK_THROWS_WITH(cameraFromMatrices(glm::dmat4(0), persp), Contains("affine"));
  glm::dmat4 flat = view;
  flat[0] = flat[1];
  CHECK_THROWS_WITH(cameraFromMatrices(flat, persp), Contains("without an inverse"));

  for (const glm::dmat4& p : {persp, ortho}) {
    CHECK_THROWS_WITH(with(p, 0, 2, 0.1), Contains("oblique near plane"));
    CHECK_THROWS_WITH(with(p, 1, 2, 0.1), Contains("oblique near plane"));
    CHECK_THROWS_WITH(with(p, 0, 3, 0.1), Contains("tilts"));
    CHECK_THROWS_WITH(with(p, 1, 0, 0.1), Contains("shears"));
    CHECK_THROWS_WITH(with(p, 0, 1, 0.1), Contains("shears"));
    CHECK_THROWS_WITH(with(p, 0, 0, 0), Contains("mirrored or flat"));
    CHECK_THROWS_WITH(with(p, 1, 1, -1), Contains("mirrored or flat"));
    CHECK_THROWS_WITH(with(p, 2, 2, std::numeric_limits<double>::infinity()), Contains("inf"));
    CHECK_THROWS_WITH(with(p, 3, 2, 1e300), Contains("1e+300"));
  }
  CHECK_THROWS_WITH(with(persp, 2, 3, 1), Contains("+z"));
  CHECK_THROWS_WITH(with(persp, 2, 3, -1e-300), Contains("projection"));
  CHECK_THROWS_WITH(with(persp, 3, 0, 0.3), Contains("moves the eye"));
  CHECK_THROWS_WITH(with(persp, 3, 3, 1), Contains("moves the eye"));
  CHECK_THROWS_WITH(with(persp, 3, 2, 0), Contains("empty depth range"));
  CHECK_THROWS_WITH(with(persp, 2, 2, 1), Contains("empty depth range"));
  CHECK_THROWS_WITH(with(persp, 3, 2, -1e-35), Contains("not in front of the eye"));
  CHECK_THROWS_WITH(with(persp, 2, 2, -1e12), Contains("not behind the near plane"));
  CHECK_THROWS_WITH(with(ortho, 3, 3, -1), Contains("in front of the eye"));
  CHECK_THROWS_WITH(with(ortho, 3, 3, 0), Contains("in front of the eye"));
  CHECK_THROWS_WITH(with(ortho, 2, 0, 0.2), Contains("oblique"));
  CHECK_THROWS_WITH(with(ortho, 2, 2, 0), Contains("empty depth range"));
  CHECK_THROWS_WITH(with(ortho, 3, 2, 0), Contains("not in front of the eye"));  // the eye in the middle
  CHECK_THROWS_WITH(with(ortho, 2, 2, -1e-31), Contains("1e30"));
  CHECK_NOTHROW(cameraFromMatrices(view, persp));
}
