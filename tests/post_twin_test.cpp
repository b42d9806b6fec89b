// Every pass equals its scalar twin, on real G-buffers and on impossible ones.
#include <catch2/catch.hpp>

#include <limits>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using post::AmbientSettings;

namespace {

AmbientSettings settingsOf(uint32_t seed) {
  Random random(seed + 100);
  AmbientSettings s;
  s.albedo = post::TransferAlbedo(seed % 3);
  s.membership = post::Membership(seed % 4);
  s.samples = seed % 5 == 0 ? 1 : random.integer(1, 20);
  s.steps = random.integer(1, 4);
  s.radius = random.real(0.1f, 2);
  s.bias = random.real(0, 0.02f);
  s.silhouetteBound = seed % 3 != 1;
  s.interleave = seed % 3 != 0;
  s.filter = seed % 7 != 0;
  s.estimator = post::Estimator(seed / 2 % 5);
  s.layers = seed % 3 == 2 ? 2 : 1;
  s.filterGuide = seed / 3 % 2 ? post::FilterGuide::Plane : post::FilterGuide::Depth;
  s.filterThreshold = random.real(0.05f, 0.5f);
  return s;
}

const post::AmbientLight kAmbient(glm::vec3(0.9f, 1, 1.3f));
post::Brdf brdfOf(uint32_t seed) { return post::Brdf(seed / 2 % 4); }

}  // namespace

TEST_CASE("post: every pass equals its scalar twin on rendered scenes") {
  for (uint32_t seed = 0; seed < 40; ++seed) {
    const TestScene s = soupScene(seed);
    PostFrame expected;
    expected.g = gbufferOf(s);
    const auto occlusion = post::Occlusion(seed % 3);
    runPost(expected, s.camera, settingsOf(seed), std::nullopt, occlusion, true, kAmbient, brdfOf(seed));
    for (raster::Target target : raster::supportedTargets()) {
      PostFrame found;
      found.g = gbufferOf(s);
      runPost(found, s.camera, settingsOf(seed), target, occlusion, true, kAmbient, brdfOf(seed));
      INFO("seed " << seed << " target " << raster::targetName(target));
      REQUIRE(firstDifference(found, expected) == "");
    }
  }
}

TEST_CASE("post: whatever the G-buffer holds, twins agree and O and W lie in [0, 1], but for that of radiance, which is a number") {
  for (uint32_t seed = 0; seed < 40; ++seed) {
    const raster::Camera camera = seed % 4 == 1 ? raster::orthographic(2, 1, 0.1, 50) : raster::perspective(1, 2, 0.1);
    PostFrame expected;
    expected.g = hostileGBuffer(seed);
    runPost(expected, camera, settingsOf(seed), std::nullopt, post::Occlusion::Transfer, true, kAmbient, brdfOf(seed));
    const bool stored = settingsOf(seed).albedo == post::TransferAlbedo::Radiance;
    const float most = stored ? std::numeric_limits<float>::max() : 1;
    for (int y = 0; y < expected.g.height; ++y)
      for (int x = 0; x < expected.g.width; ++x) {
        REQUIRE((expected.transfer.obscurance.at(x, y) >= 0 && expected.transfer.obscurance.at(x, y) <= 1));
        for (int c = 0; c < 3; ++c) REQUIRE((expected.transfer.w[c].at(x, y) >= 0 && expected.transfer.w[c].at(x, y) <= most));
      }
    for (raster::Target target : raster::supportedTargets()) {
      PostFrame found;
      found.g = hostileGBuffer(seed);
      runPost(found, camera, settingsOf(seed), target, post::Occlusion::Transfer, true, kAmbient, brdfOf(seed));
      INFO("seed " << seed << " target " << raster::targetName(target));
      for (int c = 0; c < 3; ++c) {
        CHECK(firstDifference("transfer", found.transfer.w[c], expected.transfer.w[c]) == "");
        CHECK(firstDifference("display", found.display.rgba, expected.display.rgba) == "");
      }
      CHECK(firstDifference("obscurance", found.transfer.obscurance, expected.transfer.obscurance) == "");
    }
  }
}

