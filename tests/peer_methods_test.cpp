// Other people's methods, as the benchmark has them, against their twins and against what mathematics says.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include "obscura/apps/peer_methods.h"
#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using apps::PeerAim;
using apps::PeerMethod;
using apps::PeerSettings;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr PeerMethod kMethods[] = {PeerMethod::Ssao, PeerMethod::Hbao, PeerMethod::Vao, PeerMethod::Gtao};
constexpr PeerAim kAims[] = {PeerAim::Own, PeerAim::Obscurance};

struct PeerFrame {
  post::TransferInput in;
  post::TransferSums sums;
  post::Transfer transfer;

  // target empty: by the twin. band: rows that are done together. Only rows first ... end - 1 are filtered.
  PeerFrame(const raster::GBuffer& g, const raster::Camera& camera, const PeerSettings& peer, const post::AmbientSettings& settings,
            std::optional<raster::Target> target, int band = 1000, int first = 0, int endRow = 1000) {
    in = {&g, post::makeProjector(camera, g.width, g.height), settings, apps::peerPoints(peer, settings)};
    in.settings.albedo = post::TransferAlbedo::Own;
    sums = post::makeTransferSums(in);
    transfer = post::makeTransfer(g.width, g.height, {true});
    endRow = std::min(endRow, g.height);
    const int used = std::min(endRow + 1, g.height);
    for (int y = std::max(first - 2, 0); y < used; y += band) {
      const int end = std::min(y + band, used);
      target ? apps::peerOcclusion(peer, in, y, end, sums, *target) : apps::peerOcclusionRef(peer, in, y, end, sums);
    }
    target ? post::depthFilter(in, sums, first, endRow, transfer, *target) : post::depthFilterRef(in, sums, first, endRow, transfer);
    apps::clampPeers(first, endRow, transfer);
  }
};

std::string difference(const PeerFrame& a, const PeerFrame& b) {
  for (int y = 0; y < a.sums.open.height(); ++y)
    for (int x = 0; x < a.sums.open.width(); ++x)
      if (a.sums.open.at(x, y) != b.sums.open.at(x, y)) return "open differs";
  const std::string sums = firstDifference("numerator", a.sums.numerator, b.sums.numerator);
  return sums.empty() ? firstDifference("obscurance", a.transfer.obscurance, b.transfer.obscurance) : sums;
}

post::AmbientSettings settingsOf(uint32_t seed) {
  Random random(seed + 500);
  post::AmbientSettings s;
  s.samples = random.integer(1, 9);
  s.radius = random.real(0.2f, 2);
  s.bias = random.real(0, 0.02f);
  s.silhouetteBound = seed % 3 != 1;
  s.interleave = seed % 4 != 1;
  s.filterGuide = seed % 2 ? post::FilterGuide::Depth : post::FilterGuide::Plane;
  return s;
}

// A room's corner, or its floor alone, seen from (2, 1.6, 0); floor y = 0, wall x = 0.
struct Room {
  TestScene scene;
  raster::GBuffer g;

  explicit Room(bool wall, int width = 128, int height = 96) {
    scene.materials.resize(1);
    scene.materials[0].doubleSided = true;
    scene.width = width, scene.height = height;
    quad({-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9});
    if (wall) quad({0, 0, -9}, {0, 9, -9}, {0, 9, 9}, {0, 0, 9});
    scene.camera = raster::perspective(0.5, double(width) / height, 0.01);
    scene.camera.viewFromWorld = raster::lookAt(glm::dvec3(2.2, 1.9, 0.4), glm::dvec3(0.35, 0.1, 0), {0, 1, 0});
    g = gbufferOf(scene);
  }
  void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    TestMesh& m = scene.addMesh();
    TestScene::addQuad(m, a, b, c, d);
    scene.place(m);
  }
  // Distance of the pixel's point from the side that it does not lie on.
  double distance(int x, int y) const {
    const post::Projector p = post::makeProjector(scene.camera, g.width, g.height);
    const double z = g.depth.at(x, y);
    const glm::dvec4 view((x + 0.5 - p.xCenter) * p.xInverse * z, (y + 0.5 - p.yCenter) * p.yInverse * z, -z, 1);
    const glm::dvec4 world = glm::inverse(scene.camera.viewFromWorld) * view;
    return std::max(world.x, world.y);
  }
};

post::AmbientSettings many() {
  post::AmbientSettings s;
  s.samples = 8;
  s.radius = 0.5f;
  s.filterGuide = post::FilterGuide::Plane;
  return s;
}

// Mean of value(distance of the wall in units of R) over the half sphere, evenly or by the cosine; the wall at the distance h.
double overHalfSphere(double h, bool cosine, const std::function<double(double)>& value) {
  double sum = 0;
  const int n = 80;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double xi = (i + 0.5) / n, up = cosine ? std::sqrt(1 - xi) : xi;
      const double towards = std::sqrt(1 - up * up) * std::cos(2 * kPi * (j + 0.5) / n);
      sum += value(towards > 0 ? std::min(h / towards, 1.0) : 1);
    }
  return sum / (n * n);
}

