// Crops and borders of whole frames: what is drawn around a crop is enough, and it is what the whole frame shows.
#include <catch2/catch.hpp>

#include <cmath>

#include "obscura/engine/crop.h"
#include "obscura/raster/parallel.h"
#include "frame_checks.h"

using namespace obscura;
using namespace obscura::tests;
using engine::Aov;
using raster::Window;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

void paste(const engine::Image& from, const Window& w, engine::Image& to) {
  REQUIRE((from.width == w.width && from.height == w.height));
  const size_t pixel = size_t(to.channels) * bytesOf(to.format);
  for (int y = 0; y < w.height; ++y)
    std::memcpy(&to.bytes[(size_t(w.y + y) * size_t(to.width) + size_t(w.x)) * pixel],
                &from.bytes[size_t(y) * size_t(w.width) * pixel], size_t(w.width) * pixel);
}

// Four columns and four rows of uneven, odd sizes.
std::vector<Window> sixteenth(int width, int height, Random& random) {
  int xs[5] = {0, 0, 0, 0, width}, ys[5] = {0, 0, 0, 0, height};
  for (int k = 1; k < 4; ++k) xs[k] = k * width / 4 + random.integer(-3, 3), ys[k] = k * height / 4 + random.integer(-3, 3);
  std::vector<Window> all;
  for (int k = 0; k < 16; ++k)
    all.push_back({xs[k % 4], ys[k / 4], xs[k % 4 + 1] - xs[k % 4], ys[k / 4 + 1] - ys[k / 4]});
  return all;
}

engine::FrameSettings settingsOf(const TestScene& scene, uint32_t seed) {
  Random random(seed + 7);
  engine::FrameSettings s;
  s.width = 60 + random.integer(0, 30), s.height = 50 + random.integer(0, 20);
  s.camera = scene.camera;
  if (seed % 3 == 1) s.camera.xShift = -0.6f, s.camera.yShift = 0.4f;
  s.border = seed % 2 ? random.integer(1, 30) : 0;
  s.supersample = seed == 4 || seed == 13 ? 2 : 1;
  s.aovs = allAovs();
  s.display = true;
  s.background = {0.2f, 0.3f, 0.4f};
  if (seed % 4 == 0) s.ambientDirections = seed % 8 ? sixDirections() : addingDirections(9);
  post::AmbientSettings& t = s.transfer;
  t.albedo = post::TransferAlbedo((seed + seed / 4) % 3);
  t.membership = seed % 2 ? post::Membership::Classic : post::Membership::Linear;
  t.samples = random.integer(4, 12), t.steps = random.integer(1, 2);
  t.radius = random.real(0.1f, 0.8f);
  t.interleave = seed % 5 != 4;
  t.filter = seed % 7 != 6;
  t.filterThreshold = seed % 2 ? 100.f : 0.1f;
  t.estimator = post::Estimator(seed % 5);
  t.layers = seed % 5 == 2 ? 2 : 1;
  if (t.estimator == post::Estimator::Lines) t.membership = post::Membership::Linear;
  t.filterGuide = seed % 4 == 1 ? post::FilterGuide::Plane : post::FilterGuide::Depth;
  return s;
}

}  // namespace

