// W of stored radiance: what the occluders send out arrives, once.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using post::AmbientSettings;
using post::TransferAlbedo;

namespace {

constexpr float kMost = std::numeric_limits<float>::max();
const glm::vec3 kAmbient(0.9f, 1, 1.3f);

AmbientSettings storedRadiance(int samples = 32) {
  AmbientSettings s;
  s.albedo = TransferAlbedo::Radiance;
  s.samples = samples;
  s.radius = 1;
  s.bias = 0.03f;
  s.filterThreshold = 0.3f;
  return s;
}

// A floor, and a wall on its left that glows.
TestScene glowingCorner(const glm::vec3& glow, float albedo) {
  TestScene s;
  s.width = 90, s.height = 60;
  s.materials.resize(2);
  for (raster::Material& m : s.materials) m.doubleSided = true, m.baseColor = glm::vec4(glm::vec3(albedo), 1);
  s.materials[1].emissive = glow;
  TestMesh &floor = s.addMesh(), &wall = s.addMesh();
  TestScene::addQuad(floor, {0, 0, -4}, {0, 0, 4}, {4, 0, 4}, {4, 0, -4});
  TestScene::addQuad(wall, {0, 0, -4}, {0, 4, -4}, {0, 4, 4}, {0, 0, 4});
  s.place(floor), s.place(wall, 1);
  s.camera = raster::perspective(0.6, 1.5, 0.01);
  s.camera.viewFromWorld = raster::lookAt({1.2, 3, 0}, {0.4, 0, 0}, {0, 0, -1});
  return s;
}

PostFrame framed(const TestScene& s, const AmbientSettings& settings, const post::AmbientLight& ambient = kAmbient) {
  PostFrame f;
  f.g = gbufferOf(s);
  runPost(f, s.camera, settings, raster::Target::Auto, post::Occlusion::Transfer, true, ambient);
  return f;
}

template <class Visit>
void forSeen(const raster::GBuffer& g, const Visit& visit) {
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if (g.triangle.at(x, y) != raster::kNoTriangle) visit(x, y);
}

}  // namespace

TEST_CASE("radiance: a wall that glows by L sends L (1 - O) to the black floor, and W is O + that / La") {
  const glm::vec3 glow(0.25f, 3, 7);
  AmbientSettings settings = storedRadiance();
  settings.filter = false;  // windows over the corner would hold rays from the wall to the floor
  const PostFrame f = framed(glowingCorner(glow, 0), settings);
  float most = 0;
  forSeen(f.g, [&](int x, int y) {
    if (f.g.instance.at(x, y) != 0) return;
    const float o = f.transfer.obscurance.at(x, y);
    for (int c = 0; c < 3; ++c) {
      REQUIRE(std::fabs(f.transfer.bounced[c].at(x, y) - glow[c] * (1 - o)) < 1e-5f * glow[c]);
      REQUIRE(std::fabs(f.transfer.w[c].at(x, y) - (o + glow[c] * (1 - o) / kAmbient[c])) < 1e-5f * glow[c]);
    }
    most = std::max(most, f.transfer.w[2].at(x, y));
  });
  CHECK(most > 2);  // above 1, as it must be next to a light
}

TEST_CASE("radiance: W is at most the larger of 1 and L / La, and at most 1 where nothing glows") {
  for (uint32_t seed = 0; seed < 10; ++seed) {
    const bool glows = seed % 2;
    TestScene s = soupScene(seed);
    if (!glows)
      for (raster::Material& m : s.materials) m.unlit = false, m.emissive = glm::vec3(0);
    for (int samples : {1, 7}) {
      const PostFrame f = framed(s, storedRadiance(samples));
      for (int c = 0; c < 3; ++c) {
        float bound = 1;
        forSeen(f.g, [&](int x, int y) { bound = std::max(bound, f.radiance.rgb[c].at(x, y) / kAmbient[c]); });
        if (!glows) CHECK(bound < 1.000001f);
        int beyond = 0;
        forSeen(f.g, [&](int x, int y) {
          const float w = f.transfer.w[c].at(x, y);
          beyond += !(w >= f.transfer.obscurance.at(x, y) && w <= bound * 1.00001f);
        });
        INFO("seed " << seed << " channel " << c << " bound " << bound);
        CHECK(beyond == 0);
      }
    }
  }
}

