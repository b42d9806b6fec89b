// Golden digests and pictures in tests/golden: what the renderer has computed since they were blessed, on any machine.
// To accept a wanted change: scripts/bless, then look at the pictures and at `git diff`.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <tuple>

#include "obscura/apps/demo_lights.h"
#include "obscura/apps/demo_scene.h"
#include "obscura/apps/demo_surfaces.h"
#include "obscura/apps/pictures.h"
#include "obscura/apps/report.h"
#include "obscura/engine/ambient_directions.h"
#include "obscura/engine/camera_choice.h"
#include "obscura/engine/extended_ambient.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/image_file.h"
#include "obscura/post/quality.h"
#include "obscura/raster/parallel.h"
#include "obscura/tests/scene_of_glb.h"

using namespace obscura;

namespace {

const std::string kFolder = OBSCURA_SOURCE_DIR "/tests/golden/";
const std::string kFound = OBSCURA_BINARY_DIR "/golden_found/";
const std::vector<engine::Aov> kAovs = {engine::Aov::Color,    engine::Aov::Depth,    engine::Aov::Normal,   engine::Aov::Albedo,
                                        engine::Aov::Emissive, engine::Aov::Obscurance, engine::Aov::Transfer, engine::Aov::Position,
                                        engine::Aov::Triangle, engine::Aov::Instance, engine::Aov::Material, engine::Aov::Metallic, engine::Aov::Roughness};

bool blessing() { return std::getenv("OBSCURA_BLESS") != nullptr; }

const engine::Scene& demo() {
  static const engine::Scene scene = tests::sceneOfGlb(apps::makeDemoScene());
  return scene;
}

engine::FrameSettings frameOf(int width, int height, const engine::Scene& scene = demo()) {
  engine::FrameSettings s;
  s.width = width;
  s.height = height;
  s.camera = *engine::chooseCamera(scene, {}, width, height);
  s.transfer.radius = 0.8f;
  s.transfer.bias = 0.008f;
  s.transfer.filterThreshold = 0.16f;
  s.background = {0.35f, 0.5f, 0.8f};
  s.aovs = kAovs;
  s.display = true;
  return s;
}

std::string readText(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void writeBytes(const std::string& path, const void* data, size_t size) {
  REQUIRE(engine::writeFileAtomically(path, {static_cast<const uint8_t*>(data), size}).ok());
}

void checkGolden(const std::string& name, const engine::FrameSettings& settings, const engine::Scene& scene = demo()) {
  engine::Renderer renderer;
  engine::Frame frame;
  REQUIRE(renderer.render(scene, settings, frame).ok());
  std::string digests;
  for (const std::string& line : apps::digestLines(frame, kAovs)) digests += line + "\n";
  const engine::Image found = apps::displayPicture(frame);
  const auto png = engine::encodeImage(engine::FileFormat::Png, {{"color", {"R", "G", "B"}, found}});
  REQUIRE(png.ok());
  if (blessing()) {
    writeBytes(kFolder + name + ".txt", digests.data(), digests.size());
    writeBytes(kFolder + name + ".png", png->data(), png->size());
    return;
  }
  const bool same = digests == readText(kFolder + name + ".txt");
  if (!same) {
    std::filesystem::create_directories(kFound);
    writeBytes(kFound + name + ".png", png->data(), png->size());
  }
  INFO("the picture found is " << kFound << name << ".png; if the change is wanted, run scripts/bless");
  CHECK(digests == readText(kFolder + name + ".txt"));
  const auto golden = engine::readImage(kFolder + name + ".png");
  REQUIRE(golden.ok());
  CHECK(golden->width == found.width);
  CHECK(golden->bytes == found.bytes);
}

}  // namespace

TEST_CASE("golden: the demo scene with the defaults") { checkGolden("demo", frameOf(160, 120)); }

TEST_CASE("golden: the demo scene from above, own albedo, two steps, exponential membership, no interleaving") {
  engine::FrameSettings s = frameOf(131, 97);
  engine::CameraRequest above;
  above.eye = glm::dvec3(2, 9, 5);
  above.target = glm::dvec3(0, 1, 0);
  s.camera = *engine::chooseCamera(demo(), above, s.width, s.height);
  s.transfer.albedo = post::TransferAlbedo::Own;
  s.transfer.membership = post::Membership::Exponential;
  s.transfer.samples = 13;
  s.transfer.steps = 2;
  s.transfer.interleave = false;
  checkGolden("above", s);
}

TEST_CASE("golden: the demo scene in an orthographic view, obscurance only") {
  engine::FrameSettings s = frameOf(90, 120);
  const glm::dmat4 view = s.camera.viewFromWorld;
  s.camera = raster::orthographic(3.75, 5, 0.1, 60);
  s.camera.viewFromWorld = view;
  s.ambient = post::Occlusion::Obscurance;
  s.transfer.membership = post::Membership::Sqrt;
  s.transfer.filter = false;
  checkGolden("orthographic", s);
}

namespace {

engine::EnvironmentMap goldenSky(raster::Parallel& parallel) {
  engine::EnvironmentMap map({engine::EnvironmentProjection::Latlong, 128, 64});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) {  // blue above, brown below, a sun above -x and -z, and lines of longitude and latitude
      const glm::dvec3 d = map.projector().directionAt({0, x + 0.5, y + 0.5});
      const bool sun = 0.6 * d.y - 0.4 * d.x - 0.7 * d.z > 0.98, line = x % 16 == 0 || y % 16 == 0;
      const glm::vec3 sky = d.y > 0 ? glm::vec3(0.4f, 0.7f, 1.4f) * float(1.2 - d.y) : glm::vec3(0.35f, 0.25f, 0.15f);
      map.at(0, x, y) = sun ? glm::vec3(40, 36, 30) : line ? sky * 0.6f : sky;
    }
  map.fillBorders(parallel);
  return map;
}

}  // namespace

