// obscura-bench pareto: its measures of error against closed forms, and the program on a tiny scene.
#include "bench_program.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "obscura/apps/error_measures.h"
#include "obscura/engine/image_file.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

template <class T>
raster::Plane<T> planeOf(int width, int height, const std::function<T(int, int)>& value) {
  raster::Plane<T> p(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) p.at(x, y) = value(x, y);
  return p;
}

const Words kTiny = {"--size", "32x24", "--eye", "1.2,1.1,4.9", "--target", "0.9,0.8,0", "--rays", "512", "--frames", "2", "--samples", "1,4", "--rays-embree", "1,64"};

Words pareto(const SceneFolder& s, const Words& more) { return Words{"pareto", s.scene, "--cache", s / "cache"} + kTiny + more; }

}  // namespace

TEST_CASE("pareto: an even error has itself as RMSE, bias, percentile and maximum, and the closed form's SSIM") {
  raster::Parallel parallel(2);
  const auto truth = planeOf<float>(40, 30, [](int, int) { return 0.5f; });
  const auto value = planeOf<float>(40, 30, [](int x, int) { return x < 20 ? 0.25f : 9; });
  const auto seen = planeOf<uint8_t>(40, 30, [](int x, int) { return x < 10; });  // no window reaches what is wrong
  const apps::ErrorMeter meter({&truth}, seen, parallel);
  const apps::ErrorMeasures e = meter.measure({&value});
  CHECK(e.rmse == Approx(0.25));
  CHECK(e.bias == Approx(-0.25));
  CHECK(e.p95 == Approx(0.25));
  CHECK(e.max == Approx(0.25));
  CHECK(e.ssim == Approx((2 * 0.25 * 0.5 + 1e-4) / (0.25 * 0.25 + 0.5 * 0.5 + 1e-4)).epsilon(1e-3));
  const engine::Image map = meter.map({&value}, 0.5);
  CHECK((map.row<uint8_t>(3)[0] == 128 && map.row<uint8_t>(3)[1] == 128 && map.row<uint8_t>(3)[2] == 255));  // half blue
  CHECK((map.row<uint8_t>(3)[3 * 30] == 0 && map.row<uint8_t>(3)[3 * 30 + 2] == 0));                         // not seen
}

TEST_CASE("pareto: equal images have no error, one wrong pixel in a hundred is in the maximum and not in the percentile") {
  raster::Parallel parallel(1);
  const auto wave = [](int x, int y) { return 0.5f + 0.4f * float(std::sin(x * 0.7 + y * y * 0.1)); };
  const auto truth = planeOf<float>(20, 15, wave);
  const auto value = planeOf<float>(20, 15, [&](int x, int y) { return wave(x, y) + (y == 7 && x % 7 == 3 ? 0.5f : 0); });
  const auto seen = planeOf<uint8_t>(20, 15, [](int, int) { return uint8_t(1); });
  const apps::ErrorMeter meter({&truth, &truth}, seen, parallel);
  const apps::ErrorMeasures same = meter.measure({&truth, &truth}), other = meter.measure({&truth, &value});
  CHECK((same.rmse == 0 && same.bias == 0 && same.max == 0 && same.ssim == Approx(1)));
  CHECK(other.p95 == 0);
  CHECK(other.max == Approx(0.5));
  CHECK(other.bias == Approx(3 * 0.5 / 600));
  CHECK(other.rmse == Approx(std::sqrt(3 * 0.25 / 600)));
  CHECK((other.ssim < 0.999 && other.ssim > 0.5));
}

