// La(x): one colour, by group of instances, by direction of the normal.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using post::AmbientLight;
using post::AmbientSettings;

namespace {

const glm::vec3 kAxes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

// The colour of an unoccluded white surface with this normal and instance: La itself, after all targets and the twin
// were found to give the same.
glm::vec3 ambientOf(const AmbientLight& light, const glm::vec3& normal, uint32_t instance = 0) {
  raster::GBuffer g(1, 1, kAllPlanes);
  g.depth.at(0, 0) = 1;
  g.instance.at(0, 0) = instance;
  for (int c = 0; c < 3; ++c) {
    g.normal[c].at(0, 0) = normal[c];
    g.albedo[c].at(0, 0) = 1;
    g.emissive[c].at(0, 0) = 0;
  }
  const post::LightInput in{&g, nullptr, post::Occlusion::None, light, glm::vec3(0)};
  post::LinearColor expected = post::makeLinearColor(1, 1), found = post::makeLinearColor(1, 1);
  post::lightRef(in, 0, 1, expected);
  for (raster::Target target : raster::supportedTargets()) {
    post::light(in, 0, 1, found, target);
    for (int c = 0; c < 3; ++c) REQUIRE(firstDifference("La", found.rgb[c], expected.rgb[c]) == "");
  }
  return {expected.rgb[0].at(0, 0), expected.rgb[1].at(0, 0), expected.rgb[2].at(0, 0)};
}

AmbientLight cube(const glm::vec3 (&colors)[6]) {
  AmbientLight light;
  for (int k = 0; k < 6; ++k) light.directions.push_back({kAxes[k], colors[k]});
  return light;
}

// Coefficients of any sign.
post::NormalQuadric randomQuadric(Random& random) {
  post::NormalQuadric q;
  for (glm::vec3* v : {&q.constant, &q.x, &q.y, &q.z, &q.xx, &q.xy, &q.xz, &q.yy, &q.yz, &q.zz}) *v = random.vector(-1, 1);
  q.most = random.vector(0, 4);
  return q;
}

const glm::vec3 kSix[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {2, 0, 2}};

}  // namespace

TEST_CASE("ambient light: of a group's instances, its own, of others, the frame's") {
  const std::vector<glm::vec3> table{{1, 2, 3}, {4, 5, 6}};
  AmbientLight light(glm::vec3(0.5f));
  light.instances = table;
  CHECK(ambientOf(light, kAxes[0], 0) == table[0]);
  CHECK(ambientOf(light, kAxes[0], 1) == table[1]);
  for (uint32_t beyond : {2u, 1u << 30, 0x7FFFFFFFu, 0x80000000u, raster::kNoTriangle})
    CHECK(ambientOf(light, kAxes[0], beyond) == glm::vec3(0.5f));
}

TEST_CASE("ambient light: along an axis of a cube it is that side's colour, between them a mean by cosines") {
  const AmbientLight light = cube(kSix);
  for (int k = 0; k < 6; ++k) CHECK(ambientOf(light, kAxes[k]) == kSix[k]);
  const glm::vec3 between = ambientOf(light, {0.6f, 0.8f, 0});
  CHECK(std::fabs(between.x - 0.6f / 1.4f) < 1e-6f);
  CHECK(std::fabs(between.z - 0.8f / 1.4f) < 1e-6f);
}

TEST_CASE("ambient light: direction is a factor on the colour of the group") {
  const std::vector<glm::vec3> table{{3, 5, 7}};
  AmbientLight light = cube(kSix);
  light.instances = table;
  CHECK(ambientOf(light, kAxes[3]) == glm::vec3(3, 5, 0));
}

TEST_CASE("ambient light: what directions add comes on top, whatever the light of the group") {
  AmbientLight light = cube(kSix);
  for (int k = 0; k < 6; ++k) light.directions[size_t(k)].added = glm::vec3(float(k), 0, 8);
  const std::vector<glm::vec3> table{{3, 5, 7}, {0, 0, 0}};
  light.instances = table;
  CHECK(ambientOf(light, kAxes[3]) == glm::vec3(3 + 3, 5, 8));
  CHECK(ambientOf(light, kAxes[3], 1) == glm::vec3(3, 0, 8));
  CHECK(ambientOf(light, {0, 0.6f, 0.8f}, 1).x == Approx((0.6 * 2 + 0.8 * 4) / 1.4));
  CHECK(ambientOf(light, glm::vec3(0), 1) == glm::vec3(2.5f, 0, 8));
}

TEST_CASE("ambient light: of a normal without direction it is the mean of the colours, never more than the largest") {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const AmbientLight light = cube(kSix);
  const glm::vec3 mean = (kSix[0] + kSix[1] + kSix[2] + kSix[3] + kSix[4] + kSix[5]) / 6.f;
  for (const glm::vec3& n : {glm::vec3(0), glm::vec3(nan), glm::vec3(inf, 0, 0), glm::vec3(-inf, inf, 0), glm::vec3(1e20f, 0, 0)})
    CHECK(ambientOf(light, n) == mean);
  for (const glm::vec3& n : {glm::vec3(1e-40f, 0, 0), glm::vec3(1e7f, 1, -1e-30f), glm::vec3(nan, 1, 0), glm::vec3(0.1f, nan, nan)}) {
    const glm::vec3 la = ambientOf(light, n);
    for (int c = 0; c < 3; ++c) CHECK((la[c] >= 0 && la[c] <= 2.00001f));
  }
}