TEST_CASE("golden: the demo scene in the light of an environment, before it, displayed by the neutral curve") {
  engine::FrameSettings s = frameOf(160, 120);
  raster::Parallel parallel(2);
  const engine::EnvironmentMap map = goldenSky(parallel);
  auto environment = std::make_shared<engine::Environment>();
  environment->harmonics = engine::harmonicsOf(map, parallel);
  environment->cubes = mirrorOf(convertEnvironment(map, {engine::EnvironmentProjection::Cube, 48, 48}, parallel));
  s.environment = environment;
  s.environmentRotation = 30;
  s.environmentBackground = true;
  s.tone = {post::ToneCurve::Neutral, 1.2f};
  checkGolden("environment", s);
}

TEST_CASE("golden: a floor that a height map displaces, by stored radiance and two layers") {
  const engine::Scene scene = tests::sceneOfGlb(apps::makeReliefScene());
  engine::FrameSettings s = frameOf(160, 120, scene);
  s.transfer.albedo = post::TransferAlbedo::Radiance;
  s.transfer.layers = 2;
  s.separation = 0.8f;
  checkGolden("relief", s, scene);
}

TEST_CASE("golden: implicit surfaces on a floor, sampled by dealt points, filtered by planes, lit by what surfaces send each other") {
  const engine::Scene scene = tests::sceneOfGlb(apps::makeImplicitScene());
  engine::FrameSettings s = frameOf(160, 120, scene);
  s.transfer.estimator = post::Estimator::Box;
  s.transfer.filterGuide = post::FilterGuide::Plane;
  raster::Parallel parallel(2);
  const auto light = engine::extendedAmbient(scene, glm::dvec3(0.6), parallel);
  REQUIRE(light.ok());
  s.ambientDirections = *light;
  checkGolden("implicit", s, scene);
}