// The same of every distance, tabulated.
std::function<double(double)> corner(bool cosine, const std::function<double(double)>& value) {
  constexpr int kCells = 64;
  std::vector<double> table;
  for (int i = 0; i <= kCells; ++i) table.push_back(overHalfSphere(i / double(kCells), cosine, value));
  return [table](double h) {
    const double at = std::min(h, 0.9999) * kCells;
    const size_t cell = size_t(at);
    return table[cell] + (table[cell + 1] - table[cell]) * (at - double(cell));
  };
}

// Rows in the middle of the image: beyond its border the corner goes on unseen.
constexpr int kFirstRow = 44, kEndRow = 52;
PeerFrame middle(const Room& room, const PeerSettings& peer) {
  return PeerFrame(room.g, room.scene.camera, peer, many(), raster::Target::Auto, 1000, kFirstRow, kEndRow);
}

// The largest error, and the mean.
struct Errors {
  double worst = 0, mean = 0;
};
Errors errorsIn(const Room& room, const PeerFrame& f, const std::function<double(double)>& expected) {
  Errors e;
  int n = 0;
  for (int y = kFirstRow; y < kEndRow; ++y)
    for (int x = 26; x < room.g.width - 26; ++x, ++n) {
      const double d = f.transfer.obscurance.at(x, y) - expected(room.distance(x, y) / 0.5);
      e.worst = std::max(e.worst, std::fabs(d));
      e.mean += d;
    }
  e.mean /= n;
  return e;
}

}  // namespace

TEST_CASE("peers: every method equals its scalar twin on all targets, however the rows are divided") {
  for (uint32_t seed = 0; seed < 8; ++seed) {
    const TestScene s = soupScene(seed);
    const raster::GBuffer rendered = gbufferOf(s), odd = hostileGBuffer(seed);
    const raster::Camera oddCamera = seed % 4 == 1 ? raster::orthographic(2, 1, 0.1, 50) : raster::perspective(1, 2, 0.1);
    for (const bool hostile : {false, true}) {
      const PeerSettings peer{kMethods[seed % 4], kAims[seed / 4 % 2], 1 + int(seed % 5)};
      const raster::GBuffer& g = hostile ? odd : rendered;
      const raster::Camera& camera = hostile ? oddCamera : s.camera;
      const PeerFrame expected(g, camera, peer, settingsOf(seed), std::nullopt);
      for (const raster::Target target : raster::supportedTargets()) {
        INFO("seed " << seed << " target " << raster::targetName(target) << (hostile ? " hostile" : ""));
        REQUIRE(difference(PeerFrame(g, camera, peer, settingsOf(seed), target, 1 + int(seed % 7)), expected) == "");
      }
      for (int y = 0; y < g.height; ++y)
        for (int x = 0; x < g.width; ++x)
          REQUIRE((expected.transfer.obscurance.at(x, y) >= 0 && expected.transfer.obscurance.at(x, y) <= 1));
    }
  }
}

TEST_CASE("peers: a slanted plane is open, to 1/50 where points are counted by texels, to 1/300 elsewhere") {
  const Room room(false);
  for (const PeerMethod method : kMethods)
    for (const PeerAim aim : kAims) {
      const PeerFrame f = middle(room, {method, aim, 4});
      const Errors e = errorsIn(room, f, [](double) { return 1; });
      INFO(int(method) << " aim " << int(aim) << " worst " << e.worst << " mean " << e.mean);
      CHECK(e.worst < (method == PeerMethod::Ssao ? 0.02 : 1.0 / 300));
    }
}

TEST_CASE("peers: in a corner each has the value that it aims at") {
  const Room room(true);
  const auto check = [&](PeerMethod method, PeerAim aim, double worst, double mean, const std::function<double(double)>& expected) {
    const PeerFrame f = middle(room, {method, aim, 16});
    const Errors e = errorsIn(room, f, expected);
    INFO(int(method) << " aim " << int(aim) << " worst " << e.worst << " mean " << e.mean);
    CHECK(e.worst < worst);
    CHECK(std::fabs(e.mean) < mean);
  };
  check(PeerMethod::Ssao, PeerAim::Own, 0.1, 0.02, corner(false, [](double d) { return d * d * d; }));
  check(PeerMethod::Ssao, PeerAim::Obscurance, 0.12, 0.02, corner(false, [](double d) { return d; }));
  check(PeerMethod::Hbao, PeerAim::Own, 0.06, 0.02, corner(false, [](double d) { return d * d; }));
  check(PeerMethod::Hbao, PeerAim::Obscurance, 0.1, 0.02, corner(false, [](double d) { return d; }));
  check(PeerMethod::Vao, PeerAim::Own, 0.06, 0.02, [](double h) {
    const double cap = std::max(0.0, 0.5 - h);
    return 1 - cap * cap * (1.5 - cap) / 3 * 6;
  });
  // A horizon that has sunk by a tenth of R is like occluders that end there.
  check(PeerMethod::Gtao, PeerAim::Own, 0.07, 0.02, corner(true, [](double d) { return d < 0.95 ? 0 : 1; }));
  // One horizon for all distances cannot have all of their values: it is too dark here, and suits scenes.
  check(PeerMethod::Gtao, PeerAim::Obscurance, 0.2, 0.09, corner(true, [](double d) { return d; }));
}
