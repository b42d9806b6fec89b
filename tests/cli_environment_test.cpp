// obscura render in the light of an environment.
#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

#include "cli_scene.h"
#include "obscura/engine/image_file.h"
#include "run_program.h"

using namespace obscura;
using Words = std::vector<std::string>;

namespace {

struct Workplace : tests::SceneFolder {
  std::string sky = folder / "sky.pfm", square = folder / "square.pfm";

  Workplace() {
    write(sky, 32, 16);
    write(square, 16, 16);
  }
  // Brighter to the right and upwards, and bluer.
  static void write(const std::string& path, int width, int height) {
    engine::Image image(width, height, 3, engine::Format::F32);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < 3 * width; ++x) image.row<float>(y)[x] = 0.1f * float(x % 3 + 1) + float(x) / float(width) + float(height - y) / float(height);
    const auto bytes = engine::encodeImage(engine::FileFormat::Pfm, {{"color", {"R", "G", "B"}, image}});
    REQUIRE(engine::writeFileAtomically(path, *bytes).ok());
  }
  Finished render(const Words& options) const {
    Words words = {"render", scene, "--size", "48x40"};
    words.insert(words.end(), options.begin(), options.end());
    return runProgram(words);
  }
  std::string digest(Words options) const {
    options.push_back("--digest");
    const Finished f = render(options);
    INFO(f.err);
    REQUIRE(f.code == 0);
    return f.out;
  }
  void failing(int code, const Words& options, const std::string& says) const {
    const Finished f = render(options);
    INFO(f.err);
    CHECK(f.code == code);
    CHECK(f.out.empty());
    CHECK(std::count(f.err.begin(), f.err.end(), '\n') == 1);
    CHECK(f.err.find(says) != std::string::npos);
  }
};

}  // namespace

TEST_CASE("cli: every option of the environment changes the picture") {
  const Workplace w;
  std::set<std::string> pictures{w.digest({})};
  for (const Words& options : std::vector<Words>{{}, {"--env-rotate", "90"}, {"--env-rotate=-90"}, {"--env-intensity", "0.5"}, {"--background", "environment"},
                                                 {"--exposure", "-1"}, {"--exposure", "1.5"}, {"--tonemap", "reinhard"}, {"--tonemap", "neutral"},
                                                 {"--background", "environment", "--env-rotate", "10"}, {"--ambient", "off"},
                                                 {"--ambient-directional", "1,1,1/1,1,1/1,0,1/0,0,0/1,1,1/1,1,1"}}) {
    Words words = {"--environment", w.sky};
    words.insert(words.end(), options.begin(), options.end());
    CHECK(pictures.insert(w.digest(words)).second);
  }
  CHECK(pictures.insert(w.digest({"--environment", w.square, "--env-projection", "sphere"})).second);
  CHECK(w.digest({"--environment", w.sky, "--ambient-light", "environment"}) == w.digest({"--environment", w.sky}));
  // With what surfaces send each other; the environment's rotation and factors reach that, too.
  const Words six = {"--ambient-directional", "1,1,1/1,1,1/1,0,1/0,0,0/1,1,1/1,1,1"};
  for (Words words : std::vector<Words>{{"--ambient-light", "extended", "--ambient-light", "0.5,0.5,0.4"}, {"--environment", w.sky, "--ambient-light", "extended"}, {"--environment", w.sky, "--ambient-light", "extended", "--env-rotate", "90"},
                                        {"--environment", w.sky, "--ambient-light", "extended", "--ambient-classes", "9"}, {"--environment", w.sky, "--ambient-light", "extended", "--headlight", "3"}}) {
    CHECK(pictures.insert(w.digest(words)).second);
    words.insert(words.end(), six.begin(), six.end());
    CHECK(pictures.insert(w.digest(words)).second);
  }
  CHECK(w.digest({"--environment", w.sky, "--env-rotate", "30"}) == w.digest({"--environment", w.sky, "--env-rotate", "30", "--reference"}));
}

TEST_CASE("cli: an environment that cannot be is one line and the documented exit code") {
  const Workplace w;
  w.failing(3, {"--digest", "--environment", w / "none.hdr"}, "none.hdr");
  w.failing(3, {"--digest", "--environment", w.square}, "twice as wide as high");
  w.failing(3, {"--digest", "--environment", w.scene}, "not an image");
  w.failing(2, {"--digest", "--environment", w.sky, "--env-projection", "disc"}, "latlong|sphere|cube|paraboloid");
  w.failing(2, {"--digest", "--env-rotate", "3"}, "--environment");
  w.failing(2, {"--digest", "--environment", w.sky, "--ambient-light", "1,1,1"}, "--ambient-light");
  w.failing(2, {"--digest", "--environment", w.sky, "--ambient-light", "1,1,1", "--ambient-light", "extended"}, "--ambient-light");
  w.failing(2, {"--digest", "--environment", w.sky, "--ambient-light", "constant"}, "--ambient-light");
  w.failing(2, {"--digest", "--ambient-light", "environment"}, "--environment FILE");
  w.failing(2, {"--digest", "--environment", w.sky, "--ambient-light", "extended", "--ambient-light", "environment"}, "second of its kind");
  for (const char* value : {"-1", "nan", "1e7", "x", ""}) w.failing(2, {"--digest", "--environment", w.sky, "--env-intensity", value}, "--env-intensity");
  w.failing(2, {"--digest", "--background", "environment"}, "needs --environment");
  for (const char* value : {"65", "x", "nan"}) w.failing(2, {"--digest", "--exposure", value}, "--exposure");
  w.failing(2, {"--digest", "--tonemap", "aces"}, "none|reinhard|neutral");
  for (const char* value : {"inf", "1e7", "3deg"}) w.failing(2, {"--digest", "--environment", w.sky, "--env-rotate", value}, "--env-rotate");
}