TEST_CASE("crop: sixteen crops, each by threads, target, tile size and skipping of its own, make up the whole frame") {
  raster::withThreads(8, [] {
    const std::vector<raster::Target> targets = raster::supportedTargets();
    int seen = 0;
    for (uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 10u, 13u, 16u, 19u}) {
      const TestScene soup = soupScene(seed);
      const engine::Scene scene = sceneFrom(soup);
      engine::FrameSettings s = settingsOf(soup, seed);
      const std::vector<engine::Image> expected = imagesOf(frameOf(scene, s));
      std::vector<engine::Image> stitched = expected;
      for (engine::Image& image : stitched) std::fill(image.bytes.begin(), image.bytes.end(), uint8_t(0xA5));
      Random random(seed);
      uint32_t k = seed;
      for (const Window& w : sixteenth(s.width, s.height, random)) {
        s.crop = w;
        const raster::Settings raster{1 << k % 4, targets[k % targets.size()], 16 << k % 3, k % 5 != 0};
        const engine::Frame frame = frameOf(scene, s, raster, ++k % 16 == 0);
        CHECK((frame.x == w.x && frame.y == w.y && frame.imageWidth == s.width && frame.imageHeight == s.height));
        const std::vector<engine::Image> images = imagesOf(frame);
        for (size_t i = 0; i < images.size(); ++i) paste(images[i], w, stitched[i]);
      }
      for (size_t i = 0; i < expected.size(); ++i) {
        INFO("seed " << seed << ", " << (i < allAovs().size() ? engine::allAovs()[i].name : "display") << ", border " << s.border);
        REQUIRE((stitched[i].bytes == expected[i].bytes));
      }
      for (const uint8_t b : expected.back().bytes) seen += b != 0;
    }
    CHECK(seen > 10000);
  });
}

TEST_CASE("frame: O alone, without W and albedo, is the O of a frame with all") {
  const TestScene soup = soupScene(5);
  const engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup, 5);
  s.transfer.albedo = post::TransferAlbedo::Neighbour;
  const engine::Image expected = apps::planeImage(frameOf(scene, s), Aov::Obscurance);
  s.aovs = {Aov::Obscurance};
  s.display = false;
  for (bool reference : {false, true})
    CHECK((apps::planeImage(frameOf(scene, s, {}, reference), Aov::Obscurance).bytes == expected.bytes));
}

TEST_CASE("crop: one crop has the same bits by all threads, targets, tile sizes and the scalar twins") {
  raster::withThreads(8, [] {
    const TestScene soup = soupScene(5);
    const engine::Scene scene = sceneFrom(soup);
    engine::FrameSettings s = settingsOf(soup, 5);
    s.border = 11;
    const std::vector<engine::Image> whole = imagesOf(frameOf(scene, s));
    s.crop = Window{0, 13, 37, 21};
    const auto check = [&](const engine::Frame& frame) {
      const std::vector<engine::Image> images = imagesOf(frame);
      for (size_t i = 0; i < images.size(); ++i) {
        engine::Image same = whole[i];
        paste(images[i], *s.crop, same);
        REQUIRE((same.bytes == whole[i].bytes));
      }
    };
    check(frameOf(scene, s, {}, true));
    for (raster::Target target : raster::supportedTargets())
      for (int tile : {16, 32, 64})
        for (int count : {1, 3})
          for (bool skip : {true, false}) {
            INFO(raster::targetName(target) << ", tile " << tile << ", " << count << " threads, skip " << skip);
            check(frameOf(scene, s, {count, target, tile, skip}));
          }
  });
}

TEST_CASE("crop: a renderer that draws crops, borders and whole frames in turn mixes nothing up") {
  const TestScene soup = soupScene(4);
  const engine::Scene scene = sceneFrom(soup);
  engine::Renderer renderer;
  engine::Frame frame;
  for (int round = 0; round < 8; ++round) {
    engine::FrameSettings s = settingsOf(soup, 4);
    s.border = round % 3 == 1 ? 20 : 0;
    if (round % 2) s.crop = Window{round, 2 * round, 20 + round, 31};
    if (round > 5) s.aovs = {Aov::Normal, Aov::Color, Aov::Depth}, s.display = false;
    REQUIRE(renderer.render(scene, s, frame).ok());
    const engine::Frame fresh = frameOf(scene, s);
    REQUIRE((frame.width == fresh.width && frame.g.width == fresh.width && frame.g.height == fresh.height));
    for (Aov aov : s.aovs) {
      INFO("round " << round << ", " << engine::infoOf(aov).name);
      REQUIRE((apps::planeImage(frame, aov).bytes == apps::planeImage(fresh, aov).bytes));
    }
  }
}