TEST_CASE("post: a twin that computes anything else is noticed") {
  // Every knob is turned in the twin alone, as a mistake in it would; each must change some bit.
  const TestScene s = soupScene(2);
  AmbientSettings base;
  base.radius = 1;
  PostFrame right;
  right.g = gbufferOf(s);
  runPost(right, s.camera, base, raster::Target::Auto);
  auto noticed = [&](AmbientSettings changed) {
    PostFrame wrong;
    wrong.g = gbufferOf(s);
    runPost(wrong, s.camera, changed, std::nullopt);
    return firstDifference(wrong, right) != "";
  };
  CHECK_FALSE(noticed(base));
  auto with = [&](auto change) {
    AmbientSettings m = base;
    change(m);
    return noticed(m);
  };
  CHECK(with([](AmbientSettings& m) { m.steps = 2; }));
  CHECK(with([](AmbientSettings& m) { m.layers = 2; }));
  CHECK(with([](AmbientSettings& m) { m.bias = 0.02f; }));
  CHECK(with([](AmbientSettings& m) { m.silhouetteBound = false; }));
  CHECK(with([](AmbientSettings& m) { m.interleave = false; }));
  CHECK(with([](AmbientSettings& m) { m.filter = false; }));
  CHECK(with([](AmbientSettings& m) { m.filterThreshold = 0.05f; }));
  CHECK(with([](AmbientSettings& m) { m.filterGuide = post::FilterGuide::Plane; }));
  CHECK(with([](AmbientSettings& m) { m.membership = post::Membership::Sqrt; }));
  CHECK(with([](AmbientSettings& m) { m.radius = 1.01f; }));
  CHECK(with([](AmbientSettings& m) { m.estimator = post::Estimator::Box; }));
  base.estimator = post::Estimator::March;
  base.steps = 3;
  runPost(right, s.camera, base, raster::Target::Auto);
  CHECK_FALSE(noticed(base));
  CHECK(with([](AmbientSettings& m) { m.estimator = post::Estimator::Box; }));
  CHECK(with([](AmbientSettings& m) { m.steps = 4; }));
  CHECK(with([](AmbientSettings& m) { m.layers = 2; }));
  CHECK(with([](AmbientSettings& m) { m.bias = 0.02f; }));
  CHECK(with([](AmbientSettings& m) { m.silhouetteBound = false; }));
}

TEST_CASE("display: every byte begins at its threshold, for all floats near it") {
  const post::DisplayTable table;
  std::vector<float> values{-1, -0.f, 0, 1e-42f, 0.5f, 1, 2, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()};
  for (int k = 1; k < 256; ++k)
    for (int step = -2; step <= 2; ++step) {
      uint32_t bits;
      std::memcpy(&bits, &table.threshold[k], 4);
      bits += uint32_t(step);
      float v;
      std::memcpy(&v, &bits, 4);
      values.push_back(v);
    }
  for (uint32_t upper = 0x3800; upper <= 0x3F80; ++upper) {
    const uint32_t bits = upper << 16 | 0x8000;
    float v;
    std::memcpy(&v, &bits, 4);
    values.push_back(v);
  }
  const int width = int(values.size());
  post::LinearColor color = post::makeLinearColor(width, 1);
  for (auto& plane : color.rgb) std::copy(values.begin(), values.end(), plane.row(0));
  post::DisplayImage expected = post::makeDisplayImage(width, 1);
  post::displayRef(color, table, 0, 1, expected);
  for (raster::Target target : raster::supportedTargets()) {
    post::DisplayImage found = post::makeDisplayImage(width, 1);
    post::display(color, table, 0, 1, found, target);
    INFO(raster::targetName(target));
    CHECK(firstDifference("display", found.rgba, expected.rgba) == "");
  }
  CHECK((expected.rgba.at(0, 0) & 255) == 0);
  CHECK((expected.rgba.at(4, 0) & 255) == 188);  // linear 0.5
  CHECK((expected.rgba.at(5, 0) & 255) == 255);
}
