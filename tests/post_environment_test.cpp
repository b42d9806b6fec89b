// The environment behind the scene, and what brings colours into a screen's range: pass by pass.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "obscura/post/environment_background.h"
#include "obscura/post/tone_map.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();

// Each texel, border included, holds the direction that it shows, plus 2.
std::vector<glm::vec3> directionTexels(int size) {
  const glm::vec3 forward[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::vec3 up[] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
  std::vector<glm::vec3> texels;
  for (int face = 0; face < 6; ++face)
    for (int y = -1; y <= size; ++y)
      for (int x = -1; x <= size; ++x) {
        const float s = (2 * float(x) + 1) / float(size) - 1, t = 1 - (2 * float(y) + 1) / float(size);
        texels.push_back(glm::normalize(forward[face] + s * glm::cross(forward[face], up[face]) + t * up[face]) + 2.0f);
      }
  return texels;
}

post::LinearColor filled(int width, int height, float value) {
  post::LinearColor color = post::makeLinearColor(width, height);
  for (auto& plane : color.rgb)
    for (int y = 0; y < height; ++y) std::fill_n(plane.row(y), width, value);
  return color;
}

}  // namespace

TEST_CASE("environment background: every empty pixel shows its direction, drawn ones are left alone, and the twin agrees") {
  const std::vector<glm::vec3> texels = directionTexels(40);
  for (uint32_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    const raster::Camera camera = seed % 4 == 3 ? raster::orthographic(2, 1, 0.1, 50) : raster::perspective(1.9, 1.5, 0.1);
    const int width = random.integer(1, 90), height = random.integer(1, 60);
    raster::PlaneSet planes;
    planes.depth = true;
    raster::GBuffer g(width, height, planes);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) g.depth.at(x, y) = random.integer(0, 4) ? kInf : random.integer(0, 1) ? 3 : kNaN;
    const glm::mat3 turn(glm::dmat3(raster::lookAt({0, 0, 0}, glm::dvec3(random.vector(-1, 1)), {0.1, 1, 0})));
    post::BackgroundInput in{&g, post::makeProjector(camera, 200, 100, raster::Window{random.integer(-20, 90), random.integer(-9, 50), width, height}), {}};
    in.environment = {{1, {40}, texels}, turn, 0.5f};
    post::LinearColor expected = filled(width, height, -7);
    environmentBackgroundRef(in, 0, height, expected);
    for (raster::Target target : raster::supportedTargets()) {
      post::LinearColor found = filled(width, height, -7);
      environmentBackground(in, 0, height, found, target);
      INFO("seed " << seed << " target " << raster::targetName(target));
      for (int c = 0; c < 3; ++c) REQUIRE(firstDifference("background", found.rgb[c], expected.rgb[c]) == "");
    }
    int wrong = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double u = (in.projector.xFirst + x + 0.5) / 100 - 1, v = 1 - (in.projector.yFirst + y + 0.5) / 50;
        const bool flat = camera.projection == raster::Projection::Orthographic;
        const glm::vec3 d = glm::normalize(turn * glm::vec3(flat ? 0 : u / double(camera.xScale), flat ? 0 : v / double(camera.yScale), -1));
        for (int c = 0; c < 3; ++c) {
          const float pixel = expected.rgb[c].at(x, y);
          wrong += g.depth.at(x, y) == 3 ? pixel != -7 : !(std::fabs(pixel - 0.5f * (d[c] + 2)) < 0.002f);
        }
      }
    CHECK(wrong == 0);
  }
}

TEST_CASE("tone mapping: every curve equals its scalar twin, and whatever goes in, numbers come out") {
  const float odd[] = {0, -0.f, 1, -1, kInf, -kInf, kNaN, 1e-42f, 3e38f, 0.08f, 0.76f, 0.8f, 1e30f};
  Random random(3);
  const int width = 333;
  post::LinearColor in = post::makeLinearColor(width, 3);
  for (auto& plane : in.rgb)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < width; ++x) plane.at(x, y) = random.integer(0, 3) ? random.real(0, y == 2 ? 50.f : 1.2f) : odd[random.integer(0, 12)];
  for (auto curve : {post::ToneCurve::None, post::ToneCurve::Reinhard, post::ToneCurve::Neutral})
    for (float exposure : {1.f, 0.f, 0.7f, 4.f, 1e20f}) {
      post::LinearColor expected = post::makeLinearColor(width, 3), found = post::makeLinearColor(width, 3);
      toneMapRef(in, {curve, exposure}, 0, 3, expected);
      for (raster::Target target : raster::supportedTargets()) {
        toneMap(in, {curve, exposure}, 0, 3, found, target);
        for (int c = 0; c < 3; ++c) REQUIRE(firstDifference("tone", found.rgb[c], expected.rgb[c]) == "");
      }
      int wrong = 0;
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 3; ++y)
          for (int x = 0; x < width; ++x) {
            const float v = expected.rgb[c].at(x, y);
            wrong += !(v >= 0 && v <= (curve == post::ToneCurve::Neutral ? 1.00001f : 1e30f));
          }
      CAPTURE(int(curve), exposure);
      CHECK(wrong == 0);
    }
}

TEST_CASE("tone mapping: the curves are those of their papers") {
  const auto mapped = [](const glm::vec3& c, post::ToneCurve curve, float exposure = 1) {
    post::LinearColor color = post::makeLinearColor(1, 1);
    for (int k = 0; k < 3; ++k) color.rgb[k].at(0, 0) = c[k];
    toneMapRef(color, {curve, exposure}, 0, 1, color);
    return glm::vec3(color.rgb[0].at(0, 0), color.rgb[1].at(0, 0), color.rgb[2].at(0, 0));
  };
  using Curve = post::ToneCurve;
  CHECK(mapped({0.25f, 3, 0.5f}, Curve::None) == glm::vec3(0.25f, 3, 0.5f));
  CHECK(mapped({0.25f, 3, 0.5f}, Curve::None, 2) == glm::vec3(0.5f, 6, 1));
  CHECK(mapped(glm::vec3(3), Curve::Reinhard).y == Approx(0.75));
  CHECK(mapped(glm::vec3(1e9f), Curve::Reinhard).x == Approx(1));
  CHECK(mapped({1, 0, 0}, Curve::Reinhard).x == Approx(1 / 1.2126));
  CHECK(mapped(glm::vec3(0.5f), Curve::Neutral).x == Approx(0.46));           // less Fresnel's 0.04
  CHECK(mapped({0.5f, 0.3f, 0.04f}, Curve::Neutral).x == Approx(0.5 - 0.03));  // 0.04 - 6.25 * 0.04^2
  CHECK(mapped(glm::vec3(0.8f), Curve::Neutral).x == Approx(0.76));
  CHECK(mapped(glm::vec3(100), Curve::Neutral).x > 0.999f);
  const glm::vec3 red = mapped({50, 0.5f, 0.5f}, Curve::Neutral);  // bright colours turn white
  CHECK((red.x > 0.99f && red.y > 0.8f && red.x > red.y));
  float last = -1;
  for (int k = 0; k < 400; ++k) {
    const float next = mapped(glm::vec3(float(k) * 0.01f), Curve::Neutral).x;
    CHECK(next > last);
    last = next;
  }
}
