// Whatever is asked for and whatever the G-buffer holds: O and W are numbers from 0 to 1, and the same on every target,
// skipped or not, as by the twins.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using post::AmbientSettings;
using post::Membership;
using post::TransferAlbedo;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kOdd[] = {kNaN, kInfinity, -kInfinity, 3e38f, -3e38f, 1e-40f, -0.f, -1, 0};
const glm::vec3 kAmbient(0.9f, 1, 1.3f);
const glm::vec3 kSideways(0, 1, 0.01f);  // N x this has no direction where N is parallel; in the papers' space

// A wall before the eye; `change` may spoil any pixel.
template <class Change>
raster::GBuffer wallWith(const Change& change, int width = 37, int height = 11) {
  raster::GBuffer g(width, height, kAllPlanes);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      g.depth.at(x, y) = 2 + 0.1f * float((x * 7 + y * 3) % 5);
      for (int c = 0; c < 3; ++c) {
        g.normal[c].at(x, y) = c == 2;
        g.albedo[c].at(x, y) = 0.3f * float(c + 1);
        g.emissive[c].at(x, y) = 0;
      }
      change(g, x, y);
    }
  return g;
}

raster::GBuffer copyOf(const raster::GBuffer& g) {
  raster::GBuffer copy;
  raster::cutOut(g, {0, 0, g.width, g.height}, copy);
  return copy;
}

raster::Camera wallCamera(bool orthographic) {
  return orthographic ? raster::orthographic(2, 1, 0.1, 50) : raster::perspective(1, 2, 0.1);
}

// Empty if all values are from 0 to `most`.
std::string firstUnsound(const raster::Plane<float>& plane, float most) {
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x)
      if (const float v = plane.at(x, y); !(v >= 0 && v <= most))
        return std::to_string(v) + " at " + std::to_string(x) + ", " + std::to_string(y);
  return "";
}

// Of W of stored radiance: the larger of 1 and L / La, and what some hundred roundings add.
float boundOf(const PostFrame& f, int channel) {
  const raster::Plane<float>& radiance = f.radiance.rgb[channel];
  float most = 1;
  for (int y = 0; y < radiance.height(); ++y)
    for (int x = 0; x < radiance.width(); ++x) most = std::max(most, radiance.at(x, y) / kAmbient[channel]);
  return std::min(most * 1.00001f, std::numeric_limits<float>::max());
}

// O and W by the twins, after all targets were found to give the same.
post::Transfer sound(const raster::GBuffer& g, const raster::Camera& camera, const AmbientSettings& settings) {
  PostFrame expected;
  expected.g = copyOf(g);
  runPost(expected, camera, settings, std::nullopt, post::Occlusion::Transfer, true, kAmbient);
  REQUIRE(firstUnsound(expected.transfer.obscurance, 1) == "");
  for (int c = 0; c < 3; ++c)
    REQUIRE(firstUnsound(expected.transfer.w[c], settings.albedo == TransferAlbedo::Radiance ? boundOf(expected, c) : 1) == "");
  for (raster::Target target : raster::supportedTargets())
    for (bool skip : {true, false}) {
      PostFrame found;
      found.g = copyOf(g);
      runPost(found, camera, settings, target, post::Occlusion::Transfer, skip, kAmbient);
      INFO("target " << raster::targetName(target) << " skip " << skip);
      REQUIRE(firstDifference("obscurance", found.transfer.obscurance, expected.transfer.obscurance) == "");
      for (int c = 0; c < 3; ++c) REQUIRE(firstDifference("transfer", found.transfer.w[c], expected.transfer.w[c]) == "");
    }
  return std::move(expected.transfer);
}

// With every W.
template <class Check>
void soundAlways(const raster::GBuffer& g, const raster::Camera& camera, AmbientSettings settings, const Check& check) {
  for (auto albedo : {TransferAlbedo::Own, TransferAlbedo::Neighbour, TransferAlbedo::Radiance}) {
    settings.albedo = albedo;
    check(sound(g, camera, settings));
  }
}
void soundAlways(const raster::GBuffer& g, const raster::Camera& camera, const AmbientSettings& settings) {
  soundAlways(g, camera, settings, [](const post::Transfer&) {});
}

TestScene smallSoup(uint32_t seed) {
  TestScene s = soupScene(seed);
  s.width = 41, s.height = 27;
  return s;
}

