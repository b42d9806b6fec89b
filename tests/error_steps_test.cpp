// obscura-bench error: what its steps say of scenes where the answer is known.
#undef OBSCURA_PROGRAM
#define OBSCURA_PROGRAM OBSCURA_BIN_DIR "/obscura-bench"
#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include "cli_scene.h"
#include "run_program.h"

using namespace obscura::tests;
using Json = nlohmann::json;

namespace {

const std::vector<std::string> kView = {"--eye", "1.2,1.1,4.9", "--target", "0.9,0.8,0"};

std::vector<std::string> errorWords(const SceneFolder& s, const std::vector<std::string>& more, const std::vector<std::string>& view = kView) {
  std::vector<std::string> words = {"error", s.scene, "--cache", s / "cache", "--size", "32x24", "--rays", "128", "--directions", "32", "--json"};
  words.insert(words.end(), view.begin(), view.end());
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::map<std::string, Json> stepsOf(const SceneFolder& s, const std::vector<std::string>& more = {}, const std::vector<std::string>& view = kView) {
  const Finished f = runProgram(errorWords(s, more, view));
  INFO(f.err);
  REQUIRE(f.code == 0);
  std::map<std::string, Json> steps;
  const Json out = Json::parse(f.out);
  for (const Json& step : out["steps"]) steps[step["name"]] = step;
  REQUIRE(steps.size() == 7);
  return steps;
}

}  // namespace

TEST_CASE("error steps: a wall that stands alone has none, the depth map's stairs add less than a hundredth") {
  const SceneFolder s;
  GltfBuilder b;
  b.add("materials", Json::object());
  addRectangle(b, {-9, -9, 0}, {20, 0, 0}, {0, 20, 0}, 0);
  writeBytes(s.scene, b.glb());
  for (const auto& [name, step] : stepsOf(s)) {
    INFO(name);
    const bool ofDepthMap = name == "thickness" || name == "filter" || name == "sampling";
    CHECK(step["max"] <= (ofDepthMap ? 0.01 : 0));
    CHECK(step["change"] <= (ofDepthMap ? 0.001 : 0));
  }
}

TEST_CASE("error steps: end at the estimator, whose error obscura-bench pareto finds, too") {
  const SceneFolder s;
  const auto steps = stepsOf(s, {"--samples", "4"});
  const Finished f = runProgram({"pareto", s.scene, "--cache", s / "cache", "--size", "32x24", "--eye", "1.2,1.1,4.9", "--target",
                                 "0.9,0.8,0", "--rays", "128", "--frames", "1", "--samples", "4", "--estimator", "paper", "--filter",
                                 "depth", "--quantity", "O", "--rays-embree", "1", "--json"});
  INFO(f.err);
  REQUIRE(f.code == 0);
  const Json row = Json::parse(f.out)["scenes"][0]["rows"][0];
  CHECK(double(steps.at("sampling")["rmse"]) == Approx(double(row["rmse"])).epsilon(1e-9));
  CHECK(double(steps.at("sampling")["max"]) == Approx(double(row["max"])).epsilon(1e-9));
}

TEST_CASE("error steps: each answers to its own setting: no filter, more samples, all of the corner in the image") {
  const SceneFolder s;
  const auto few = stepsOf(s, {"--samples", "1"}), many = stepsOf(s, {"--samples", "64"});
  CHECK(few.at("sampling")["change"] > 2 * double(many.at("sampling")["change"]));
  for (const char* same : {"surface", "containment", "off-screen", "hidden", "thickness", "filter"})
    CHECK(few.at(same) == many.at(same));
  CHECK(few.at("filter")["change"] > 0);
  CHECK(stepsOf(s, {"--filter", "off"}).at("filter")["change"] == 0);
  CHECK(few.at("surface")["rmse"] < 0.05);
  // Half of the corner lies left of a camera that looks past it.
  const auto aside = stepsOf(s, {"--fov", "30"}, {"--eye", "1.2,1.1,2.5", "--target", "1.5,0.8,0"});
  CHECK(few.at("off-screen")["change"] == 0);
  CHECK(aside.at("off-screen")["change"] > 0);
  // Walls without a back are thick in the depth map alone.
  CHECK(few.at("thickness")["change"] > 0);
}

TEST_CASE("error steps: the same for any number of threads, nonsense ends with exit code 2") {
  const SceneFolder s;
  const Finished one = runProgram(errorWords(s, {"--threads", "1"})), three = runProgram(errorWords(s, {"--threads", "3"}));
  CHECK((one.code == 0 && one.out == three.out));
  using Words = std::vector<std::string>;
  for (const Words& words : {Words{"--crop", "0,0,8,8"}, Words{"--plot", "bars.jpg"}, Words{"--directions", "0"}, Words{"--samples", "65"}}) {
    INFO(words[0] << " " << words[1]);
    const Finished wrong = runProgram(errorWords(s, words));
    CHECK(wrong.code == 2);
    CHECK(wrong.out.empty());
  }
  const Finished away = runProgram(errorWords(s, {}, {"--eye", "0,0,9999", "--target", "0,0,99999"}));
  CHECK((away.code == 3 && away.out.empty()));
  const Finished drawn = runProgram(errorWords(s, {"--plot", s / "bars.gp"}));
  CHECK(drawn.code == 0);
  CHECK(contentOf(s / "bars.gp").find("\"thickness\" ") != std::string::npos);
}