TEST_CASE("golden: a courtyard with a sun, a lamp and a spot that cast shadows, by stored radiance") {
  const engine::Scene scene = tests::sceneOfGlb(apps::makeLightsScene());
  engine::FrameSettings s = frameOf(160, 120, scene);
  s.ambientLight = {0.12f, 0.15f, 0.24f};
  s.background = {0.02f, 0.035f, 0.08f};
  s.transfer.albedo = post::TransferAlbedo::Radiance;
  s.shadowSize = 512;
  checkGolden("lights", s, scene);
}

TEST_CASE("golden: metal, lacquer and tiles, from smooth to rough") {
  const engine::Scene scene = tests::sceneOfGlb(apps::makeMaterialsScene());
  engine::FrameSettings s = frameOf(160, 120, scene);
  s.supersample = 2;
  checkGolden("materials", s, scene);
}

TEST_CASE("golden: the same reflects the environment that it stands in, by roughness") {
  const engine::Scene scene = tests::sceneOfGlb(apps::makeMaterialsScene());
  engine::FrameSettings s = frameOf(160, 120, scene);
  raster::Parallel parallel(2);
  s.environment = std::make_shared<engine::Environment>(environmentOf(goldenSky(parallel), engine::EnvironmentParts::Reflections, parallel));
  s.environmentRotation = 200;
  s.environmentBackground = true;
  s.tone = {post::ToneCurve::Neutral, 1};
  checkGolden("reflections", s, scene);
}

TEST_CASE("golden: the same with thresholded highlights of Blinn-Phong, lit by six colours") {
  const engine::Scene scene = tests::sceneOfGlb(apps::makeMaterialsScene());
  engine::FrameSettings s = frameOf(160, 120, scene);
  s.brdf = post::Brdf::BlinnPhongThresholded;
  s.ambientDirections = engine::cubeOf({glm::vec3{1, 0.5f, 0.5f}, {0.5f, 1, 0.5f}, {1.2f, 1.2f, 1.2f}, {0.1f, 0.1f, 0.2f}, {0.5f, 0.5f, 1}, {1, 1, 0.2f}});
  checkGolden("blinn_phong", s, scene);
}

TEST_CASE("golden: the demo scene by the standard quality, rays marched through the depth map") {
  engine::FrameSettings s = frameOf(160, 120);
  post::setQuality(s.transfer, post::Quality::Standard);
  checkGolden("standard", s);
}

TEST_CASE("golden: the demo scene with 4 x 4 sub-pixels a pixel") {
  engine::FrameSettings s = frameOf(79, 61);
  s.supersample = 4;
  checkGolden("supersampled", s);
}

TEST_CASE("golden: threads, targets, tile sizes, skipping and the scalar twins give the same digest of every plane") {
  raster::withThreads(8, [] {
    engine::FrameSettings settings = frameOf(100, 75);
    engine::Frame frame;
    auto digests = [&](const raster::Settings& raster, bool reference) {
      engine::Renderer renderer(raster, reference);
      REQUIRE(renderer.render(demo(), settings, frame).ok());
      return apps::digestLines(frame, kAovs);
    };
    std::vector<std::string> expected = digests({}, true);
    for (raster::Target target : raster::supportedTargets())
      for (int tile : {16, 32, 64})
        for (int count : {1, 3, 8})
          for (bool skip : {true, false}) {
            INFO(raster::targetName(target) << ", tile " << tile << ", " << count << " threads, skip " << skip
                                            << "; repeat: obscura render SCENE --digest --target " << raster::targetName(target)
                                            << " --tile " << tile << " --threads " << count << (skip ? "" : " --no-skip"));
            REQUIRE(digests({count, target, tile, skip}, false) == expected);
          }
    for (const auto& [estimator, guide] : {std::pair(post::Estimator::Sobol, post::FilterGuide::Depth),
                                           std::pair(post::Estimator::March, post::FilterGuide::Plane),
                                           std::pair(post::Estimator::Lines, post::FilterGuide::Plane)}) {
      settings.transfer.estimator = estimator;
      settings.transfer.filterGuide = guide;
      settings.transfer.layers = estimator == post::Estimator::Sobol ? 1 : 2;
      settings.separation = 0.8f;
      expected = digests({}, true);
      for (raster::Target target : raster::supportedTargets())
        for (int count : {1, 3, 8}) {
          INFO(raster::targetName(target) << ", " << count << " threads, estimator " << int(estimator));
          REQUIRE(digests({count, target, 16, count != 3}, false) == expected);
        }
    }
  });
}

