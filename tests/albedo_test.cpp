// obscura-bench albedo: which W is nearest to the recursive one, where the answer is known.
#include "bench_program.h"

#include <cmath>

#include "obscura/apps/painted_scene.h"
#include "obscura/engine/frame.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/image_file.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

const Words kCorner = {"--size", "32x24", "--eye", "1.2,1.1,4.9", "--target", "0.9,0.8,0"};

Words corner(const SceneFolder& s, const Words& more) { return Words{"albedo", s.scene, "--no-cache"} + kCorner + more; }

// The rows of the first scene by "ALBEDO SOURCE W".
std::map<std::string, Json> rowsOf(const Json& out) {
  std::map<std::string, Json> rows;
  for (const Json& r : out["scenes"][0]["rows"])
    rows[std::string(r["albedo"]) + " " + std::string(r["source"]) + " " + std::string(r["w"])] = r;
  return rows;
}

}  // namespace

TEST_CASE("albedo: in a closed white room every W agrees with the recursive one, which is 1, and O does not") {
  const TemporaryFolder folder;
  GltfBuilder b;
  b.add("materials", {{"doubleSided", true}});
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.f, 1.f}) {
      std::vector<float> at(3, -1.f), u(3), v(3);
      at[size_t(axis)] = side, u[size_t((axis + 1) % 3)] = v[size_t((axis + 2) % 3)] = 2;
      addRectangle(b, at, u, v, 0);
    }
  const auto rows = rowsOf(printedBy({"albedo", b.writeGlb(folder), "--size", "16x12", "--rays", "32", "--radius", "8", "--albedo", "1", "--eye",
                                      "0,0,0.9", "--target", "0,-0.2,-1", "--no-cache"}));
  REQUIRE(rows.size() == 8);
  for (const auto& [name, row] : rows) {
    INFO(name << " " << row);
    const bool o = row["w"] == "O";
    CHECK((o ? row["rmse"] > 0.06 : row["rmse"] < 0.05));
    CHECK((o || std::fabs(double(row["bias"])) < 0.005));
    CHECK(row["nearest"] == !o);
  }
}

TEST_CASE("albedo: beside a red wall the neighbours' is nearest and the pixel's own the farthest of three, on grey they are the same") {
  const SceneFolder s;
  const auto rows = rowsOf(printedBy(corner(s, {"--rays", "128", "--radius", "1", "--albedo", "0.5,scene"})));
  const auto rmse = [&](const std::string& row) { return double(rows.at(row)["rmse"]); };
  CHECK(rows.at("scene rays neighbour")["nearest"] == true);
  CHECK(rmse("scene rays neighbour") < rmse("scene rays radiance"));
  CHECK(rmse("scene rays radiance") < rmse("scene rays own"));
  CHECK(rmse("0.5 rays neighbour") == Approx(rmse("0.5 rays own")).margin(1e-6));
  CHECK(rmse("0.5 depth map neighbour") == Approx(rmse("0.5 depth map own")).margin(1e-6));
  for (const char* w : {"O", "own", "neighbour", "radiance"})
    for (const char* albedo : {"0.5", "scene"})
      CHECK(rmse(albedo + std::string(" rays ") + w) < rmse(albedo + std::string(" depth map ") + w));
}

TEST_CASE("albedo: three grey worlds that are traced as one are what each is alone, a black one has nothing but O") {
  const SceneFolder s;
  const auto together = rowsOf(printedBy(corner(s, {"--rays", "64", "--albedo", "0,0.4,0.9"}))), alone = rowsOf(printedBy(corner(s, {"--rays", "64", "--albedo", "0.4"})));
  REQUIRE((together.size() == 24 && alone.size() == 8));
  for (const auto& [name, row] : alone) {
    INFO(name);
    CHECK(double(row["rmse"]) == Approx(double(together.at(name)["rmse"])).margin(1e-3));
    CHECK(double(row["bias"]) == Approx(double(together.at(name)["bias"])).margin(1e-3));
  }
  for (const char* w : {"O", "own", "neighbour", "radiance"}) CHECK(double(together.at(std::string("0 rays ") + w)["rmse"]) < 1e-6);
}

TEST_CASE("albedo: a painted scene has one albedo wherever something is seen, and the holes that it had") {
  const SceneFolder s;
  engine::FrameSettings settings;
  settings.width = 40, settings.height = 30;
  settings.aovs = {engine::Aov::Albedo, engine::Aov::Triangle};
  engine::Frame before, after;
  auto scene = engine::sceneFromGltf(s.scene, {});
  REQUIRE(scene.ok());
  settings.camera = raster::perspective(0.7, 4.0 / 3, 0.1);
  settings.camera.viewFromWorld = raster::lookAt({1, 1, 5}, {1, 1, 0}, {0, 1, 0});
  REQUIRE(engine::Renderer().render(*scene, settings, before).ok());
  apps::removeLights(*scene);
  apps::paint(*scene, {0.25f, 0.5f, 0.75f});
  REQUIRE(engine::Renderer().render(*scene, settings, after).ok());
  int fence = 0, seen = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      REQUIRE(after.g.triangle.at(x, y) == before.g.triangle.at(x, y));
      if (after.g.triangle.at(x, y) == raster::kNoTriangle) continue;
      ++seen, fence += after.g.triangle.at(x, y) >= 6;  // the fourth rectangle
      for (int c = 0; c < 3; ++c) REQUIRE(after.g.albedo[c].at(x, y) == 0.25f * float(c + 1));
    }
  CHECK((fence > 20 && seen > fence + 100));
}

TEST_CASE("albedo: table, CSV, plot and map have every row, nonsense ends with exit code 2") {
  const SceneFolder s;
  const Words few = {"--rays", "8", "--albedo", "0.5", "--csv", s / "rows.csv", "--plot", s / "plot.gp", "--map", "6", s / "map.png"};
  const Finished f = runProgram(corner(s, few));
  INFO(f.err);
  REQUIRE(f.code == 0);
  CHECK(f.out.find("recursive W, 8 rays a pixel") != f.out.npos);
  CHECK(f.out.find("   8 0.5     depth map  radiance") != f.out.npos);
  const std::string csv = contentOf(s / "rows.csv"), script = contentOf(s / "plot.gp");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 9);
  CHECK(script.find("by the depth map") != script.npos);
  const auto map = engine::readImage(s / "map.png");
  REQUIRE(map.ok());
  CHECK((map->width == 32 && map->height == 24 && map->channels == 3));
  for (const Words& wrong : {Words{"--albedo", "1.5"}, Words{"--albedo", "red"}, Words{"--albedo", "0.5,-0.1"}, Words{"--plot", "plot.jpg"},
                             Words{"--albedo", "0.5", "--map", "9", s / "m.png"}, Words{"--map", "x", s / "m.png"}, Words{"--samples", "65"}})
    checkFails(corner(s, wrong), 2);
  checkFails({"albedo", "/nonexistent.glb"}, 3);
  checkFails(Words{"albedo", s.scene, "--eye", "0,0,900", "--target", "0,0,901", "--no-cache"}, 3);
}
