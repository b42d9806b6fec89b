// The ambient light of whole frames: by node group, by direction in the world, and with every W.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "frame_checks.h"

using namespace obscura;
using namespace obscura::tests;
using engine::Aov;

namespace {

engine::FrameSettings settingsOf(const TestScene& scene) {
  engine::FrameSettings s;
  s.width = 70, s.height = 50;
  s.camera = scene.camera;
  s.ambientLight = {1, 0.8f, 0.6f};
  s.transfer.radius = 0.7f, s.transfer.bias = 0.01f, s.transfer.filterThreshold = 0.2f;
  return s;
}

// A wall across the view of a camera that looks along `view` of the world.
engine::Frame wallSeenAlong(const glm::dvec3& view, const std::optional<glm::vec3>& group,
                            std::shared_ptr<const engine::Environment> environment = {}, double rotation = 0, float roughness = 1,
                            std::optional<glm::vec3> behind = {}) {
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  s.materials[0].roughness = roughness;
  TestMesh& wall = s.addMesh();
  const glm::dvec3 up = view.y != 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0), right = glm::cross(view, up);
  const glm::vec3 r(right * 9.0), u(up * 9.0), c(view * 3.0);
  TestScene::addQuad(wall, c - r - u, c + r - u, c + r + u, c - r + u);
  s.place(wall);
  engine::Scene scene = sceneFrom(s);
  scene.instances[0].ambient = group;
  if (behind) {  // the same wall twice as far away, with a light of its own
    scene.instances.push_back(scene.instances[0]);
    scene.instances[1].ambient = behind;
    scene.instances[1].worldFromObject = glm::dmat4(2.0);
    scene.instances[1].worldFromObject[3][3] = 1;
  }
  engine::FrameSettings settings = settingsOf(s);
  settings.camera = raster::perspective(0.7, 1.4, 0.1);
  settings.camera.viewFromWorld = raster::lookAt({0, 0, 0}, view, up);
  if (!environment) settings.ambientDirections = sixDirections();
  settings.environment = std::move(environment);
  settings.environmentRotation = rotation;
  return frameOf(scene, settings);
}

}  // namespace

TEST_CASE("ambient frames: directions are the world's: a wall that faces +x is lit by the colour of +x") {
  for (int k = 0; k < 6; ++k) {
    glm::dvec3 view(0);
    view[k / 2] = k % 2 ? 1 : -1;  // so that the wall's normal points the other way
    const engine::Frame f = wallSeenAlong(view, std::nullopt), ofGroup = wallSeenAlong(view, glm::vec3(2, 4, 8));
    const glm::vec3 expected = kSixColors[size_t(k)];
    for (int c = 0; c < 3; ++c) {
      INFO("direction " << k << " channel " << c);
      CHECK(f.color.rgb[c].at(35, 25) == Approx(expected[c] * glm::vec3(1, 0.8f, 0.6f)[c]).margin(1e-5));
      CHECK(ofGroup.color.rgb[c].at(35, 25) == Approx(expected[c] * glm::vec3(2, 4, 8)[c]).margin(1e-5));
    }
  }
}

namespace {

// A map whose radiance is 1 + 0.5 d . to.
std::shared_ptr<const engine::Environment> lightFrom(const glm::dvec3& to, bool reflections = false) {
  raster::Parallel parallel(1);
  engine::EnvironmentMap map({engine::EnvironmentProjection::Latlong, 32, 16});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) map.at(0, x, y) = glm::vec3(float(1 + 0.5 * glm::dot(to, map.projector().directionAt({0, x + 0.5, y + 0.5}))));
  map.fillBorders(parallel);
  auto out = std::make_shared<engine::Environment>();
  out->harmonics = engine::harmonicsOf(map, parallel);
  const engine::EnvironmentMap cube = convertEnvironment(map, {engine::EnvironmentProjection::Cube, 12, 12}, parallel);
  out->cubes = reflections ? prefiltered(cube, parallel) : mirrorOf(cube);
  return out;
}

}  // namespace

