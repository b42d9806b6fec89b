// What is kept of a truth, and obscura-bench truth as a user meets it.
#include "bench_program.h"

#include <functional>
#include <set>

#include "obscura/apps/truth_cache.h"
#include "obscura/engine/image_file.h"
#include "traced_scene.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

void makeCorner(TracedScene& t) {
  TracedScene::addQuad(t.addMesh(), {0, 0, -4}, {0, 0, 4}, {4, 0, 4}, {4, 0, -4});
  TracedScene::addQuad(t.addMesh(), {0, 0, -4}, {0, 4, -4}, {0, 4, 4}, {0, 0, 4});
  t.look({2.2, 1.6, 0}, {0.3, 0.1, 0}, 0.4);
}

std::string keyOf(const TracedScene& t) { return apps::truthKey(t.scene, *t.surface, t.settings, t.frame, t.truthSettings); }

Json printed(const Words& words) { return printedBy(Words{"truth"} + words); }

}  // namespace

TEST_CASE("truth: what is kept comes back whole, and nothing comes back from a file that is broken") {
  const TemporaryFolder folder;
  TracedScene t(9, 7, 16);
  makeCorner(t);
  t.trace();
  const std::string key = keyOf(t), file = apps::truthFile(folder / "deep/er", key);
  REQUIRE(apps::storeTruth(file, key, t.truth).ok());
  const auto back = apps::loadTruth(file, key, 9, 7);
  REQUIRE(back);
  for (int q = 0; q < apps::kTruthQuantities; ++q)
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 9; ++x) {
        REQUIRE(back->value[q].at(x, y) == t.truth.value[q].at(x, y));
        REQUIRE(back->error[q].at(x, y) == t.truth.error[q].at(x, y));
      }
  CHECK(!apps::loadTruth(file, key, 7, 9));
  CHECK(!apps::loadTruth(file, std::string(32, '0'), 9, 7));
  const std::string bytes = contentOf(file);
  const auto broken = [&](const std::string& content) {
    writeBytes(file, {content.begin(), content.end()});
    return !apps::loadTruth(file, key, 9, 7);
  };
  CHECK(broken(bytes.substr(0, bytes.size() - 1)));
  CHECK(broken(bytes + "x"));
  CHECK(broken(""));
  for (const size_t at : {size_t(3), size_t(40), bytes.size() / 2, bytes.size() - 1}) {
    std::string other = bytes;
    other[at] = char(other[at] ^ 1);
    CHECK(broken(other));
  }
  CHECK(!broken(bytes));
}

TEST_CASE("truth: the key changes with scene, camera, size and settings, and with nothing else") {
  std::set<std::string> keys;
  const std::vector<std::function<void(TracedScene&)>> changes = {
      [](TracedScene&) {},
      [](TracedScene& t) { t.scene.meshes[1].positions[2].y += 1; },
      [](TracedScene& t) { t.scene.instances[1].worldFromObject[0][0] = -1; },
      [](TracedScene& t) { t.scene.materials[0].baseColor.x = 0.7f; },
      [](TracedScene& t) { t.look({2.2, 1.7, 0}, {0.3, 0.1, 0}, 0.4); },
      [](TracedScene& t) { t.settings.width = 10; },
      [](TracedScene& t) { t.truthSettings.radius = 0.4f; },
      [](TracedScene& t) { t.truthSettings.rays = 24; },
      [](TracedScene& t) { t.truthSettings.membership = post::Membership::Sqrt; }};
  for (const auto& change : changes) {
    TracedScene t(9, 7, 16);
    makeCorner(t);
    change(t);
    t.render();
    CHECK(keyOf(t).size() == 32);
    CHECK(keys.insert(keyOf(t)).second);
    t.truthSettings.threads = 1;
    CHECK(!keys.insert(keyOf(t)).second);
  }
}

