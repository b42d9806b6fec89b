// Golden digests and pictures in tests/golden: what the renderer has computed since they were blessed, on any machine.
// To accept a wanted change: scripts/bless, then look at the pictures and at `git diff`.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <oneapi/tbb/global_control.h>

#include "obscura/apps/demo_scene.h"
#include "obscura/apps/pictures.h"
#include "obscura/apps/report.h"
#include "obscura/engine/camera_choice.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/image_file.h"
#include "obscura/tests/temporary_folder.h"

using namespace obscura;

namespace {

const std::string kFolder = OBSCURA_SOURCE_DIR "/tests/golden/";
const std::string kFound = OBSCURA_BINARY_DIR "/golden_found/";
const std::vector<engine::Aov> kAovs = {engine::Aov::Color,    engine::Aov::Depth,    engine::Aov::Normal,   engine::Aov::Albedo,
                                        engine::Aov::Emissive, engine::Aov::Obscurance, engine::Aov::Transfer, engine::Aov::Position,
                                        engine::Aov::Triangle, engine::Aov::Instance, engine::Aov::Material};

bool blessing() { return std::getenv("OBSCURA_BLESS") != nullptr; }

const engine::Scene& demo() {
  static const engine::Scene scene = [] {
    const TemporaryFolder folder;
    const std::vector<uint8_t> glb = apps::glbFromScene(apps::makeDemoScene());
    std::ofstream(folder / "demo.glb", std::ios::binary).write(reinterpret_cast<const char*>(glb.data()), std::streamsize(glb.size()));
    auto loaded = engine::sceneFromGltf(folder / "demo.glb");
    REQUIRE(loaded.ok());
    return std::move(*loaded);
  }();
  return scene;
}

engine::FrameSettings frameOf(int width, int height) {
  engine::FrameSettings s;
  s.width = width;
  s.height = height;
  s.camera = *engine::chooseCamera(demo(), {}, width, height);
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

void checkGolden(const std::string& name, const engine::FrameSettings& settings) {
  engine::Renderer renderer;
  engine::Frame frame;
  REQUIRE(renderer.render(demo(), settings, frame).ok());
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

TEST_CASE("golden: threads, targets, tile sizes, skipping and the scalar twins give the same digest of every plane") {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 8);
  const engine::FrameSettings settings = frameOf(100, 75);
  engine::Frame frame;
  auto digests = [&](const raster::Settings& raster, bool reference) {
    engine::Renderer renderer(raster, reference);
    REQUIRE(renderer.render(demo(), settings, frame).ok());
    return apps::digestLines(frame, kAovs);
  };
  const std::vector<std::string> expected = digests({}, true);
  for (raster::Target target : raster::supportedTargets())
    for (int tile : {16, 32, 64})
      for (int count : {1, 2, 3, 8})
        for (bool skip : {true, false}) {
          INFO(raster::targetName(target) << ", tile " << tile << ", " << count << " threads, skip " << skip
                                          << "; repeat: obscura render SCENE --digest --target " << raster::targetName(target)
                                          << " --tile " << tile << " --threads " << count << (skip ? "" : " --no-skip"));
          REQUIRE(digests({count, target, tile, skip}, false) == expected);
        }
}