TEST_CASE("crop: no test point of the transfer is projected outside of what is drawn for it") {
  Random random(3);
  int smaller = 0, points = 0;
  for (int round = 0; round < 400; ++round) {
    engine::FrameSettings s;
    s.width = random.integer(50, 4000), s.height = random.integer(50, 3000), s.border = random.integer(0, 200);
    const double aspect = double(s.width) / s.height;
    const bool flat = round % 4 == 3;
    s.camera = flat ? raster::orthographic(3 * aspect, 3, 0.1, 50)
                    : raster::perspective(random.real(0.1f, 2.5f), aspect, random.real(0.001f, 0.3f));
    if (round % 3 == 0) s.camera.xShift = random.real(-2, 2), s.camera.yShift = random.real(-2, 2);
    s.transfer.radius = random.real(0.01f, 1);
    s.transfer.filter = round % 2 == 0;
    const int x = random.integer(0, s.width - 1), y = random.integer(0, s.height - 1);
    s.crop = Window{x, y, random.integer(1, s.width - x), random.integer(1, s.height - y)};
    const float nearest = random.real(s.camera.zNear, 8);
    const Window whole = engine::wholeWindow(s), from = engine::filteredWindow(s), drawn = engine::transferWindow(s, nearest);
    const post::Projector p = post::makeProjector(s.camera, s.width, s.height);
    smaller += drawn.width < whole.width && drawn.height < whole.height;
    for (int i = 0; i < 300; ++i) {
      // Mostly the corners at the smallest depth: that is where points go farthest.
      const double u = from.x + (i & 1 ? from.width - 0.5 : 0.5), v = from.y + (i & 2 ? from.height - 0.5 : 0.5);
      const double z = i & 12 ? nearest : random.real(nearest, 2 * nearest), depth = flat ? 1 : z;
      glm::dvec3 d = random.vector(-1, 1);
      d *= s.transfer.radius / std::sqrt(glm::dot(d, d));
      if (z + d.z <= p.zNear) continue;
      const double w = flat ? 1 : z + d.z;
      const double px = std::floor(((u - p.xCenter) / p.xScale * depth + d.x) / w * p.xScale + p.xCenter);
      const double py = std::floor(((v - p.yCenter) / p.yScale * depth + d.y) / w * p.yScale + p.yCenter);
      const int column = int(std::clamp<double>(px, whole.x, whole.x + whole.width - 1));
      const int row = int(std::clamp<double>(py, whole.y, whole.y + whole.height - 1));
      ++points;
      INFO("round " << round << ": pixel " << u << ", " << v << " at " << z << " reads " << column << ", " << row << "; drawn are "
                    << drawn.x << "," << drawn.y << " " << drawn.width << "x" << drawn.height);
      REQUIRE((column >= drawn.x && column < drawn.x + drawn.width && row >= drawn.y && row < drawn.y + drawn.height));
    }
    CHECK(engine::transferWindow(s, kInfinity).width == from.width);
  }
  CHECK(smaller > 100);
  CHECK(points > 50000);
}

TEST_CASE("crop: what the filter reads beside a crop decides, too, how far around it has to be drawn") {
  // A near strip just left of the crop at 40: its samples reach the panel on the right, those of the far wall do not.
  TestScene t;
  t.materials.resize(1);
  TestMesh& m = t.addMesh();
  TestScene::addQuad(m, {-40, -40, -20}, {40, -40, -20}, {40, 40, -20}, {-40, 40, -20});
  TestScene::addQuad(m, {-0.04f, -2, -1}, {0, -2, -1}, {0, 2, -1}, {-0.04f, 2, -1});
  TestScene::addQuad(m, {0.14f, -2, -0.6f}, {0.4f, -2, -0.6f}, {0.4f, 2, -0.6f}, {0.14f, 2, -0.6f});
  t.place(m);
  const engine::Scene scene = sceneFrom(t);
  engine::FrameSettings s;
  s.width = s.height = 80;
  s.camera = raster::perspective(1.2, 1, 0.05);
  s.transfer.radius = 0.6f, s.transfer.samples = 16, s.transfer.filterThreshold = 1000, s.transfer.bias = 0.01f;
  s.aovs = {Aov::Obscurance};
  const engine::Image whole = apps::planeImage(frameOf(scene, s), Aov::Obscurance);
  for (int x = 38; x <= 42; ++x) {
    s.crop = Window{x, 30, 3, 20};
    engine::Image same = whole;
    paste(apps::planeImage(frameOf(scene, s), Aov::Obscurance), *s.crop, same);
    INFO(x);
    CHECK((same.bytes == whole.bytes));
  }
}

