// What nobody reads of the ambient transfer is not computed, and no bit of what is read changes.
#include <catch2/catch.hpp>

#include <limits>

#include "obscura/post/asked.h"
#include "frame_checks.h"

using namespace obscura;
using namespace obscura::tests;
using engine::Aov;
using raster::Window;

namespace {

engine::FrameSettings settingsOf(const TestScene& scene, uint32_t seed) {
  engine::FrameSettings s;
  s.width = 90, s.height = 60;
  s.camera = scene.camera;
  s.transfer.radius = 0.7f, s.transfer.bias = 0.01f, s.transfer.filterThreshold = 0.2f;
  s.transfer.albedo = post::TransferAlbedo(seed % 3);
  s.brdf = post::Brdf(seed / 3 % 4);
  s.transfer.filter = seed % 4 != 3;
  s.transfer.estimator = post::Estimator(seed / 2 % 5);
  s.ambient = seed % 5 == 4 ? post::Occlusion::Obscurance : post::Occlusion::Transfer;
  return s;
}

// Most of it black, unlit or without ambient light, as the seed chooses.
engine::Scene mostlyDark(const TestScene& soup, uint32_t seed) {
  engine::Scene scene = sceneFrom(soup);
  raster::Material& plain = scene.materials[0];
  if (seed % 3 == 0) plain.baseColor = {0, 0, 0, 1};
  if (seed % 3 == 1) plain.unlit = true;
  if (seed % 3 == 2)
    for (engine::Instance& i : scene.instances) i.ambient = glm::vec3(0, i.mesh % 2 ? 1 : 0, 0);
  return scene;
}

}  // namespace

TEST_CASE("asked: sixteen pixels of a row are asked for where the filter's window of an asking pixel meets them") {
  Random random(1);
  for (int round = 0; round < 60; ++round) {
    raster::PlaneSet planes;
    planes.depth = planes.albedo = planes.instance = true;
    raster::GBuffer g(random.integer(1, 70), random.integer(1, 12), planes);
    const std::vector<glm::vec3> ambient = {{0, 0, 0}, {0, 0, 2}};
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) {
        g.instance.at(x, y) = uint32_t(random.integer(0, 2));
        g.depth.at(x, y) = random.integer(0, 90) == 0 ? std::numeric_limits<float>::infinity() : 1;
        for (int c = 0; c < 3; ++c) g.albedo[c].at(x, y) = random.integer(0, 60) == 0 ? 0.5f : 0;
      }
    post::AskedInput in{&g, {}, round % 2 == 0, round % 3 != 0, {}};
    if (round % 4 != 0) in.ambient = ambient;
    in.part.x = random.integer(0, g.width - 1), in.part.y = random.integer(0, g.height - 1);
    in.part.width = random.integer(1, g.width - in.part.x), in.part.height = random.integer(1, g.height - in.part.y);

    raster::Plane<uint8_t> expected((g.width + 15) / 16, g.height), found(expected.width(), g.height);
    for (int y = 0; y < g.height; ++y) std::fill_n(expected.row(y), expected.width(), uint8_t(0));
    for (int y = in.part.y; y < in.part.y + in.part.height; ++y)
      for (int x = in.part.x; x < in.part.x + in.part.width; ++x) {
        const bool reflects = g.albedo[0].at(x, y) > 0 || g.albedo[1].at(x, y) > 0 || g.albedo[2].at(x, y) > 0;
        const bool arrives = in.ambient.empty() || g.instance.at(x, y) != 0;
        if (in.onlyLit && !(reflects && arrives) && g.depth.at(x, y) == 1) continue;
        for (int v = y - 2 * in.filter; v <= y + in.filter; ++v)
          for (int u = x - 2 * in.filter; u <= x + in.filter; ++u)
            if (u >= 0 && v >= 0 && u < g.width && v < g.height) expected.at(u / 16, v) = 1;
      }
    for (int y = 0; y < g.height; y += 5) post::askedPixels(in, y, std::min(y + 5, g.height), found);
    INFO("round " << round);
    for (int y = 0; y < g.height; ++y) REQUIRE(std::equal(found.row(y), found.row(y) + found.width(), expected.row(y)));
  }
}

TEST_CASE("asked: pictures of scenes that reflect little are those with every pixel sampled, and of the twins") {
  uint64_t unasked = 0;
  for (uint32_t seed = 0; seed < 24; ++seed) {
    const TestScene soup = soupScene(seed);
    const engine::Scene scene = mostlyDark(soup, seed);
    engine::FrameSettings s = settingsOf(soup, seed);
    if (seed % 4 == 1) s.crop = Window{30, 10, 25, 20};
    s.supersample = seed % 8 == 2 ? 2 : 1;
    const engine::Image expected = apps::planeImage(frameOf(scene, s, {1, raster::Target::Auto, 64, false}), Aov::Color);
    INFO("seed " << seed);
    REQUIRE((apps::planeImage(frameOf(scene, s, {}, true), Aov::Color).bytes == expected.bytes));
    for (raster::Target target : raster::supportedTargets()) {
      const engine::Frame frame = frameOf(scene, s, {2, target, 32, true});
      REQUIRE((apps::planeImage(frame, Aov::Color).bytes == expected.bytes));
      unasked += frame.transferStatistics.unasked;
      // Who asks for O gets all of it.
      engine::FrameSettings all = s;
      all.aovs = {Aov::Color, Aov::Obscurance};
      if (!s.crop) CHECK(frameOf(scene, all, {2, target, 32, true}).transferStatistics.unasked == 0);
    }
  }
  CHECK(unasked > 10000);
}

TEST_CASE("asked: of a crop only the pixels are sampled that its filter reads, in whole sixteens") {
  const TestScene soup = soupScene(4);
  const engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup, 0);
  s.width = 400, s.height = 40;
  s.transfer.radius = 100;  // reads everywhere
  s.crop = Window{200, 10, 16, 16};
  s.aovs = {Aov::Obscurance};
  const post::TransferStatistics t = frameOf(scene, s).transferStatistics;
  CHECK(t.unasked > 400 * 10);
  CHECK(t.unasked + t.empty + t.open + t.sampled == 400 * 19);
  CHECK(t.empty + t.open + t.sampled <= 19 * 48);
}

TEST_CASE("asked: without ambient light nothing is sampled, and what emits shines") {
  const TestScene soup = soupScene(4);
  engine::Scene scene = sceneFrom(soup);
  for (engine::Instance& i : scene.instances) i.ambient.reset();
  scene.materials[0].emissive = {1, 2, 3};
  engine::FrameSettings s = settingsOf(soup, 0);
  s.ambientLight = glm::vec3(0);
  const engine::Frame frame = frameOf(scene, s);
  const post::TransferStatistics& t = frame.transferStatistics;
  CHECK(t.unasked + t.empty + t.open + t.sampled == 0);
  CHECK(frame.transfer.w[0].empty());
  int shining = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) shining += frame.color.rgb[2].at(x, y) == 3;
  CHECK(shining > 20);
  s.aovs = {Aov::Color, Aov::Transfer};
  CHECK((apps::planeImage(frameOf(scene, s), Aov::Color).bytes == apps::planeImage(frame, Aov::Color).bytes));
}