TEST_CASE("pareto: every combination is a row with all its figures, rays come nearer to the truth by their number") {
  const SceneFolder s;
  const Json out = printedBy(pareto(s, {"--csv", s / "rows.csv", "--plot", s / "plot.gp", "--map", "3", s / "map.png"}));
  REQUIRE(out["scenes"].size() == 1);
  const Json& scene = out["scenes"][0];
  CHECK(scene["embree_build_ms"] > 0);
  CHECK(scene["truth_standard_error"]["O"] > 0);
  std::map<std::string, int> methods;
  std::map<std::string, double> rmse;
  for (const Json& r : scene["rows"]) {
    ++methods[r["method"]];
    for (const char* figure : {"transfer_ms", "filter_ms", "ms", "rmse", "p95", "max"}) CHECK(r[figure] > 0);
    const std::map<std::string, std::string> own = {{"ssao", "ball"}, {"hbao", "horizon"}, {"vao", "tangent_sphere"}, {"gtao", "classic"}};
    const std::string quantity = r["quantity"];
    CHECK(r["truth"] == (quantity == "O" ? "O linear" : quantity == "method" ? own.at(r["method"]) : "W linear"));
    CHECK((r["max"] >= r["p95"] && std::fabs(double(r["ssim"])) <= 1 && r["rmse"] >= std::fabs(double(r["bias"]))));
    if (r["method"] == "embree") rmse[std::string(r["filter"]) + std::to_string(int(r["samples"]))] = r["rmse"];
    if (r["method"] == "embree" && r["samples"] == 64 && r["filter"] == "off") CHECK(std::fabs(double(r["bias"])) < 0.005);
    bool beaten = false;
    for (const Json& o : scene["rows"])
      beaten |= o["truth"] == r["truth"] && o["ms"] <= r["ms"] && o["rmse"] <= r["rmse"] && (o["ms"] < r["ms"] || o["rmse"] < r["rmse"]);
    if (r["front"] == true) CHECK(!beaten);
    else CHECK(beaten);
  }
  CHECK((methods["paper"] == 18 && methods["sobol"] == 18 && methods["box"] == 18 && methods["lines"] == 18 && methods["embree"] == 6));
  CHECK((methods["ssao"] == 12 && methods["hbao"] == 12 && methods["vao"] == 12 && methods["gtao"] == 12));
  CHECK(rmse["off64"] < 0.03);
  CHECK(rmse["off64"] < rmse["off1"] / 3);
  CHECK(rmse["depth1"] < rmse["off1"]);
  const std::string csv = contentOf(s / "rows.csv"), script = contentOf(s / "plot.gp");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + std::ptrdiff_t(scene["rows"].size()));
  CHECK(script.find("set logscale xy") != script.npos);
  CHECK(script.find("O linear") != script.npos);
  CHECK(script.find("W linear") != script.npos);
  CHECK(script.find("tangent_sphere") != script.npos);
  const auto map = engine::readImage(s / "map.png");
  REQUIRE(map.ok());
  CHECK((map->width == 32 && map->height == 24 && map->channels == 3));
}

TEST_CASE("pareto: layers, the silhouettes' bound and the steps of horizons are swept, and each changes what is measured") {
  const SceneFolder s;
  const Json rows = printedBy(pareto(s, {"--estimator", "box", "--filter", "off", "--quantity", "O", "--layers", "1,2",
                                         "--silhouette-bound", "on,off", "--peer", "vao,gtao", "--peer-steps", "2,4"}))["scenes"][0]["rows"];
  REQUIRE(rows.size() == 2 * (4 + 1 + 2 + 1));
  const auto differ = [&](int a, int b) { return rows[size_t(a)]["digest"] != rows[size_t(b)]["digest"]; };  // n = 4
  CHECK((differ(1, 3) && differ(1, 5) && differ(11, 13)));
  CHECK((rows[0]["layers"] == 1 && rows[4]["layers"] == 2 && rows[2]["silhouette_bound"] == false));
  CHECK((rows[8]["steps"] == 1 && rows[10]["steps"] == 2 && rows[12]["steps"] == 4));
}

TEST_CASE("pareto: the table has a line for each row, several scenes have a table each, nonsense ends with exit code 2") {
  const SceneFolder s;
  const Words few = {"--estimator", "sobol", "--filter", "plane", "--quantity", "O,W-own", s.scene};
  const Finished f = runProgram(pareto(s, few));
  INFO(f.err);
  REQUIRE(f.code == 0);
  size_t tables = 0, rows = 0;
  for (size_t at = f.out.find("row method"); at != f.out.npos; at = f.out.find("row method", at + 1)) ++tables;
  for (size_t at = f.out.find(" plane "); at != f.out.npos; at = f.out.find(" plane ", at + 1)) ++rows;
  CHECK(tables == 2);
  CHECK(rows == 2 * (2 + 2 + 4 * 2 + 2));
  for (const Words& words : {Words{"--map", "0", s / "m.png"}, Words{"--map", "127", s / "m.png"}, Words{"--map", "x", s / "m.png"},
                             Words{"--plot", "plot.jpg"}, Words{"--estimator", "guess"}, Words{"--filter", "on"},
                             Words{"--samples", "65"}, Words{"--layers", "3"}, Words{"--peer", "alchemy"}, Words{"--peer-steps", "17"}, Words{"--albedo", "own"}})
    checkFails(pareto(s, words), 2);
  checkFails({"pareto", "/nonexistent.glb"}, 3);
}