TEST_CASE("ambient frames: an environment's directions are the world's, and it turns counter-clockwise seen from above") {
  for (int k = 0; k < 6; ++k) {
    glm::dvec3 faces(0);
    faces[k / 2] = k % 2 ? -1 : 1;
    const engine::Frame f = wallSeenAlong(-faces, std::nullopt, lightFrom(faces)), away = wallSeenAlong(-faces, std::nullopt, lightFrom(-faces));
    INFO("direction " << k);
    CHECK(f.color.rgb[0].at(35, 25) == Approx(1 + 0.5 * 2 / 3).margin(0.01));
    CHECK(away.color.rgb[0].at(35, 25) == Approx(1 - 0.5 * 2 / 3).margin(0.01));
  }
  // A quarter of a turn brings +x to -z, and what faces that gets it.
  CHECK(wallSeenAlong({0, 0, 1}, std::nullopt, lightFrom({1, 0, 0}), 90).color.rgb[0].at(35, 25) > 1.3f);
  CHECK(wallSeenAlong({0, 0, -1}, std::nullopt, lightFrom({1, 0, 0}), 90).color.rgb[0].at(35, 25) < 0.7f);
  CHECK(wallSeenAlong({0, 0, 1}, glm::vec3(2, 4, 8), lightFrom({1, 0, 0})).color.rgb[0].at(35, 25) == 2);  // a group of its own
  // That another thing has a light of its own takes the environment from none.
  for (const float roughness : {0.0f, 1.0f})
    CHECK(wallSeenAlong({0, 0, 1}, std::nullopt, lightFrom({1, 0, 0}), 90, roughness, glm::vec3(2, 4, 8)).color.rgb[0].at(35, 25) ==
          wallSeenAlong({0, 0, 1}, std::nullopt, lightFrom({1, 0, 0}), 90, roughness).color.rgb[0].at(35, 25));
}

TEST_CASE("ambient frames: a mirror shows the environment in the direction of reflection, turned as the background, and rough metal a blurred one") {
  for (int k = 0; k < 6; ++k) {
    glm::dvec3 faces(0);
    faces[k / 2] = k % 2 ? -1 : 1;
    const glm::dvec3 view = -faces, up = view.y != 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0), right = glm::cross(view, up);
    const glm::dvec3 to = glm::normalize(glm::dvec3(0.2, 0.5, -0.8));
    const glm::dvec3 turned(to.z, to.y, -to.x);  // by 90 degrees around +y, counter-clockwise seen from above
    const engine::Frame f = wallSeenAlong(view, std::nullopt, lightFrom(to, true), 90, 0);
    const engine::Frame rough = wallSeenAlong(view, std::nullopt, lightFrom(to, true), 90, 1);
    double worst = 0;
    for (int y = 0; y < f.height; y += 7)
      for (int x = 0; x < f.width; x += 7) {
        const double sy = (1 - (y + 0.5) / 25) * std::tan(0.35), sx = ((x + 0.5) / 35 - 1) * std::tan(0.35) * 1.4;
        const glm::dvec3 r = glm::normalize(right * sx + up * sy + faces);
        worst = std::max(worst, std::fabs(f.color.rgb[0].at(x, y) - (1 + 0.5 * glm::dot(r, turned))));
      }
    CAPTURE(k);
    CHECK(worst < 0.01);
    // Averaged over the cosine lobe, as alpha = 1 makes it: 2/3 of the deviation.
    CHECK(rough.color.rgb[0].at(35, 25) == Approx(1 + 0.5 * 2 / 3 * glm::dot(faces, turned)).margin(0.01));
  }
}

TEST_CASE("ambient frames: a white object in a white environment disappears whatever its roughness") {
  auto white = std::make_shared<engine::Environment>(*lightFrom({0, 0, 0}, true));
  for (float roughness : {0.f, 0.05f, 0.4f, 1.f}) {
    const engine::Frame f = wallSeenAlong({0, 0, -1}, std::nullopt, white, 0, roughness);
    for (int x = 0; x < f.width; x += 3) CHECK(f.color.rgb[1].at(x, 20) == Approx(1).margin(1e-5));
  }
}

