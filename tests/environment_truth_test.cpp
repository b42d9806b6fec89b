// The traced light of an environment against closed forms, what is kept of it, and obscura-bench irradiance.
#include "bench_program.h"

#include <cmath>
#include <set>

#include "environment_maps.h"
#include "obscura/apps/truth_cache.h"
#include "obscura/engine/image_file.h"
#include "traced_scene.h"

using namespace obscura;
using namespace obscura::tests;
using apps::TruthQuantity;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr size_t kIrradianceRows = 14;

template <class F>
engine::EnvironmentMap latlong(int rows, const F& radiance) {
  return filledEnvironment(environmentProjector(engine::EnvironmentProjection::Latlong, rows), radiance);
}

engine::EnvironmentMap evenMap() {
  return latlong(8, [](const glm::dvec3&) { return glm::dvec3(2, 1, 0); });
}

TruthQuantity channel(TruthQuantity red, int c) { return TruthQuantity(int(red) + c); }

void addFloor(TracedScene& t) { TracedScene::addQuad(t.addMesh(), {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}); }

void makeCorner(TracedScene& t) {
  TracedScene::addQuad(t.addMesh(), {0, 0, -4}, {0, 0, 4}, {4, 0, 4}, {4, 0, -4});
  TracedScene::addQuad(t.addMesh(), {0, 0, -4}, {0, 4, -4}, {0, 4, 4}, {0, 0, 4});
  t.look({2.2, 1.6, 0}, {0.3, 0.1, 0}, 0.4);
}

// Mean over what is seen of a - factor b.
double meanDifference(const TracedScene& t, TruthQuantity a, double factor, TruthQuantity b) {
  double sum = 0, n = 0;
  for (int y = 0; y < t.frame.height; ++y)
    for (int x = 0; x < t.frame.width; ++x)
      if (t.seen(x, y)) sum += t.truth[a].at(x, y) - factor * t.truth[b].at(x, y), ++n;
  return sum / n;
}

// A corner in a folder, and a sky that is brighter on one side.
struct SkyFolder : SceneFolder {
  std::string sky = folder / "sky.pfm";
  Words words = {s(), "--environment", sky, "--env-cache", "none", "--size", "32x24", "--eye", "1.2,1.1,4.9", "--target", "0.9,0.8,0"};

  SkyFolder() { write(0.5); }
  void write(double side) const {
    const auto map = latlong(16, [&](const glm::dvec3& d) { return glm::dvec3(1 + side * d.x, 1, 0.5 * (1 + d.y)); });
    const auto bytes = engine::encodeImage(engine::FileFormat::Pfm, {{"color", {"R", "G", "B"}, engine::imageOfEnvironment(map)}});
    REQUIRE((bytes.ok() && engine::writeFileAtomically(sky, {bytes->data(), bytes->size()}).ok()));
  }
  const std::string& s() const { return scene; }
};

}  // namespace

TEST_CASE("environment truth: an even map gives its radiance times O and times W, and in real shadows what O of all distances leaves") {
  for (const float radius : {0.5f, 100.0f}) {
    TracedScene t(20, 15, 64);
    t.truthSettings.radius = radius;
    makeCorner(t);
    t.trace();
    t.traceEnvironment(evenMap(), 30, 1.5);
    const double radiance[] = {3, 1.5, 0};
    for (int c = 0; c < 3; ++c) {
      const double margin = 5e-3 * radiance[c] + 1e-6;
      checkAgainst(t, channel(TruthQuantity::OpenR, c), margin, [&](int, int) { return radiance[c]; });
      CHECK(std::fabs(meanDifference(t, channel(TruthQuantity::ObscuredR, c), radiance[c], TruthQuantity::Linear)) < margin);
      CHECK(std::fabs(meanDifference(t, channel(TruthQuantity::LitR, c), radiance[c], channel(TruthQuantity::TransferR, c))) < margin);
      if (radius == 100) CHECK(std::fabs(meanDifference(t, channel(TruthQuantity::ShadowedR, c), radiance[c], TruthQuantity::Classic)) < margin);
    }
  }
}

