// Direct lights: falloff in closed form, shadows without acne and without gaps, one set of bits.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <glm/geometric.hpp>

#include "obscura/post/direct_light.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::tests;
using post::LightKind;
using post::PunctualLight;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kPi = 3.14159265f;

raster::Plane<float> mapOf(Random& random, int size, bool far) {
  raster::Plane<float> plane(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) plane.at(x, y) = random.integer(0, 3) ? random.real(0.1f, far ? 20.f : 6.f) : kInf;
  return plane;
}

glm::mat3 anyTurn(Random& random) {
  return glm::mat3(glm::dmat3(raster::lookAt({0, 0, 0}, glm::dvec3(random.vector(-1, 1)), {0.1, 1, 0})));
}

PunctualLight anyLight(Random& random, const raster::Plane<float>& map) {
  PunctualLight l;
  l.kind = LightKind(random.integer(0, 2));
  l.color = random.vector(0, 9);
  l.lightFromView = l.lightFromNormal = anyTurn(random);
  l.origin = random.vector(-3, 3);
  // Where the light space has its origin.
  const glm::vec3 at = -glm::transpose(l.lightFromView) * l.origin;
  l.place = l.kind == LightKind::Directional ? glm::normalize(random.vector(-1, 1) + glm::vec3(0, 0, 0.3f)) : at;
  if (random.integer(0, 1)) l.range = random.real(0.5f, 9);
  l.axis = glm::normalize(random.vector(-1, 1));
  const float outer = random.real(0, 0.9f), inner = random.real(outer, 1);
  if (l.kind == LightKind::Spot) l.coneScale = 1 / std::max(0.001f, inner - outer), l.coneOffset = -outer * l.coneScale;
  l.maps = random.integer(0, 2) * 3;
  if (l.maps == 3) l.maps = 1;
  for (int k = 0; k < l.maps; ++k) {
    const bool flat = l.kind == LightKind::Directional;
    const raster::Camera camera = flat ? raster::orthographic(4, 3, 0, 50) : raster::perspective(1.6, 1, 0.01);
    l.map[k].projector = post::makeProjector(camera, map.width(), map.height());
    if (random.integer(0, 4)) l.map[k].depth = &map;
  }
  if (l.kind == LightKind::Directional && l.maps == 6) l.maps = 1;
  if (l.kind == LightKind::Spot && l.maps == 1) l.axis = {0, 0, 1};
  return l;
}

post::LinearColor filled(int width, int height, float value) {
  post::LinearColor color = post::makeLinearColor(width, height);
  for (auto& plane : color.rgb)
    for (int y = 0; y < height; ++y) std::fill_n(plane.row(y), width, value);
  return color;
}

// A camera that looks straight at a white wall at the distance 4.
TestScene wall() {
  TestScene s;
  s.width = s.height = 41;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  s.materials[0].baseColor = {1, 1, 1, 1};
  TestMesh& mesh = s.addMesh();
  TestScene::addQuad(mesh, {-9, -9, -4}, {9, -9, -4}, {9, 9, -4}, {-9, 9, -4});
  s.place(mesh);
  s.camera = raster::perspective(1, 1, 0.1);
  return s;
}

float litAtCenter(const PunctualLight& light) {
  const TestScene s = wall();
  raster::GBuffer g;
  renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
  post::LinearColor out = filled(s.width, s.height, 0);
  directLightRef({&g, post::makeProjector(s.camera, s.width, s.height), {&light, 1}}, 0, s.height, out);
  return out.rgb[1].at(20, 20);
}

}  // namespace

TEST_CASE("direct light: every target equals the scalar twin, with and without skipping, whatever maps hold") {
  for (uint32_t seed = 0; seed < 24; ++seed) {
    Random random(seed);
    const TestScene s = soupScene(seed);
    raster::GBuffer g;
    renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, g);
    const raster::Plane<float> map = mapOf(random, random.integer(16, 90), seed % 2);
    std::vector<PunctualLight> lights;
    for (int k = random.integer(1, 6); k > 0; --k) lights.push_back(anyLight(random, map));
    post::DirectLightInput in{&g, post::makeProjector(s.camera, s.width, s.height), lights};
    in.add = seed % 3 == 0;
    in.brdf = post::Brdf(seed % 4);
    post::LinearColor expected = filled(s.width, s.height, 0.25f);
    directLightRef(in, 0, s.height, expected);
    for (raster::Target target : raster::supportedTargets())
      for (bool skip : {true, false}) {
        INFO("seed " << seed << " target " << raster::targetName(target) << " skip " << skip);
        in.skip = skip;
        post::LinearColor found = filled(s.width, s.height, 0.25f);
        for (int y = 0; y < s.height; y += 5) directLight(in, y, std::min(y + 5, s.height), found, target);
        for (int c = 0; c < 3; ++c) REQUIRE(firstDifference("direct", found.rgb[c], expected.rgb[c]) == "");
        for (const PunctualLight& light : lights) {
          REQUIRE(mapsReached(in, light, 0, s.height, target) == mapsReachedRef(in, light, 0, s.height));
          const post::LightBounds a = boundsInLight(g.depth, in.projector, light, 0, s.height, target),
                                  b = boundsInLightRef(g.depth, in.projector, light, 0, s.height);
          REQUIRE((a.min == b.min && a.max == b.max));
        }
      }
  }
}

TEST_CASE("direct light: a white wall lit squarely by pi lux has radiance 1, by a candela at the distance d that of 1 / (pi d^2)") {
  PunctualLight sun;
  sun.color = glm::vec3(kPi);
  CHECK(litAtCenter(sun) == Approx(1));
  sun.place = {0, std::sqrt(0.75f), 0.5f};
  CHECK(litAtCenter(sun) == Approx(0.5));
  sun.place = {0, 0, -1};
  CHECK(litAtCenter(sun) == 0);
  PunctualLight lamp;  // at the eye: d = 4
  lamp.kind = LightKind::Point;
  lamp.place = {0, 0, 0};
  lamp.color = glm::vec3(kPi * 16);
  CHECK(litAtCenter(lamp) == Approx(1));
  lamp.range = 5;
  CHECK(litAtCenter(lamp) == Approx(1 - std::pow(0.8, 4)));
  lamp.range = 4;
  CHECK(litAtCenter(lamp) < 1e-3f);
  lamp.range = 3.9f;
  CHECK(litAtCenter(lamp) == 0);
}

TEST_CASE("direct light: a spot is full inside its inner cone, and falls as the square to its outer one") {
  PunctualLight spot;
  spot.kind = LightKind::Spot;
  spot.place = {0, 0, 0};
  spot.color = glm::vec3(kPi * 16);
  const float outer = std::cos(0.5f), inner = std::cos(0.2f);
  spot.coneScale = 1 / (inner - outer), spot.coneOffset = -outer * spot.coneScale;
  const auto turnedBy = [&](float angle) {
    spot.axis = {std::sin(angle), 0, -std::cos(angle)};
    return litAtCenter(spot);
  };
  CHECK(turnedBy(0) == Approx(1));
  CHECK(turnedBy(0.19f) == Approx(1));
  const float s = (std::cos(0.35f) - outer) / (inner - outer);
  CHECK(turnedBy(0.35f) == Approx(s * s));
  CHECK(turnedBy(0.51f) == 0);
}