TEST_CASE("ambient frames: lit by an environment they have one digest for threads, targets, tiles, skipping and the twins") {
  const TestScene soup = soupScene(4);
  const engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup);
  s.environment = lightFrom({0.48, 0.64, 0.6}, true);
  s.environmentRotation = 33;
  s.environmentIntensity = 1.7;
  s.environmentBackground = true;
  s.tone = {post::ToneCurve::Neutral, 1.3f};
  s.aovs = allAovs();
  s.display = true;
  for (auto albedo : {post::TransferAlbedo::Neighbour, post::TransferAlbedo::Radiance}) {
    s.transfer.albedo = albedo;
    s.supersample = albedo == post::TransferAlbedo::Radiance ? 2 : 1;
    s.ambientDirections = albedo == post::TransferAlbedo::Radiance ? sixDirections() : addingDirections(20);
    const auto expected = imagesOf(frameOf(scene, s, {}, true));
    for (raster::Target target : raster::supportedTargets())
      for (int tile : {16, 64})
        for (int threads : {1, 3})
          for (bool skip : {true, false}) {
            const auto found = imagesOf(frameOf(scene, s, {threads, target, tile, skip}));
            INFO(raster::targetName(target) << " tile " << tile << " threads " << threads << " skip " << skip);
            for (size_t k = 0; k < found.size(); ++k) REQUIRE(found[k].bytes == expected[k].bytes);
          }
  }
}

TEST_CASE("ambient frames: behind the scene is the environment, turned and scaled, of every pixel its own direction, crop or not") {
  const TestScene soup = soupScene(4);
  const engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup);
  s.camera = raster::perspective(1.5, 1.4, 0.1);
  s.camera.viewFromWorld = raster::lookAt({20, 0, 0}, {30, 3, 5}, {0, 1, 0});  // away from the scene
  s.environment = lightFrom({0, 0, 1});
  s.environmentBackground = true;
  s.environmentRotation = 90;  // +z is at +x now
  s.environmentIntensity = 3;
  const engine::Frame whole = frameOf(scene, s);
  const glm::dmat3 worldFromView = glm::transpose(glm::dmat3(s.camera.viewFromWorld));
  int wrong = 0;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 70; ++x) {
      const glm::dvec3 d = worldFromView * glm::normalize(glm::dvec3(((x + 0.5) / 35 - 1) / double(s.camera.xScale), (1 - (y + 0.5) / 25) / double(s.camera.yScale), -1));
      wrong += !(std::fabs(whole.color.rgb[1].at(x, y) - 3 * (1 + 0.5 * d.x)) < 0.05);
    }
  CHECK(wrong == 0);
  s.crop = raster::Window{31, 20, 30, 25};
  const engine::Frame crop = frameOf(scene, s);
  for (int y = 0; y < 25; ++y)
    for (int x = 0; x < 30; ++x) REQUIRE(crop.color.rgb[2].at(x, y) == whole.color.rgb[2].at(x + 31, y + 20));
  s.environment = std::make_shared<const engine::Environment>();  // without a cube
  engine::Frame none;
  CHECK(engine::Renderer().render(scene, s, none).error().code == engine::ErrorCode::Usage);
}

TEST_CASE("ambient frames: exposure and tone mapping change the displayed picture and not the colour") {
  const TestScene soup = soupScene(4);
  const engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup);
  s.ambientLight = glm::vec3(3);
  s.display = true;
  const engine::Frame plain = frameOf(scene, s);
  CHECK(plain.shown.rgb[0].empty());
  for (const post::ToneSettings& tone : {post::ToneSettings{post::ToneCurve::Neutral, 1}, {post::ToneCurve::Reinhard, 1}, {post::ToneCurve::None, 0.25f}}) {
    s.tone = tone;
    const engine::Frame f = frameOf(scene, s);
    CHECK(apps::planeImage(f, Aov::Color).bytes == apps::planeImage(plain, Aov::Color).bytes);
    CHECK(apps::displayPicture(f).bytes != apps::displayPicture(plain).bytes);
    const engine::Image fine = apps::picture(f, Aov::Color, 16);  // of the same tones
    int wrong = 0;
    const engine::Image bytes = apps::displayPicture(f);
    for (size_t k = 0; k < bytes.bytes.size(); ++k) wrong += std::abs(int(fine.row<uint16_t>(0)[k]) - 257 * int(bytes.bytes[k])) > 129;
    CHECK(wrong == 0);
  }
  s.tone = {};
  s.tone.exposure = std::numeric_limits<float>::infinity();
  engine::Frame none;
  CHECK(engine::Renderer().render(scene, s, none).error().code == engine::ErrorCode::Usage);
}