TEST_CASE("environment truth: of one band of harmonics, or half a sphere, a ball has the closed forms' light, in any projection and however turned") {
  const auto radiance = [](const glm::dvec3& d) { return glm::dvec3(1 + 0.5 * d.x, 1 + 0.4 * (3 * d.z * d.z - 1) / 2, d.y > 0 ? 1 : 0); };
  for (const bool turned : {false, true}) {
    const auto map = turned ? filledEnvironment(environmentProjector(engine::EnvironmentProjection::Cube, 64), radiance) : latlong(128, radiance);
    TracedScene t(24, 18, 128);
    addBall(t.addMesh(), {0, 0, 0}, 1, 24);
    t.look({1.5, 2, 4}, {0, 0, 0}, 0.5);
    t.trace();
    t.traceEnvironment(map, turned ? 90 : 0);
    // The cosine's share of the bands 1 and 2 is 2/3 and 1/4.
    checkAgainst(t, TruthQuantity::OpenR, 4e-3, [&](int x, int y) { return 1 + 0.5 * 2 / 3 * (turned ? -t.normal(x, y).z : t.normal(x, y).x); });
    checkAgainst(t, TruthQuantity::OpenG, 4e-3, [&](int x, int y) {
      const double n = turned ? t.normal(x, y).x : t.normal(x, y).z;
      return 1 + 0.4 / 4 * (3 * n * n - 1) / 2;
    });
    checkAgainst(t, TruthQuantity::OpenB, 8e-3, [&](int x, int y) { return (1 + t.normal(x, y).y) / 2; });
    CHECK(std::fabs(meanDifference(t, TruthQuantity::ShadowedB, 1, TruthQuantity::OpenB)) < 4e-3);
  }
}

TEST_CASE("environment truth: half a sphere over a plane is 1, a small sun is found by importance, and a card far beyond R shades it") {
  const auto map = latlong(32, [](const glm::dvec3& d) {
    return glm::dvec3(d.y > 0 ? 1 : 0, glm::dot(d, glm::normalize(glm::dvec3(1, 1.2, 0.4))) > 0.997 ? 5000 : 0, 0);
  });
  double expected = 0;
  const int n = 500;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const double y = (j + 0.5) / n, phi = kPi * (i + 0.5) / n, across = std::sqrt(1 - y * y);
      expected += map.lookUp({across * std::cos(phi), y, across * std::sin(phi)}).y * y / (n * n);  // cos dw / pi = 2 y dy dphi / 2 pi
    }
  REQUIRE(expected > 1);
  TracedScene t(20, 15, 128);
  addFloor(t);
  TracedScene::addQuad(t.addMesh(), {3, 3, -9}, {9, 3, -9}, {9, 3, 9}, {3, 3, 9});
  t.look({0.8, 6, 2.5}, {0.8, 0, 0.1}, 0.4);  // through beside the card
  t.trace();
  t.traceEnvironment(map);
  checkAgainst(t, TruthQuantity::OpenR, 0.01, [&](int, int) { return 1.0; });
  int lit = 0, shaded = 0;
  for (int y = 0; y < 15; ++y)
    for (int x = 0; x < 20; ++x) {
      if (t.frame.g.instance.at(x, y) != 0) continue;
      REQUIRE(t.truth[TruthQuantity::OpenG].at(x, y) == Approx(expected).epsilon(0.2));
      REQUIRE(t.truth[TruthQuantity::ObscuredG].at(x, y) == t.truth[TruthQuantity::OpenG].at(x, y));
      REQUIRE(t.truth.error[size_t(TruthQuantity::OpenG)].at(x, y) < 0.1 * expected);
      const double part = t.truth[TruthQuantity::ShadowedG].at(x, y) / expected;
      lit += part > 0.9, shaded += part < 0.1;
    }
  INFO(lit << " " << shaded << " " << expected);
  CHECK((lit > 20 && shaded > 20));
}

TEST_CASE("environment truth: into the closed white room no ray comes, and its recursive light is that outside") {
  TracedScene t(16, 12, 32);
  t.paint({1, 1, 1});
  t.truthSettings.radius = 8;
  addBox(t.addMesh(), {-1, -1, -1}, {1, 1, 1});
  t.look({0, 0, 0.9}, {0, -0.2, -1}, 1.6);
  t.trace();
  t.traceEnvironment(evenMap());
  double mean = 0;
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 16; ++x) {
      REQUIRE(t.truth[TruthQuantity::ShadowedR].at(x, y) == 0);
      mean += t.truth[TruthQuantity::LitR].at(x, y) / (16 * 12);
    }
  CHECK(mean == Approx(2).margin(0.02));
}