TEST_CASE("border: a wall just off screen darkens the floor beside it, and only that") {
  TestScene t;
  t.materials.resize(1);
  TestMesh& m = t.addMesh();
  TestScene::addQuad(m, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9});   // floor
  TestScene::addQuad(m, {1.1f, 0, 9}, {1.1f, 3, 9}, {1.1f, 3, -9}, {1.1f, 0, -9});  // wall, facing -x
  t.materials[0].doubleSided = true;
  t.place(m);
  const engine::Scene scene = sceneFrom(t);
  engine::FrameSettings s;
  s.width = 100, s.height = 80;
  s.camera = raster::orthographic(1, 0.8, 0.1, 50);  // the wall stands 5 pixels beside the image
  s.camera.viewFromWorld = raster::lookAt({-0.6, 5, 0}, {0, 0, 0}, {0, 0, -1});
  s.camera.xShift = 0;
  s.transfer.radius = 0.5f, s.transfer.bias = 0.005f, s.transfer.samples = 32, s.transfer.filterThreshold = 0.2f;
  s.aovs = {Aov::Obscurance, Aov::Instance, Aov::Triangle};
  const engine::Frame without = frameOf(scene, s);
  s.border = 40;
  const engine::Frame with = frameOf(scene, s);
  REQUIRE((with.width == 100 && with.height == 80 && with.g.width == 100));
  REQUIRE(firstDifference("triangle", without.g.triangle, with.g.triangle) == "");
  for (int x = 0; x < 100; ++x) REQUIRE(with.g.triangle.at(x, 40) <= 1);  // the wall is not in the image
  CHECK(with.transfer.obscurance.at(98, 40) < without.transfer.obscurance.at(98, 40) - 0.05f);
  for (int x = 0; x < 60; ++x) CHECK(with.transfer.obscurance.at(x, 40) == without.transfer.obscurance.at(x, 40));
}

TEST_CASE("crop: what does not lie in the image, and borders beyond the guard band, are refused with their numbers") {
  const engine::Scene scene = sceneFrom(soupScene(4));
  engine::Renderer renderer;
  engine::Frame frame;
  const auto refused = [&](int border, std::optional<Window> crop, int width = 80) {
    engine::FrameSettings s;
    s.width = width, s.height = 60, s.border = border, s.crop = crop;
    const auto done = renderer.render(scene, s, frame);
    REQUIRE(!done);
    CHECK(done.error().code == engine::ErrorCode::Usage);
    return done.error().message;
  };
  constexpr int kMost = std::numeric_limits<int>::max();
  CHECK(refused(0, Window{70, 0, 11, 5}) == "the crop 70,0,11x5 does not lie in the image of 80x60 pixels");
  for (const Window& w : {Window{-1, 0, 5, 5}, Window{0, 56, 5, 5}, Window{0, 0, 0, 5}, Window{0, 0, 5, -5}, Window{0, 0, 81, 5},
                          Window{kMost, kMost, kMost, kMost}})
    CHECK(refused(0, w).find("does not lie in the image of 80x60") != std::string::npos);
  CHECK(refused(-1, {}).find("a border of -1 pixels") == 0);
  CHECK(refused(8153, {}).find("a border of 8153 pixels") == 0);
  CHECK(refused(kMost, {}).find("at most 16384 a side") != std::string::npos);
  CHECK(refused(1, {}, 16384).find("a border of 1 pixels") == 0);
  CHECK(refused(0, {}, 0).find("0x60") != std::string::npos);
}