TEST_CASE("golden: supersampled frames, too, have one digest for threads, targets, tile sizes and the scalar twins") {
  raster::withThreads(8, [] {
    engine::FrameSettings settings = frameOf(37, 29);
    for (int supersample : {2, 4}) {
      settings.supersample = supersample;
      settings.transfer.filterGuide = supersample == 4 ? post::FilterGuide::Plane : post::FilterGuide::Depth;
      auto digests = [&](const raster::Settings& raster, bool reference) {
        engine::Renderer renderer(raster, reference);
        engine::Frame frame;
        REQUIRE(renderer.render(demo(), settings, frame).ok());
        return apps::digestLines(frame, kAovs);
      };
      const std::vector<std::string> expected = digests({}, true);
      for (raster::Target target : raster::supportedTargets())
        for (int tile : {16, 64})
          for (int count : {1, 3, 8}) {
            if (tile == 64 && count != 8) continue;
            INFO(raster::targetName(target) << ", tile " << tile << ", " << count << " threads, supersample " << supersample);
            REQUIRE(digests({count, target, tile, count != 3}, false) == expected);
          }
    }
  });
}

TEST_CASE("golden: a supersampled frame holds means and nearest sub-pixels of the frame so many times as large") {
  engine::FrameSettings settings = frameOf(44, 33);
  engine::Renderer renderer;
  engine::Frame pixels, large, again;
  const engine::FrameSettings plain = settings;
  REQUIRE(renderer.render(demo(), plain, again).ok());
  const auto before = apps::digestLines(again, kAovs);
  for (int s : {2, 4}) {
    settings.supersample = s;
    REQUIRE(renderer.render(demo(), settings, pixels).ok());
    engine::FrameSettings larger = plain;
    larger.width *= s, larger.height *= s;
    REQUIRE(engine::Renderer().render(demo(), larger, large).ok());
    int wrong = 0, edges = 0, emptyInPart = 0;
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 44; ++x) {
        float nearest = std::numeric_limits<float>::infinity();
        int nx = x * s, ny = y * s, empty = 0;
        double color = 0, w = 0, albedo = 0, o = 0, emissive = 0;
        for (int j = y * s; j < y * s + s; ++j)
          for (int i = x * s; i < x * s + s; ++i) {
            if (large.g.depth.at(i, j) < nearest) nearest = large.g.depth.at(i, j), nx = i, ny = j;
            empty += large.g.triangle.at(i, j) == raster::kNoTriangle;
            edges += large.g.triangle.at(i, j) != large.g.triangle.at(x * s, y * s);
            color += double(large.color.rgb[1].at(i, j)), w += double(large.transfer.w[0].at(i, j));
            albedo += double(large.g.albedo[2].at(i, j)), o += double(large.transfer.obscurance.at(i, j));
            emissive += double(large.g.emissive[0].at(i, j));
          }
        emptyInPart += empty > 0 && empty < s * s;
        const auto near = [&](double total, float found) { return std::fabs(total / (s * s) - double(found)) < 1e-6; };
        wrong += !near(color, pixels.color.rgb[1].at(x, y)) || !near(w, pixels.transfer.w[0].at(x, y)) ||
                 !near(albedo, pixels.g.albedo[2].at(x, y)) || !near(o, pixels.transfer.obscurance.at(x, y)) ||
                 !near(emissive, pixels.g.emissive[0].at(x, y));
        wrong += pixels.g.depth.at(x, y) != nearest;
        wrong += pixels.g.triangle.at(x, y) != large.g.triangle.at(nx, ny);
        wrong += pixels.g.instance.at(x, y) != large.g.instance.at(nx, ny);
        wrong += pixels.g.material.at(x, y) != large.g.material.at(nx, ny);
        for (int c = 0; c < 3; ++c) {
          wrong += pixels.g.normal[c].at(x, y) != large.g.normal[c].at(nx, ny);
          wrong += pixels.g.position[c].at(x, y) != large.g.position[c].at(nx, ny);
          wrong += !(pixels.color.rgb[c].at(x, y) >= 0);  // NaN
        }
      }
    CHECK(wrong == 0);
    CHECK(edges > 100);
    CHECK(emptyInPart > 20);
  }
  REQUIRE(renderer.render(demo(), plain, pixels).ok());  // into the frame that was supersampled
  CHECK(apps::digestLines(pixels, kAovs) == before);
}

