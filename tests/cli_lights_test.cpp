// obscura render in the light of direct lights.
#include <catch2/catch.hpp>

#include <set>

#include "cli_failure.h"
#include "cli_scene.h"
#include "run_program.h"

using namespace obscura;
using Words = std::vector<std::string>;

namespace {

struct Workplace : tests::SceneFolder {
  // The corner with a lamp of the file's own.
  std::string lamp = folder / "lamp.glb";

  Workplace() {
    tests::GltfBuilder b = tests::cornerScene();
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 4}}};
    b.addNode({{"translation", {1, 1.5, 1.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    tests::writeBytes(lamp, b.glb());
  }
  Finished render(const std::string& file, const Words& options) const {
    Words words = {"render", file, "--size", "48x40"};
    words.insert(words.end(), options.begin(), options.end());
    return runProgram(words);
  }
  std::string out(const std::string& file, const Words& options) const {
    const Finished f = render(file, options);
    INFO(f.err);
    REQUIRE(f.code == 0);
    return f.out;
  }
};

}  // namespace

TEST_CASE("cli: the file's lights shine unless they are switched off, and each option of light changes the picture") {
  const Workplace w;
  const Words digest = {"--digest"};
  const std::string ambient = w.out(w.scene, digest);
  CHECK(w.out(w.lamp, {"--digest", "--lights", "none"}) == ambient);
  std::set<std::string> seen = {ambient};
  const auto isNew = [&](const std::string& file, Words options) {
    options.push_back("--digest");
    return seen.insert(w.out(file, options)).second;
  };
  CHECK(isNew(w.lamp, {}));
  CHECK(isNew(w.lamp, {"--shadows", "off"}));
  CHECK(isNew(w.lamp, {"--shadow-size", "64"}));
  CHECK(isNew(w.scene, {"--sun", "1,2,3"}));
  CHECK(isNew(w.scene, {"--sun", "1,2,3", "--sun-light", "1,2,1"}));
  CHECK(isNew(w.scene, {"--sun", "1,2,-3"}));
  CHECK(isNew(w.scene, {"--headlight", "2"}));
  CHECK(isNew(w.lamp, {"--ambient-light", "0,0,0"}));
  CHECK(isNew(w.lamp, {"--ambient-light", "extended"}));
  CHECK(isNew(w.lamp, {"--ambient-light", "extended", "--ambient-classes", "14"}));
  CHECK(!isNew(w.lamp, {"--ambient-light", "extended", "--ambient-classes", "6"}));
  CHECK(isNew(w.lamp, {"--albedo", "radiance"}));
  CHECK(!isNew(w.scene, {"--sun", "10,20,30"}));  // a direction alone
}

TEST_CASE("cli: --stats counts lights and the shadow maps that were rendered") {
  const Workplace w;
  const std::string stats = w.out(w.lamp, {"--stats", "--sun", "0,-1,-0.5"});
  CHECK(stats.find("\nlights 2\n") != std::string::npos);
  CHECK(stats.find("\nlights_unseen 1\n") != std::string::npos);
  CHECK(stats.find("\nshadow_maps ") != std::string::npos);
  CHECK(w.out(w.lamp, {"--timings"}).find("\nshadows_ms ") != std::string::npos);
}

TEST_CASE("cli: lights that cannot be are refused") {
  const Workplace w;
  const auto refused = [&](const Words& options, const std::string& says) {
    Words all = {"--digest"};
    all.insert(all.end(), options.begin(), options.end());
    tests::checkFailure(w.render(w.scene, all), 2, says);
  };
  refused({"--lights", "some"}, "--lights");
  refused({"--sun", "0,0,0"}, "--sun");
  refused({"--sun", "1,2"}, "--sun");
  refused({"--sun", "1,nan,2"}, "--sun");
  refused({"--sun-light", "1,1,1"}, "--sun");
  refused({"--sun", "0,1,0", "--sun-light", "1,-1,1"}, "--sun-light");
  refused({"--sun", "0,1,0", "--sun-light", "1e30,1,1"}, "--sun-light");
  refused({"--headlight", "-1"}, "--headlight");
  refused({"--headlight", "1e16"}, "--headlight");
  refused({"--shadows", "soft"}, "--shadows");
  refused({"--shadow-size", "15"}, "--shadow-size");
  refused({"--shadow-size", "8193"}, "--shadow-size");
  for (const char* count : {"3", "257", "0", "-6", "6.5", "99999999999", "six", ""}) refused({"--ambient-light", "extended", "--ambient-classes", count}, "4...256");
  refused({"--ambient-classes", "8"}, "--ambient-light extended");
}