float mean(const raster::Plane<float>& plane) {
  double sum = 0;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) sum += plane.at(x, y);
  return float(sum / (double(plane.width()) * plane.height()));
}

}  // namespace

TEST_CASE("stability: albedo 0 leaves O, albedo 1 leaves 1 of W, as near as float sums come") {
  for (bool orthographic : {false, true})
    for (float albedo : {0.f, 1.f}) {
      const raster::GBuffer g = wallWith([&](raster::GBuffer& b, int x, int y) {
        for (int c = 0; c < 3; ++c) b.albedo[c].at(x, y) = albedo;
      });
      soundAlways(g, wallCamera(orthographic), AmbientSettings{}, [&](const post::Transfer& t) {
        CHECK(mean(t.obscurance) < 0.95f);
        for (int x = 0; x < g.width; ++x) REQUIRE(std::fabs(t.w[0].at(x, 5) - (albedo > 0 ? 1 : t.obscurance.at(x, 5))) < 1e-6f);
      });
    }
}

TEST_CASE("stability: where all samples are inside, W is 0, or 1 if nothing is absorbed, and of radiance what the wall reflects") {
  for (bool orthographic : {false, true})
    for (int samples : {1, 8, 64})
      for (float albedo : {0.f, 0.5f, 1.f}) {
        const raster::GBuffer g = wallWith([&](raster::GBuffer& b, int x, int y) {
          b.depth.at(x, y) = 2;
          b.normal[2].at(x, y) = -1;  // all rays go behind the wall
          for (int c = 0; c < 3; ++c) b.albedo[c].at(x, y) = albedo;
        });
        AmbientSettings s;
        s.samples = samples;
        s.bias = 0;
        soundAlways(g, wallCamera(orthographic), s, [&](const post::Transfer& t) {
          REQUIRE(t.obscurance.at(18, 5) == 0);
          const float w = t.w[1].at(18, 5);
          if (t.bounced[1].empty()) REQUIRE(w == (albedo == 1 ? 1 : 0));
          else REQUIRE(w == albedo);  // what the wall reflects of the light that would come first
        });
      }
}

TEST_CASE("stability: a pixel that no neighbour resembles has its own O and W") {
  const raster::GBuffer g = wallWith([](raster::GBuffer& b, int x, int y) { b.depth.at(x, y) = 2 + 0.01f * float(x + 37 * y); });
  for (float threshold : {1e-3f, 1e-30f, 1e-44f}) {
    AmbientSettings s, unfiltered;
    s.filterThreshold = threshold;
    unfiltered.filter = false;
    soundAlways(g, wallCamera(false), s, [&](const post::Transfer& t) {
      CHECK(firstDifference("obscurance", t.obscurance, sound(g, wallCamera(false), unfiltered).obscurance) == "");
    });
  }
}

TEST_CASE("stability: one sample, with every membership, number of steps, filter, interleaving and silhouette bound") {
  const TestScene scene = smallSoup(2);
  const raster::GBuffer g = gbufferOf(scene);
  for (uint32_t k = 0; k < 16; ++k) {
    AmbientSettings s;
    s.samples = 1;
    s.membership = Membership(k % 4);
    s.steps = 1 + int(k / 4 % 4);
    s.filter = k % 3 != 0;
    s.interleave = k % 5 != 0;
    s.silhouetteBound = k % 7 < 4;
    soundAlways(g, scene.camera, s);
  }
}

TEST_CASE("stability: R from a millionth of the scene to a million scenes, less than a pixel and more than the image") {
  for (uint32_t seed : {2u, 3u}) {  // a perspective and an orthographic camera
    const TestScene scene = smallSoup(seed);
    const raster::GBuffer g = gbufferOf(scene);
    for (int exponent = -6; exponent <= 6; ++exponent) {
      AmbientSettings s;
      s.radius = 6 * std::pow(10.f, float(exponent));
      s.bias = exponent % 2 ? s.radius * 0.01f : 0;
      s.steps = exponent % 3 ? 1 : 3;
      s.filterThreshold = s.radius / 5;
      s.silhouetteBound = exponent % 4 != 0;
      INFO("R " << s.radius);
      soundAlways(g, scene.camera, s);
    }
    for (float radius : {1e-38f, 1e-30f, 1e25f, 9e29f}) {  // what the engine lets through, nearly
      AmbientSettings s;
      s.radius = radius;
      s.bias = 0;
      soundAlways(g, scene.camera, s);
    }
  }
}