TEST_CASE("environment truth: the same bits for any number of threads, kept by the map's content, turn and factor") {
  TracedScene t(9, 7, 16);
  makeCorner(t);
  std::vector<float> first;
  for (const int threads : {1, 3}) {
    t.truthSettings.threads = threads;
    t.trace();
    t.traceEnvironment(evenMap());
    std::vector<float> all;
    for (const auto* planes : {&t.truth.value, &t.truth.error})
      for (const auto& plane : *planes)
        for (int y = 0; y < 7; ++y) all.insert(all.end(), plane.row(y), plane.row(y) + 9);
    REQUIRE(all.size() == size_t(9 * 7 * 2 * (apps::kTruthQuantities + apps::kEnvironmentQuantities)));
    if (threads == 1) first = all;
    CHECK(all == first);
  }
  engine::EnvironmentMap map = evenMap(), other = evenMap();
  other.at(0, 3, 2).y += 1;
  engine::FrameSettings plain, turned, brighter;
  turned.environmentRotation = 10, brighter.environmentIntensity = 2;
  const std::set<std::string> keys = {apps::environmentTruthKey("a", map, plain), apps::environmentTruthKey("b", map, plain),
                                      apps::environmentTruthKey("a", other, plain), apps::environmentTruthKey("a", map, turned),
                                      apps::environmentTruthKey("a", map, brighter)};
  CHECK(keys.size() == 5);
  CHECK(apps::environmentTruthKey("a", evenMap(), plain) == apps::environmentTruthKey("a", map, plain));
}

TEST_CASE("environment truth: the program has its planes with a map and keeps them by it, and refuses them without one") {
  const SkyFolder s;
  const Words words = Words{"truth"} + s.words + Words{"--rays", "16", "--cache", s / "cache"};
  const Json first = printedBy(words + Words{"--plane", "environment_lit,linear", "-o", s / "light.npy"});
  CHECK(first["planes"].size() == 13);
  const auto lit = engine::readImage(s / "light.environment_lit.npy");
  REQUIRE(lit.ok());
  CHECK((lit->width == 32 && lit->channels == 3));
  const Json second = printedBy(words);
  CHECK((first["cached"] == false && second["cached"] == true));
  CHECK(second["planes"] == first["planes"]);
  s.write(-0.5);
  const Json other = printedBy(words);
  CHECK(other["cached"] == false);
  CHECK(other["key"] == first["key"]);
  CHECK(other["environment_key"] != first["environment_key"]);
  CHECK(other["planes"][3] == first["planes"][3]);
  CHECK(other["planes"][10] != first["planes"][10]);
  checkFails({"truth", s.scene, "--no-cache", "--plane", "environment_lit", "-o", s / "x.npy"}, 2);
  checkFails({"truth", s.scene, "--no-cache", "--environment", s / "none.hdr"}, 3);
}

TEST_CASE("irradiance: O and W by rays are exact under an even sky, nine coefficients add nothing to a sky of two bands") {
  const SkyFolder s;
  const Words words = Words{"irradiance"} + s.words + Words{"--rays", "128", "--radius", "1", "--no-cache"};
  const auto rowsOf = [&](double side) {
    s.write(side);
    std::map<std::string, Json> rows;
    const Json out = printedBy(words);
    for (const Json& r : out["rows"])
      rows[std::string(r["light"]) + " " + std::string(r["factor"]) + " " + std::string(r["source"]) + " " + std::string(r["truth"])] = r;
    return rows;
  };
  const auto even = rowsOf(0), sided = rowsOf(0.9);
  REQUIRE(even.size() == kIrradianceRows);
  const auto rmse = [](const auto& rows, const char* name) { return double(rows.at(name)["rmse"]); };
  for (const auto* rows : {&even, &sided}) CHECK(rmse(*rows, "nine 1  open") < 0.02);
  CHECK(rmse(sided, "rays O rays obscured") > 1.5 * rmse(even, "rays O rays obscured"));
  for (const char* name : {"O ", "W "}) {
    const std::string truth = name[0] == 'O' ? " obscured" : " lit", light = std::string("nine ") + name;
    CHECK(double(sided.at(light + "rays" + truth)["rmse"]) < double(sided.at(light + "depth map" + truth)["rmse"]));
  }
  CHECK(rmse(sided, "nine O depth map shadowed") < rmse(sided, "nine 1  shadowed"));
}

TEST_CASE("irradiance: table, CSV and map have every row, nonsense ends with exit code 2") {
  const SkyFolder s;
  const Words words = Words{"irradiance"} + s.words + Words{"--rays", "8", "--no-cache"};
  const Finished f = runProgram(words + Words{"--csv", s / "rows.csv", "--map", "5", s / "map.png"});
  INFO(f.err);
  REQUIRE(f.code == 0);
  CHECK(f.out.find("irradiance / pi, 8 rays a pixel") != f.out.npos);
  const std::string csv = contentOf(s / "rows.csv");
  CHECK(size_t(std::count(csv.begin(), csv.end(), '\n')) == 1 + kIrradianceRows);
  CHECK(engine::readImage(s / "map.png").ok());
  for (const Words& wrong : {Words{"--map", "0", s / "m.png"}, Words{"--map", "99", s / "m.png"}, Words{"--env-intensity", "-1"}})
    checkFails(words + wrong, 2);
  checkFails({"irradiance", s.scene}, 2);
}
