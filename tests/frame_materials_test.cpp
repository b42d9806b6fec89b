// BRDFs in whole frames.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "frame_checks.h"
#include "obscura/apps/demo_surfaces.h"
#include "obscura/apps/report.h"
#include "obscura/engine/camera_choice.h"
#include "obscura/raster/parallel.h"
#include "scene_of_glb.h"

using namespace obscura;
using namespace obscura::tests;
using engine::Aov;
using post::Brdf;

namespace {

constexpr Brdf kBrdfs[] = {Brdf::Lambert, Brdf::Gltf, Brdf::BlinnPhong, Brdf::BlinnPhongThresholded};

const engine::Scene& materials() {
  static const engine::Scene scene = sceneOfGlb(apps::makeMaterialsScene());
  return scene;
}

engine::FrameSettings settingsOf(const engine::Scene& scene, int width, int height) {
  engine::FrameSettings s;
  s.width = width, s.height = height;
  s.camera = *engine::chooseCamera(scene, {}, width, height);
  s.transfer.radius = 0.5f, s.transfer.bias = 0.005f, s.transfer.filterThreshold = 0.1f;
  s.ambientLight = {1, 0.9f, 0.8f};
  return s;
}

bool isSeen(const engine::Frame& f, int x, int y) { return f.g.depth.at(x, y) < std::numeric_limits<float>::infinity(); }

}  // namespace

TEST_CASE("materials: threads, targets, tile sizes, skipping and the scalar twins give the same digest with every BRDF") {
  raster::withThreads(8, [] {
    const std::vector<Aov> aovs = {Aov::Color, Aov::Metallic, Aov::Roughness};
    for (Brdf brdf : kBrdfs)
      for (auto albedo : {post::TransferAlbedo::Neighbour, post::TransferAlbedo::Radiance}) {
        engine::FrameSettings s = settingsOf(materials(), 61, 43);
        s.brdf = brdf;
        s.transfer.albedo = albedo;
        s.aovs = aovs;
        s.display = true;
        s.supersample = albedo == post::TransferAlbedo::Radiance ? 1 : 2;
        if (brdf == Brdf::BlinnPhong) s.ambientDirections = sixDirections();
        const auto expected = apps::digestLines(frameOf(materials(), s, {}, true), aovs);
        for (raster::Target target : raster::supportedTargets())
          for (int count : {1, 3, 8}) {
            INFO("brdf " << int(brdf) << ", " << raster::targetName(target) << ", " << count << " threads");
            REQUIRE(apps::digestLines(frameOf(materials(), s, {count, target, count == 3 ? 16 : 64, count != 3}), aovs) == expected);
          }
      }
  });
}

TEST_CASE("materials: white furnace: white things in white light before white disappear, however metallic and rough they are") {
  engine::Scene white = materials();
  for (raster::Material& m : white.materials) m.baseColor = glm::vec4(1);
  engine::FrameSettings s = settingsOf(white, 160, 120);
  s.ambientLight = s.background = glm::vec3(1);
  s.ambient = post::Occlusion::None;
  s.aovs = {Aov::Color, Aov::Material};
  const engine::Frame f = frameOf(white, s);
  int seen = 0;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      seen += isSeen(f, x, y);
      for (int c = 0; c < 3; ++c) REQUIRE(f.color.rgb[c].at(x, y) == 1);
    }
  CHECK(seen > 5000);
}

TEST_CASE("materials: Lambert reflects the albedo, bit for bit, and needs no planes for more") {
  engine::FrameSettings s = settingsOf(materials(), 80, 60);
  s.brdf = Brdf::Lambert;
  s.aovs = {Aov::Color, Aov::Transfer, Aov::Albedo};
  const engine::Frame f = frameOf(materials(), s);
  CHECK((f.g.metallic.empty() && f.g.roughness.empty()));
  int seen = 0;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x)
      for (int c = 0; isSeen(f, x, y) && c < 3; ++c) {
        ++seen;
        REQUIRE(f.color.rgb[c].at(x, y) == f.g.albedo[c].at(x, y) * f.transfer.w[c].at(x, y) * s.ambientLight[c]);
      }
  CHECK(seen > 5000);
  // Nor does a frame without light, whatever the BRDF.
  s.brdf = Brdf::Gltf;
  s.aovs = {Aov::Depth, Aov::Transfer};
  const engine::Frame dark = frameOf(materials(), s);
  CHECK((dark.g.metallic.empty() && dark.g.roughness.empty()));
}

TEST_CASE("materials: black things reflect at their surface unless they are unlit, which only emit") {
  engine::Scene scene = materials();
  for (raster::Material& m : scene.materials) m.baseColor = {0, 0, 0, 1};
  engine::FrameSettings s = settingsOf(scene, 80, 60);
  s.aovs = {Aov::Color, Aov::Metallic, Aov::Roughness};
  const engine::Frame black = frameOf(scene, s);
  for (raster::Material& m : scene.materials) m.unlit = true, m.baseColor = {0.5f, 0.25f, 1, 1};
  const engine::Frame unlit = frameOf(scene, s);
  int shining = 0;
  for (int y = 0; y < black.height; ++y)
    for (int x = 0; x < black.width; ++x) {
      if (!isSeen(black, x, y)) continue;
      shining += black.color.rgb[0].at(x, y) > 0.02f;
      REQUIRE((unlit.color.rgb[0].at(x, y) == 0.5f && unlit.color.rgb[1].at(x, y) == 0.25f && unlit.color.rgb[2].at(x, y) == 1));
      REQUIRE((unlit.g.metallic.at(x, y) == 0 && unlit.g.roughness.at(x, y) == 1));
    }
  CHECK(shining > 1000);
}

TEST_CASE("materials: a sphere that is no metal reflects more towards its outline, and more if it is smooth") {
  engine::FrameSettings s = settingsOf(materials(), 240, 180);
  s.ambient = post::Occlusion::None;
  s.ambientLight = glm::vec3(1);
  s.aovs = {Aov::Color, Aov::Material, Aov::Normal};
  const engine::Frame f = frameOf(materials(), s);
  // Of the black spheres, by roughness: the mean where n.v is about 0.3, and about 1.
  constexpr uint32_t first = 1 + 3 * 6;  // after the tiles and three rows
  double sum[6][2] = {};
  int count[6][2] = {};
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const uint32_t k = f.g.material.at(x, y) - first;
      const float nz = f.g.normal[2].at(x, y);
      const int part = nz > 0.2f && nz < 0.4f ? 0 : nz > 0.97f ? 1 : -1;
      if (k >= 6 || part < 0) continue;
      sum[k][part] += double(f.color.rgb[1].at(x, y)), ++count[k][part];
    }
  for (int k = 0; k < 6; ++k) {
    REQUIRE((count[k][0] > 5 && count[k][1] > 5));
    INFO("sphere " << k << ": " << sum[k][0] / count[k][0] << ", " << sum[k][1] / count[k][1]);
    CHECK(sum[k][0] / count[k][0] > sum[k][1] / count[k][1]);
    if (k < 2) CHECK(sum[k][1] / count[k][1] == Approx(0.04).margin(0.003));
    for (int part = 0; part < 2 && k > 0; ++part) CHECK(sum[k][part] / count[k][part] < sum[k - 1][part] / count[k - 1][part] * 1.01);
  }
}
