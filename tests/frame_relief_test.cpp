// Height maps in whole frames: the scene that obscura-scene writes.
#include "obscura/apps/demo_surfaces.h"
#include "obscura/engine/camera_choice.h"
#include "obscura/raster/parallel.h"
#include "obscura/tests/scene_of_glb.h"
#include "frame_checks.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

const engine::Scene& relief() {
  static const engine::Scene scene = sceneOfGlb(apps::makeReliefScene());
  return scene;
}

engine::FrameSettings settingsOf(int width, int height) {
  engine::FrameSettings s;
  s.width = width, s.height = height;
  s.camera = *engine::chooseCamera(relief(), {}, width, height);
  s.transfer.radius = 0.3f, s.transfer.bias = 0.003f, s.transfer.filterThreshold = 0.06f;
  s.aovs = allAovs();
  s.display = true;
  return s;
}

void checkSame(const engine::Frame& a, const engine::Frame& b) {
  const std::vector<engine::Image> left = imagesOf(a), right = imagesOf(b);
  for (size_t k = 0; k < left.size(); ++k) {
    INFO("plane " << k);
    REQUIRE(left[k].bytes == right[k].bytes);
  }
}

}  // namespace

TEST_CASE("relief frame: all planes have the bits of the reference on every target, with any tiles, threads, skipped or not") {
  raster::withThreads(8, [] {
    for (const post::TransferAlbedo albedo : {post::TransferAlbedo::Neighbour, post::TransferAlbedo::Radiance}) {
      engine::FrameSettings s = settingsOf(67, 45);
      s.transfer.albedo = albedo;
      s.transfer.layers = albedo == post::TransferAlbedo::Radiance ? 2 : 1;
      s.separation = s.transfer.radius;
      const engine::Frame expected = frameOf(relief(), s, {}, true);
      for (raster::Target target : raster::supportedTargets())
        for (int tile : {16, 32, 64}) {
          INFO(raster::targetName(target) << ", tiles of " << tile);
          checkSame(frameOf(relief(), s, {tile == 32 ? 1 : 3, target, tile, true}), expected);
          if (tile == 64) checkSame(frameOf(relief(), s, {2, target, tile, false}), expected);
        }
    }
  });
}

TEST_CASE("relief frame: a crop is what the whole frame shows, supersampled or not") {
  for (int supersample : {1, 2}) {
    engine::FrameSettings s = settingsOf(50, 40);
    s.supersample = supersample;
    const engine::Frame whole = frameOf(relief(), s);
    s.crop = raster::Window{13, 9, 21, 17};
    const engine::Frame part = frameOf(relief(), s);
    raster::Plane<float> cut;
    raster::cutOut(whole.g.depth, *s.crop, cut);
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 21; ++x) {
        REQUIRE(part.g.depth.at(x, y) == cut.at(x, y));
        for (int c = 0; c < 3; ++c) REQUIRE(part.color.rgb[c].at(x, y) == whole.color.rgb[c].at(x + 13, y + 9));
      }
  }
}

TEST_CASE("relief frame: without displacement it is the frame of the scene without height maps") {
  engine::FrameSettings s = settingsOf(50, 40);
  engine::Scene flat = relief();
  flat.heightMaps.clear();
  for (raster::Material& m : flat.materials) m.heightMap.texture = -1;
  const engine::Frame displaced = frameOf(relief(), s), plain = frameOf(flat, s);
  s.displacement = false;
  const engine::Frame off = frameOf(relief(), s);
  checkSame(off, plain);
  checkSame(frameOf(relief(), s, {}, true), plain);
  int deeper = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) deeper += displaced.g.depth.at(x, y) > off.g.depth.at(x, y);
  CHECK(deeper > 500);
}

TEST_CASE("relief frame: hollows are darker than tops, and nothing is where light cannot be") {
  engine::FrameSettings s = settingsOf(160, 120);
  const engine::Frame f = frameOf(relief(), s);
  double top = 0, hollow = 0;
  int tops = 0, hollows = 0;
  const glm::dmat4 worldFromView = glm::inverse(s.camera.viewFromWorld);
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const float o = f.transfer.obscurance.at(x, y);
      REQUIRE((o >= 0 && o <= 1));
      if (f.g.material.at(x, y) != 0) continue;
      const double height = (worldFromView * glm::dvec4(f.g.position[0].at(x, y), f.g.position[1].at(x, y), f.g.position[2].at(x, y), 1)).y;
      REQUIRE(height < 1e-3);
      REQUIRE(height > -0.25 - 1e-3);
      if (height > -0.06) top += o, ++tops;
      if (height < -0.18) hollow += o, ++hollows;
    }
  REQUIRE((tops > 100 && hollows > 100));
  CHECK(top / tops > 0.9);
  CHECK(hollow / hollows < top / tops - 0.04);
}