TEST_CASE("ambient frames: the picture alone is the one of a frame with all AOVs, by every W, also of sub-pixels") {
  for (uint32_t seed : {4u, 7u, 10u}) {
    const TestScene soup = soupScene(seed);
    const engine::Scene scene = sceneFrom(soup);
    for (int albedo = 0; albedo < 3; ++albedo)
      for (int supersample : {1, 2})
        for (int directions : {0, 6, 14}) {
          engine::FrameSettings s = settingsOf(soup);
          s.transfer.albedo = post::TransferAlbedo(albedo);
          s.supersample = supersample;
          if (directions == 6) s.ambientDirections = sixDirections();
          if (directions == 14) s.ambientDirections = addingDirections(14), s.ambientLight = glm::vec3(0);  // light that is added alone
          INFO("seed " << seed << " W " << albedo << " supersample " << supersample << " directions " << directions);
          s.aovs = allAovs();
          const engine::Frame all = frameOf(scene, s);
          for (Aov alone : {Aov::Color, Aov::Transfer})
            for (bool reference : {false, true}) {
              s.aovs = {alone};
              CHECK(apps::planeImage(frameOf(scene, s, {}, reference), alone).bytes == apps::planeImage(all, alone).bytes);
            }
          // Twice by one renderer: what it keeps between frames changes nothing.
          engine::Renderer renderer;
          engine::Frame frame;
          s.aovs = {Aov::Color};
          for (int k = 0; k < 2; ++k) {
            REQUIRE(renderer.render(scene, s, frame).ok());
            CHECK(apps::planeImage(frame, Aov::Color).bytes == apps::planeImage(all, Aov::Color).bytes);
          }
        }
  }
}

TEST_CASE("ambient frames: planes of ids and normals are there only if something depends on them") {
  const TestScene soup = soupScene(4);
  engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup);
  CHECK_FALSE(frameOf(scene, s).g.instance.empty());
  for (engine::Instance& i : scene.instances) i.ambient.reset();
  CHECK(frameOf(scene, s).g.instance.empty());
  s.ambient = post::Occlusion::None;
  s.brdf = post::Brdf::Lambert;
  CHECK(frameOf(scene, s).g.normal[0].empty());
  s.ambientDirections = sixDirections();
  CHECK_FALSE(frameOf(scene, s).g.normal[0].empty());
}

TEST_CASE("ambient frames: colours that are none are usage errors") {
  const TestScene soup = soupScene(4);
  engine::Scene scene = sceneFrom(soup);
  engine::FrameSettings s = settingsOf(soup);
  engine::Frame frame;
  s.ambientDirections = sixDirections();
  s.ambientDirections[4].color.y = -1;
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
  s.ambientDirections = addingDirections(7);
  s.ambientDirections[4].added.z = std::numeric_limits<float>::infinity();
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
  s.ambientDirections[4] = {{1, 1, 0}, glm::vec3(1)};
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
  s.ambientDirections.assign(size_t(engine::kMostClasses) + 1, {});
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
  s.ambientDirections.clear();
  for (double wrong : {-1.0, 1e7, std::numeric_limits<double>::quiet_NaN()}) {
    s.environmentIntensity = wrong;
    CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
  }
  s.environmentIntensity = 1;
  s.environmentRotation = std::numeric_limits<double>::infinity();
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
  s.environmentRotation = 0;
  scene.instances[0].ambient = glm::vec3(0, std::numeric_limits<float>::quiet_NaN(), 0);
  CHECK(engine::Renderer().render(scene, s, frame).error().code == engine::ErrorCode::Usage);
}