TEST_CASE("ambient light: of an environment it is a quadratic form of the normal, and a group's own light comes before it") {
  AmbientLight light(glm::vec3(9));
  post::NormalQuadric& q = light.environment.emplace();
  q.constant = {1, 2, 0}, q.x = {3, 0, 0}, q.yy = {0, 8, 0}, q.xz = {0, 0, 4}, q.most = {3.5f, 100, 100};
  CHECK(ambientOf(light, {1, 0, 0}) == glm::vec3(3.5f, 2, 0));  // kept below the most
  CHECK(ambientOf(light, {-1, 0, 0}) == glm::vec3(0, 2, 0));    // and above 0
  CHECK(ambientOf(light, {0, -1, 0}) == glm::vec3(1, 10, 0));
  CHECK(ambientOf(light, {0.5f, 0, 0.5f}) == glm::vec3(2.5f, 2, 1));
  const std::vector<glm::vec3> table{{5, 6, 7}};
  light.instances = table;
  CHECK(ambientOf(light, {1, 0, 0}, 0) == table[0]);
  CHECK(ambientOf(light, {1, 0, 0}, 1) == glm::vec3(3.5f, 2, 0));
  light.directions = cube(kSix).directions;
  CHECK(ambientOf(light, {0, -1, 0}, 1) == glm::vec3(1, 10, 0));
}

TEST_CASE("ambient light: of an environment it lies in its range, whatever the normal holds") {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Random random(5);
  AmbientLight light;
  for (int k = 0; k < 20; ++k) {
    light.environment = randomQuadric(random);
    for (const glm::vec3& n : {glm::vec3(0), glm::vec3(nan), glm::vec3(inf, 0, 0), glm::vec3(-inf, inf, 0), glm::vec3(1e20f, -1e30f, 0), glm::vec3(1e-40f, nan, 1)}) {
      const glm::vec3 la = ambientOf(light, n);
      for (int c = 0; c < 3; ++c) CHECK((la[c] >= 0 && la[c] <= light.environment->most[c]));
    }
  }
}

TEST_CASE("ambient light: one colour, a table of it and a cube of white are the same, to the bit") {
  const TestScene s = soupScene(4);
  const AmbientLight everywhere(glm::vec3(0.3f, 0.7f, 1.9f));
  const std::vector<glm::vec3> table(s.instances.size(), everywhere.color);
  AmbientLight byInstance(glm::vec3(9)), byNormal = everywhere;
  byInstance.instances = table;
  for (const glm::vec3& axis : kAxes) byNormal.directions.push_back({axis, glm::vec3(1)});
  for (auto albedo : {post::TransferAlbedo::Neighbour, post::TransferAlbedo::Radiance}) {
    AmbientSettings settings;
    settings.albedo = albedo;
    settings.radius = 1;
    const auto frame = [&](const AmbientLight& ambient) {
      PostFrame f;
      f.g = gbufferOf(s);
      runPost(f, s.camera, settings, raster::Target::Auto, post::Occlusion::Transfer, true, ambient);
      return f;
    };
    const PostFrame expected = frame(everywhere);
    CHECK(firstDifference(frame(byInstance), expected) == "");
    CHECK(firstDifference(frame(byNormal), expected) == "");
  }
}

TEST_CASE("ambient light: every variant equals its scalar twin, with every W") {
  for (uint32_t seed = 0; seed < 12; ++seed) {
    Random random(seed + 40);
    const TestScene s = soupScene(seed);
    std::vector<glm::vec3> table;
    for (size_t i = 0; 2 * i < s.instances.size(); ++i) table.push_back(random.vector(0, 2));  // half of them
    AmbientLight ambient(random.vector(0, 2));
    if (seed % 4 != 0) ambient.instances = table;
    if (seed % 3 != 1) ambient.environment = randomQuadric(random);
    for (int k = random.integer(0, 3) * 3; k > 0; --k) {
      const glm::vec3 f = random.vector(-1, 1), color = random.vector(0, 2), added = random.vector(0, 1);
      ambient.directions.push_back({f, color, seed % 2 ? added : glm::vec3(0)});
    }
    AmbientSettings settings;
    settings.radius = 1;
    settings.albedo = post::TransferAlbedo(seed % 3);
    PostFrame expected;
    expected.g = gbufferOf(s);
    const auto occlusion = seed == 5 ? post::Occlusion::Obscurance : post::Occlusion::Transfer;
    runPost(expected, s.camera, settings, std::nullopt, occlusion, true, ambient);
    for (raster::Target target : raster::supportedTargets()) {
      PostFrame found;
      found.g = gbufferOf(s);
      runPost(found, s.camera, settings, target, occlusion, true, ambient);
      INFO("seed " << seed << " target " << raster::targetName(target));
      REQUIRE(firstDifference(found, expected) == "");
    }
  }
}

TEST_CASE("ambient light: where there is none, glossy things have their own emission alone, as the twin says, beside others that are lit") {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    const TestScene s = soupScene(seed);
    std::vector<glm::vec3> table;
    for (size_t i = 0; i < s.instances.size(); ++i) table.push_back(i % 3 ? glm::vec3(0) : glm::vec3(0, 0, 0.5f));
    AmbientLight ambient(glm::vec3(0));
    if (seed % 2) ambient.instances = table;
    AmbientSettings settings;
    settings.radius = 1;
    const auto with = [&](const std::optional<raster::Target>& target) {
      PostFrame f;
      f.g = gbufferOf(s);
      runPost(f, s.camera, settings, target, post::Occlusion::Transfer, true, ambient, post::Brdf::Gltf);
      return f;
    };
    const PostFrame expected = with(std::nullopt);
    for (raster::Target target : raster::supportedTargets()) {
      INFO("seed " << seed << " target " << raster::targetName(target));
      REQUIRE(firstDifference(with(target), expected) == "");
    }
  }
}
