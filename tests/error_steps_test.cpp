// obscura-bench error: what its steps say of scenes where the answer is known.
#include "bench_program.h"

#include <cmath>
#include <map>

using namespace obscura::tests;

namespace {

const Words kView = {"--eye", "1.2,1.1,4.9", "--target", "0.9,0.8,0"};

Words errorWords(const SceneFolder& s, const Words& more, const Words& view = kView) {
  return Words{"error", s.scene, "--cache", s / "cache", "--size", "32x24", "--rays", "128", "--directions", "32"} + view + more;
}

std::map<std::string, Json> stepsOf(const SceneFolder& s, const Words& more = {}, const Words& view = kView) {
  std::map<std::string, Json> steps;
  const Json out = printedBy(errorWords(s, more, view));
  for (const Json& step : out["steps"]) steps[step["name"]] = step;
  REQUIRE(steps.size() == 8);
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

TEST_CASE("error steps: the normals' part of a wall whose normals lean by 60 degrees is the quarter that the triangle blocks of its directions") {
  const SceneFolder s;
  GltfBuilder b;
  b.add("materials", Json::object());
  std::vector<float> normals;
  for (int k = 0; k < 4; ++k) normals.insert(normals.end(), {std::sqrt(0.75f), 0, 0.5f});
  const int mesh = b.addMesh({{"attributes",
                               {{"POSITION", b.addFloats({-9, -9, 0, 11, -9, 0, 11, 11, 0, -9, 11, 0}, "VEC3")}, {"NORMAL", b.addFloats(normals, "VEC3")}}},
                              {"indices", b.addAccessor(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, kUShort, "SCALAR")},
                              {"material", 0}});
  b.addNode({{"mesh", mesh}});
  writeBytes(s.scene, b.glb());
  const auto steps = stepsOf(s);
  CHECK(double(steps.at("normals")["change"]) == Approx(0.25).margin(0.01));
  CHECK(steps.at("normals")["rmse"] == 0);
}

TEST_CASE("error steps: end at the estimator, whose error obscura-bench pareto finds, too") {
  const SceneFolder s;
  const auto steps = stepsOf(s, {"--samples", "4"});
  const Json out = printedBy({"pareto", s.scene, "--cache", s / "cache", "--size", "32x24", "--eye", "1.2,1.1,4.9", "--target",
                                 "0.9,0.8,0", "--rays", "128", "--frames", "1", "--samples", "4", "--estimator", "paper", "--filter",
                                 "depth", "--quantity", "O", "--rays-embree", "1"});
  const Json& row = out["scenes"][0]["rows"][0];
  CHECK(double(steps.at("sampling")["rmse"]) == Approx(double(row["rmse"])).epsilon(1e-9));
  CHECK(double(steps.at("sampling")["max"]) == Approx(double(row["max"])).epsilon(1e-9));
}

TEST_CASE("error steps: each answers to its own setting: no filter, more samples, all of the corner in the image") {
  const SceneFolder s;
  const auto few = stepsOf(s, {"--samples", "1"}), many = stepsOf(s, {"--samples", "64"});
  CHECK(few.at("sampling")["change"] > 2 * double(many.at("sampling")["change"]));
  for (const char* same : {"normals", "surface", "containment", "off-screen", "hidden", "thickness", "filter"})
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
  for (const Words& words : {Words{"--crop", "0,0,8,8"}, Words{"--plot", "bars.jpg"}, Words{"--directions", "0"}, Words{"--samples", "65"}})
    checkFails(errorWords(s, words), 2);
  checkFails(errorWords(s, {}, {"--eye", "0,0,9999", "--target", "0,0,99999"}), 3);
  const Finished drawn = runProgram(errorWords(s, {"--plot", s / "bars.gp"}));
  CHECK(drawn.code == 0);
  CHECK(contentOf(s / "bars.gp").find("\"thickness\" ") != std::string::npos);
}