TEST_CASE("truth: the program keeps a truth by its content, traces it again when the file is broken, and writes planes") {
  const SceneFolder s;
  const Words words = {s.scene, "--size", "24x18", "--rays", "16", "--cache", s / "cache"};
  const Json first = printed(words);
  CHECK(first["cached"] == false);
  CHECK(first["trace_ms"] > 0);
  CHECK(first["pixels_seen"] > 100);
  REQUIRE(first["planes"].size() == 9);
  for (const Json& plane : first["planes"]) {
    CHECK((plane["mean"] > (plane["name"] == "bounce" ? 0.01 : 0.3) && plane["mean"] <= 1));
    CHECK((plane["standard_error_rms"] > 0 && plane["standard_error_rms"] < 0.2));
  }
  Json second = printed(words);
  CHECK(second["cached"] == true);
  CHECK(second["planes"] == first["planes"]);
  const std::string file = first["file"];
  writeBytes(file, {1, 2, 3});
  second = printed(words);
  CHECK(second["cached"] == false);
  CHECK(second["planes"] == first["planes"]);
  CHECK(printed(words)["cached"] == true);

  const Words crop = {"--crop", "4,6,8x5", "--plane", "linear,transfer", "-o", s / "part.npy", "-o", s / "part.pfm", "--threads", "1"};
  CHECK(printed(words + crop)["cached"] == false);
  printed(words + Words{"--plane", "linear", "-o", s / "whole.npy"});
  const auto part = engine::readImage(s / "part.linear.npy"), all = engine::readImage(s / "whole.linear.npy");
  REQUIRE((part.ok() && all.ok()));
  CHECK((part->width == 8 && part->height == 5 && all->width == 24));
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 8; ++x) REQUIRE(part->row<float>(y)[x] == all->row<float>(y + 6)[x + 4]);
  const auto error = engine::readImage(s / "part.transfer_error.pfm");
  REQUIRE(error.ok());
  CHECK(error->channels == 3);
}

TEST_CASE("truth: nonsense ends with exit code 2, a scene that is not there with 3, what cannot be written with 4") {
  const SceneFolder s;
  const auto fails = [&](const Words& words, int code) { checkFails(Words{"truth", s.scene, "--size", "8x6"} + words, code); };
  for (const Words& words : {Words{"--rays", "12"}, Words{"--rays", "0"}, Words{"--rays", "8.5"}, Words{"--plane", "depth", "--no-cache"},
                             Words{"-o", "x.png", "--no-cache"}, Words{"--samples", "4"}, Words{"--radius", "0"}})
    fails(words, 2);
  fails({"--eye", "0,0,900", "--target", "0,0,901", "--no-cache"}, 3);
  fails({"--rays", "8", "--cache", s.scene + "/in-a-file"}, 4);
  fails({"--rays", "8", "--no-cache", "-o", "/nonexistent/x.npy"}, 4);
  checkFails({"truth", "/nonexistent.glb"}, 3);
}

TEST_CASE("truth: a surface that a height map would displace is flat, in the frame as for the rays") {
  const TemporaryFolder folder;
  const auto planesOf = [&](bool displaced) {
    GltfBuilder b;
    b.addTexture(pngOf({0xFF000000, 0xFFFFFFFF, 0xFFFFFFFF, 0xFF000000}, 2, 2));
    const int uv = b.addFloats({0, 0, 4, 0, 0, 4}, "VEC2");
    Json material = Json::object();
    if (displaced) material["extras"] = {{"obscura_height", {{"index", 0}, {"scale", 0.3}}}};
    b.addTriangle({{"material", b.add("materials", material)}, {"attributes", {{"TEXCOORD_0", uv}}}});
    const std::string scene = b.writeGlb(folder);
    return printed({scene, "--size", "20x20", "--rays", "16", "--no-cache", "--radius", "0.5", "--eye", "0.3,0.2,2", "--target", "0.3,0.3,0"})["planes"];
  };
  const Json flat = planesOf(false);
  CHECK(flat.size() == 9);
  CHECK(planesOf(true) == flat);
}
