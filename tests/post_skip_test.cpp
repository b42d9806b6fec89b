// What is known to be open is not sampled, and no bit changes.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using post::AmbientSettings;
using post::DepthBounds;

namespace {

// Ground with a few boxes, seen at an angle that the seed chooses.
TestScene groundScene(uint32_t seed, int boxes, bool orthographic) {
  Random random(seed + 500);
  TestScene s;
  s.materials.resize(2);
  s.materials[0].baseColor = {0.7f, 0.6f, 0.5f, 1};
  s.materials[1].baseColor = {0.9f, 0.2f, 0.1f, 1};
  s.materials[0].doubleSided = s.materials[1].doubleSided = true;
  s.width = random.integer(100, 230);
  s.height = random.integer(70, 150);
  TestMesh& ground = s.addMesh();
  TestScene::addQuad(ground, {-30, 0, 30}, {30, 0, 30}, {30, 0, -30}, {-30, 0, -30});
  s.place(ground);
  for (int k = 0; k < boxes; ++k) {
    const glm::vec3 a{random.real(-3, 2), 0, random.real(-6, 2)}, b = a + random.vector(0.2f, 0.9f);
    TestMesh& box = s.addMesh();
    TestScene::addQuad(box, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
    TestScene::addQuad(box, {b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z});
    TestScene::addQuad(box, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z});
    TestScene::addQuad(box, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z});
    s.place(box, 1);
  }
  const double aspect = double(s.width) / s.height;
  s.camera = orthographic ? raster::orthographic(2, 2 / aspect, 0.1, 50) : raster::perspective(0.4, aspect, 0.1);
  const glm::dvec3 eye(random.real(-2, 2), random.real(0.5f, 5), random.real(3, 6));
  const glm::dvec3 up(random.real(-0.6f, 0.6f), 1, 0);
  s.camera.viewFromWorld = raster::lookAt(eye, {random.real(-1, 1), 0, random.real(-2, 0)}, up);
  return s;
}

AmbientSettings settingsOf(uint32_t seed) {
  Random random(seed + 900);
  AmbientSettings s;
  s.albedo = post::TransferAlbedo(seed % 3);
  s.membership = post::Membership(seed % 4);
  s.samples = random.integer(1, 16);
  s.steps = seed % 5 == 0 ? random.integer(2, 4) : 1;
  s.radius = random.real(0.1f, 0.8f);
  s.bias = seed % 4 == 3 ? 0 : s.radius * random.real(0, 0.02f);
  s.silhouetteBound = seed % 8 < 5;
  s.filter = seed % 7 != 0;
  s.interleave = seed % 6 != 0;
  s.layers = seed % 4 == 1 ? 2 : 1;
  constexpr post::Estimator kOthers[] = {post::Estimator::Sobol, post::Estimator::March, post::Estimator::Box};
  s.estimator = seed % 4 == 2 ? kOthers[seed / 4 % 3] : post::Estimator::Paper;
  s.filterThreshold = s.radius / 5;
  return s;
}

uint64_t pixelsOf(const post::TransferStatistics& s) { return s.empty + s.open + s.sampled; }

}  // namespace

TEST_CASE("skip: ground with boxes has the same bits whether open blocks are sampled or not") {
  uint64_t open = 0, seen = 0;
  for (uint32_t seed = 0; seed < 32; ++seed) {
    const TestScene s = groundScene(seed, int(seed % 4), seed % 5 == 4);
    PostFrame expected;
    expected.g = gbufferOf(s);
    runPost(expected, s.camera, settingsOf(seed), std::nullopt);
    std::optional<post::TransferStatistics> first;
    for (raster::Target target : raster::supportedTargets())
      for (bool skip : {true, false}) {
        if (!skip && target != raster::supportedTargets().front()) continue;
        INFO("seed " << seed << " target " << raster::targetName(target) << " skip " << skip);
        PostFrame found;
        found.g = gbufferOf(s);
        runPost(found, s.camera, settingsOf(seed), target, post::Occlusion::Transfer, skip);
        REQUIRE(firstDifference(found, expected) == "");
        CHECK(pixelsOf(found.statistics) == uint64_t(s.width) * uint64_t(s.height));
        if (!skip) CHECK(found.statistics.open == 0);
        if (skip && !first) first = found.statistics;
        if (skip) CHECK((found.statistics.open == first->open && found.statistics.sampled == first->sampled));
      }
    if (settingsOf(seed).estimator != post::Estimator::Paper) continue;  // short rays leave less to be known
    open += first->open;
    seen += first->open + first->sampled;
  }
  INFO(open << " of " << seen << " pixels");
  CHECK(open * 4 > seen);  // else this test would show nothing
}