TEST_CASE("stability: a wall that faces the eye is open for an R of less than a pixel") {
  const raster::GBuffer g = wallWith([](raster::GBuffer& b, int x, int y) { b.depth.at(x, y) = 2; });
  for (bool orthographic : {false, true}) {
    AmbientSettings s;
    s.radius = 1e-4f;
    s.bias = 0;
    soundAlways(g, wallCamera(orthographic), s, [](const post::Transfer& t) {
      CHECK(mean(t.obscurance) == 1);
      CHECK(mean(t.w[0]) == 1);
    });
  }
}

TEST_CASE("stability: normals parallel to (0, 1, 0.01), and nearly so") {
  for (bool orthographic : {false, true})
    for (float sign : {1.f, -1.f})
      for (float aside : {0.f, 1e-8f, 1e-6f, 1e-5f, 1e-4f, 1e-3f, 1e-2f}) {
        const raster::GBuffer g = wallWith([&](raster::GBuffer& b, int x, int y) {
          const float length = std::sqrt(glm::dot(kSideways, kSideways));
          const glm::vec3 n = kSideways * (sign / length) + glm::vec3(x % 2 ? aside : 0, 0, y % 2 ? aside : -aside);
          b.normal[0].at(x, y) = n.x, b.normal[1].at(x, y) = n.y, b.normal[2].at(x, y) = -n.z;
        });
        INFO("sign " << sign << " aside " << aside);
        soundAlways(g, wallCamera(orthographic), AmbientSettings{});
      }
}

TEST_CASE("stability: normals that are not unit, zero, or no numbers") {
  for (float length : {0.f, 1e-30f, 1e-7f, 1e-3f, 0.5f, 3.f, 1e6f, 1e20f, kInfinity, kNaN})
    for (int axis = 0; axis < 3; ++axis) {
      const raster::GBuffer g = wallWith([&](raster::GBuffer& b, int x, int y) {
        if ((x + y) % 3 == 0) return;
        for (int c = 0; c < 3; ++c) b.normal[c].at(x, y) = c == axis ? length : 0;
      });
      INFO("length " << length << " axis " << axis);
      soundAlways(g, wallCamera(false), AmbientSettings{});
    }
}

TEST_CASE("stability: one bad value in any plane, in one pixel or in all") {
  for (float odd : kOdd)
    for (int plane = 0; plane < 7; ++plane)
      for (bool all : {false, true}) {
        const raster::GBuffer g = wallWith([&](raster::GBuffer& b, int x, int y) {
          if (!all && !(x == 17 && y == 5)) return;
          raster::Plane<float>* const planes[] = {&b.depth, b.normal, b.normal + 1, b.normal + 2, b.albedo, b.albedo + 1, b.albedo + 2};
          planes[plane]->at(x, y) = odd;
        });
        INFO("value " << odd << " plane " << plane << " all " << all);
        AmbientSettings s;
        s.silhouetteBound = plane % 2;
        soundAlways(g, wallCamera(plane % 3 == 1), s);
      }
}

TEST_CASE("stability: grazing views of a plane, by perspective and by orthographic cameras") {
  for (double degrees : {0.0, 1e-4, 0.01, 0.1, 1.0, 5.0})
    for (bool orthographic : {false, true}) {
      TestScene scene;
      scene.width = 53, scene.height = 21;
      scene.materials.resize(1);
      scene.materials[0].doubleSided = true;
      TestMesh& ground = scene.addMesh();
      TestScene::addQuad(ground, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9});
      scene.place(ground);
      scene.camera = orthographic ? raster::orthographic(2, 1, 0.1, 50) : raster::perspective(0.8, 2.5, 0.01);
      const double angle = degrees * 3.14159265358979 / 180;
      scene.camera.viewFromWorld = raster::lookAt({0, 5 * std::sin(angle), 5 * std::cos(angle)}, {0, 0, 0}, {0, 1, 0});
      INFO("degrees " << degrees << " orthographic " << orthographic);
      soundAlways(gbufferOf(scene), scene.camera, AmbientSettings{});
    }
}