TEST_CASE("radiance: where La is 0 W is O, and the picture has the bounced light all the same") {
  const glm::vec3 glow(2, 2, 2);
  TestScene s = glowingCorner(glow, 0.5f);
  const PostFrame f = framed(s, storedRadiance(), glm::vec3(0, 1, 0));
  float brightest = 0;
  forSeen(f.g, [&](int x, int y) {
    if (f.g.instance.at(x, y) != 0) return;
    const float bounced = f.transfer.bounced[0].at(x, y);
    REQUIRE(f.transfer.w[0].at(x, y) == f.transfer.obscurance.at(x, y));
    REQUIRE(f.color.rgb[0].at(x, y) == 0.5f * bounced);
    brightest = std::max(brightest, bounced);
  });
  CHECK(brightest > 0.5f);
}

TEST_CASE("radiance: the colour is albedo x W x La + emission") {
  const PostFrame f = framed(soupScene(10), storedRadiance());
  forSeen(f.g, [&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      const float lit = f.g.albedo[c].at(x, y) * f.transfer.w[c].at(x, y) * kAmbient[c] + f.g.emissive[c].at(x, y);
      REQUIRE(std::fabs(f.color.rgb[c].at(x, y) - lit) <= 1e-5f * lit);
    }
  });
}

TEST_CASE("radiance: without emission the first guess is one reflection, so W lies between O and that of all of them") {
  // O + a(1 - O) <= 1, and in a closed white room it is 1 as well.
  for (float albedo : {0.3f, 1.f}) {
    const PostFrame f = framed(glowingCorner(glm::vec3(0), albedo), storedRadiance());
    forSeen(f.g, [&](int x, int y) {
      const float o = f.transfer.obscurance.at(x, y);
      REQUIRE(std::fabs(f.transfer.w[1].at(x, y) - (o + albedo * (1 - o))) < 1e-5f);
    });
  }
}

TEST_CASE("radiance: any lit frame serves, and whatever it holds W is a number from O on, the same on every target") {
  const float odd[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(), kMost, -kMost, -1, 0, -0.f, 1e-42f, 1e30f};
  for (uint32_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    const TestScene s = soupScene(seed);
    PostFrame f;
    f.g = gbufferOf(s);
    f.in = transferInput(f.g, s.camera, storedRadiance(random.integer(1, 9)));
    f.in.settings.steps = random.integer(1, 2);
    f.in.settings.filter = seed % 3 != 0;
    f.radiance = post::makeLinearColor(s.width, s.height);
    for (auto& plane : f.radiance.rgb)
      for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x) plane.at(x, y) = random.integer(0, 20) ? random.real(0, 5) : odd[random.integer(0, 9)];
    f.in.radiance = &f.radiance;
    const post::AmbientLight ambient(glm::vec3(1, seed % 2 ? 0 : 1e-30f, std::numeric_limits<float>::denorm_min()));
    const post::LightInput light{&f.g, &f.transfer, post::Occlusion::Transfer, ambient, glm::vec3(0)};
    const auto made = [&] { return post::makeTransfer(s.width, s.height, {true, true, true}); };

    f.sums = post::makeTransferSums(f.in);
    f.transfer = made();
    post::ambientTransferRef(f.in, 0, s.height, f.sums);
    post::depthFilterRef(f.in, f.sums, 0, s.height, f.transfer);
    post::transferOfBouncedRef(light, 0, s.height, f.transfer.w);
    const post::Transfer expected = std::move(f.transfer);
    int wrong = 0;
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x) {
          const float w = expected.w[c].at(x, y), b = expected.bounced[c].at(x, y);
          wrong += !(w >= expected.obscurance.at(x, y) && w <= kMost && b >= 0 && b <= kMost);
        }
    INFO("seed " << seed);
    CHECK(wrong == 0);
    for (raster::Target target : raster::supportedTargets()) {
      INFO("target " << raster::targetName(target));
      f.transfer = made();
      post::ambientTransfer(f.in, 0, s.height, f.sums, target);
      post::depthFilter(f.in, f.sums, 0, s.height, f.transfer, target);
      post::transferOfBounced(light, 0, s.height, f.transfer.w, target);
      for (int c = 0; c < 3; ++c) {
        REQUIRE(firstDifference("bounced", f.transfer.bounced[c], expected.bounced[c]) == "");
        REQUIRE(firstDifference("w", f.transfer.w[c], expected.w[c]) == "");
      }
    }
  }
}

TEST_CASE("radiance: none, or one of another size than the G-buffer, is refused with the sizes") {
  raster::GBuffer g(20, 10, kAllPlanes);
  post::TransferInput in = transferInput(g, raster::perspective(1, 2, 0.1), storedRadiance());
  CHECK_THROWS_AS(post::makeTransferSums(in), std::invalid_argument);
  const post::LinearColor radiance = post::makeLinearColor(20, 9);
  in.radiance = &radiance;
  CHECK_THROWS_WITH(post::makeTransferSums(in), Catch::Contains("20x9") && Catch::Contains("20x10"));
}