TEST_CASE("golden: a renderer that has drawn other sizes, AOVs and ambient settings draws a supersampled frame alike") {
  const std::vector<engine::Aov> color = {engine::Aov::Color}, more = {engine::Aov::Transfer, engine::Aov::Normal};
  engine::Renderer used;
  engine::Frame usedFrame;
  for (const auto& [width, aovs, ambient, albedo] :
       {std::tuple{40, color, post::Occlusion::Transfer, post::TransferAlbedo::Neighbour},
        {40, color, post::Occlusion::Transfer, post::TransferAlbedo::Neighbour},
        {24, more, post::Occlusion::Transfer, post::TransferAlbedo::Own},
        {24, color, post::Occlusion::Transfer, post::TransferAlbedo::Own},
        {32, color, post::Occlusion::None, post::TransferAlbedo::Neighbour},
        {40, color, post::Occlusion::Obscurance, post::TransferAlbedo::Neighbour},
        {40, more, post::Occlusion::Transfer, post::TransferAlbedo::Neighbour},
        {40, color, post::Occlusion::Transfer, post::TransferAlbedo::Neighbour}}) {
    engine::FrameSettings settings = frameOf(width, 20);
    settings.supersample = 2;
    settings.aovs = aovs;
    settings.ambient = ambient;
    settings.transfer.albedo = albedo;
    engine::Frame fresh;
    REQUIRE(used.render(demo(), settings, usedFrame).ok());
    REQUIRE(engine::Renderer().render(demo(), settings, fresh).ok());
    CHECK(apps::digestLines(usedFrame, aovs) == apps::digestLines(fresh, aovs));
  }
}

TEST_CASE("golden: supersampling only fills planes that are AOVs, and only factors and sizes that exist are taken") {
  engine::FrameSettings settings = frameOf(20, 15);
  engine::Renderer renderer;
  engine::Frame frame;
  REQUIRE(renderer.render(demo(), settings, frame).ok());
  settings.supersample = 2;
  settings.aovs = {engine::Aov::Instance};
  settings.display = false;
  REQUIRE(renderer.render(demo(), settings, frame).ok());
  CHECK(!frame.g.instance.empty());
  CHECK((frame.g.depth.empty() && frame.g.normal[0].empty() && frame.transfer.obscurance.empty()));
  for (const auto& [width, s] : {std::pair{20, 3}, {20, 0}, {20, -2}, {20, 8}, {8193, 2}, {4097, 4}, {0, 2}, {-2147483647, 4}}) {
    settings.width = width;
    settings.supersample = s;
    const auto done = renderer.render(demo(), settings, frame);
    INFO(width << " times " << s);
    REQUIRE(!done.ok());
    CHECK(done.error().code == engine::ErrorCode::Usage);
    CHECK(done.error().message.find("supersample") != std::string::npos);
  }
}