TEST_CASE("skip: bare ground is hardly sampled, by perspective and by orthographic cameras") {
  for (uint32_t seed = 0; seed < 8; ++seed) {
    TestScene s = groundScene(seed, 0, seed % 2 == 1);
    s.width = s.height = 240;
    s.camera.viewFromWorld = raster::lookAt({0.1 * seed, 4, 4}, {0, 0, 0}, {0, 1, 0});
    AmbientSettings settings;
    settings.radius = 0.3f;
    settings.bias = 0.01f;
    for (post::Estimator estimator : {post::Estimator::Paper, post::Estimator::March}) {
      settings.estimator = estimator;
      PostFrame f;
      f.g = gbufferOf(s);
      runPost(f, s.camera, settings, raster::Target::Auto);
      INFO("seed " << seed << " estimator " << int(estimator) << " open " << f.statistics.open << " sampled " << f.statistics.sampled);
      CHECK(f.statistics.open > 2 * f.statistics.sampled);
    }
  }
}

TEST_CASE("skip: it does not matter how the rows are divided") {
  const TestScene s = groundScene(3, 2, false);
  PostFrame whole;
  whole.g = gbufferOf(s);
  runPost(whole, s.camera, settingsOf(2), raster::Target::Auto);
  for (int rows : {1, 3, 8, 13}) {
    post::TransferSums sums = post::makeTransferSums(whole.in);
    post::TransferStatistics statistics;
    for (int y = 0; y < s.height; y += rows)
      statistics.add(post::ambientTransfer(whole.in, y, std::min(y + rows, s.height), sums, raster::Target::Auto));
    INFO("rows " << rows);
    CHECK(firstDifference("numerator", sums.numerator, whole.sums.numerator) == "");
    CHECK(statistics.open == whole.statistics.open);
    CHECK(statistics.sampled == whole.statistics.sampled);
  }
}

TEST_CASE("bounds: no texel lies before the plane of its cell, whatever the depth map holds") {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const float odd[] = {0, -0.f, inf, -inf, nan, 1e30f, 1e-40f, -1, 3e38f, 1e-30f};
  for (uint32_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    raster::PlaneSet planes;
    planes.depth = true;
    raster::GBuffer g(random.integer(1, 70), random.integer(1, 40), planes);
    const float slopeX = random.real(-0.02f, 0.02f), slopeY = random.real(-0.02f, 0.02f), noise = random.real(0, 0.1f);
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) {
        g.depth.at(x, y) = 1 / (2 + slopeX * float(x) + slopeY * float(y) + noise * random.real(-1, 1));
        if (seed % 3 == 0 && random.integer(0, 30) == 0) g.depth.at(x, y) = odd[random.integer(0, 9)];
      }
    post::Projector projector;
    projector.perspective = seed % 2 == 0;
    for (raster::Target target : raster::supportedTargets()) {
      DepthBounds bounds = post::makeDepthBounds(g.width, g.height);
      post::boundDepth(g, projector, 0, bounds.c.height(), bounds, target);
      int wrong = 0;
      for (int y = 0; y < g.height; ++y)
        for (int x = 0; x < g.width; ++x) {
          const int column = x / DepthBounds::kCellWidth, row = y / DepthBounds::kCellHeight;
          const float z = g.depth.at(x, y), c = bounds.c.at(column, row);
          if (!(z < inf) || c == inf) continue;
          const double w = projector.perspective ? 1 / double(z) : -double(z);
          const double a = bounds.a.at(column, row), b = bounds.b.at(column, row);
          const double most = a * (x + 0.5) + b * (y + 0.5) + c;
          wrong += !(z > 0 && w <= most && bounds.nearest.at(column, row) <= z);
        }
      INFO("seed " << seed << " target " << raster::targetName(target));
      CHECK(wrong == 0);
    }
  }
}
