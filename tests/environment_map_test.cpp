// Environment maps: projector functions, look-ups without seams, conversions, files.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>

#include "environment_maps.h"
#include "fnv1a.h"
#include "obscura/engine/environment_map.h"
#include "obscura/engine/image_file.h"
#include "temporary_folder.h"

using namespace obscura;
using namespace obscura::tests;
using engine::EnvironmentMap;
using engine::EnvironmentProjector;
using Projection = engine::EnvironmentProjection;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr Projection kAll[] = {Projection::Latlong, Projection::Sphere, Projection::Cube, Projection::Paraboloid};

struct Random {
  std::mt19937 bits{17};
  double in(double lo, double hi) { return lo + (hi - lo) * (double(bits()) * 0x1p-32); }
  glm::dvec3 direction() {
    const double z = in(-1, 1), angle = in(0, 2 * kPi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
};

// Smooth and without symmetry; another one in each channel.
glm::dvec3 sky(const glm::dvec3& d) {
  return {1 + 0.5 * d.x + 0.3 * d.y * d.z, 2 + d.y - 0.4 * d.x * d.z, 1.5 - 0.7 * d.z + 0.5 * d.x * d.y};
}

double difference(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }

}  // namespace

TEST_CASE("environment: every direction has a point in every projection, and the point has that direction") {
  Random random;
  for (Projection projection : kAll) {
    const EnvironmentProjector p = environmentProjector(projection, 64);
    double worst = 0;
    for (int k = 0; k < 20000; ++k) {
      const glm::dvec3 d = random.direction();
      const engine::PanelPoint at = p.pointOf(d * random.in(0.01, 100));
      REQUIRE((at.panel >= 0 && at.panel < p.panels() && at.x >= 0 && at.x <= p.width && at.y >= 0 && at.y <= p.height));
      // A sphere map shrinks the directions around -z more and more.
      const double stretched = projection == Projection::Sphere ? std::sqrt(std::max(0.0, (1 + d.z) / 2)) : 1;
      worst = std::max(worst, difference(p.directionAt(at), d) * stretched);
    }
    CAPTURE(int(projection), worst);
    CHECK(worst < 1e-14);
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
      CHECK(difference(p.directionAt(p.pointOf(axis)), axis) < 1e-14);
  }
}

TEST_CASE("environment: -z is in the middle, +x to the right of it and +y above, but for the mirror ball that shows +z in the middle") {
  const auto at = [](Projection projection, const glm::dvec3& d) { return environmentProjector(projection, 16).pointOf(d); };
  const auto lies = [](const engine::PanelPoint& p, int panel, double x, double y) {
    CAPTURE(p.panel, p.x, p.y);
    CHECK((p.panel == panel && std::fabs(p.x - x) < 1e-12 && std::fabs(p.y - y) < 1e-12));
  };
  lies(at(Projection::Latlong, {0, 0, -1}), 0, 16, 8);
  lies(at(Projection::Latlong, {1, 0, 0}), 0, 24, 8);
  lies(at(Projection::Latlong, {0, 1, -1}), 0, 16, 4);
  lies(at(Projection::Sphere, {0, 0, 1}), 0, 8, 8);
  lies(at(Projection::Sphere, {1, 0, 0}), 0, 8 + 8 * std::sqrt(0.5), 8);
  lies(at(Projection::Sphere, {0, 1, 0}), 0, 8, 8 - 8 * std::sqrt(0.5));
  lies(at(Projection::Cube, {0.5, 0, -1}), 5, 12, 8);   // right of the middle of -z
  lies(at(Projection::Cube, {1, 0, -0.5}), 0, 4, 8);    // and on +x, left of its middle
  lies(at(Projection::Cube, {0, 1, -0.5}), 2, 8, 12);   // +y: its lower edge is that above -z
  lies(at(Projection::Cube, {0, -1, -0.5}), 3, 8, 4);
  lies(at(Projection::Paraboloid, {1, 0, 0}), 0, 16, 8);
  lies(at(Projection::Paraboloid, {0, 1, -1e-300}), 0, 8, 0);
  lies(at(Projection::Paraboloid, {0.6, 0, 0.8}), 1, 8 - 8 * 0.6 / 1.8, 8);
}

TEST_CASE("environment: solid angles of texels are the share of directions that fall into them, and add up to the sphere") {
  Random random;
  for (Projection projection : kAll) {
    const EnvironmentProjector p = environmentProjector(projection, 8);
    std::vector<int> hits(size_t(p.panels() * p.width * p.height));
    constexpr int kDirections = 200000;
    for (int k = 0; k < kDirections; ++k) {
      const engine::PanelPoint at = p.pointOf(random.direction());
      ++hits[size_t((at.panel * p.height + std::min(int(at.y), p.height - 1)) * p.width + std::min(int(at.x), p.width - 1))];
    }
    int wrong = 0;
    for (size_t k = 0; k < hits.size(); ++k) {
      const double expected = p.solidAngle(int(k) % p.width, int(k) / p.width % p.height) / (4 * kPi) * kDirections;
      wrong += std::fabs(hits[k] - expected) > 5 * std::sqrt(expected) + 0.01 * expected;
    }
    CAPTURE(int(projection));
    CHECK(wrong == 0);
    const bool exact = projection == Projection::Latlong || projection == Projection::Cube;
    for (const auto& [side, error] : {std::pair{16, 1e-3}, {256, 1e-5}}) {
      const EnvironmentProjector q = environmentProjector(projection, side);
      double sum = 0;
      for (int y = 0; y < q.height; ++y)
        for (int x = 0; x < q.width; ++x) sum += q.panels() * q.solidAngle(x, y);
      CAPTURE(side, sum / (4 * kPi) - 1);
      CHECK(std::fabs(sum / (4 * kPi) - 1) < (exact ? 1e-11 : error));
    }
  }
}

TEST_CASE("environment: look-ups have no seams: not where longitudes wrap, nor at poles, edges and corners of a cube, rims") {
  Random random;
  for (Projection projection : kAll) {
    const auto noise = [&](const glm::dvec3&) { return glm::dvec3(random.in(0, 1), random.in(0, 1), random.in(0, 1)); };
    const bool paraboloid = projection == Projection::Paraboloid;  // continuous as far as it interpolates well
    const EnvironmentMap map = paraboloid ? filledEnvironment(environmentProjector(projection, 128), sky) : filledEnvironment(environmentProjector(projection, 16), noise);
    double worst = 0;
    for (int k = 0; k < 4000; ++k) {
      glm::dvec3 d = random.direction();
      const double tiny = random.in(-1e-9, 1e-9), other = random.in(-1e-9, 1e-9);
      switch (k % 5) {
        case 0: d.x = tiny, d.z = std::fabs(d.z); break;                                        // where longitudes wrap
        case 1: d = {tiny, k % 2 ? 1 : -1, other}; break;                                       // poles
        case 2: d[k % 3] = d[(k + 1) % 3] * (k % 4 ? 1 + tiny : -1 + tiny); break;              // edges of a cube
        case 3: d = {k & 8 ? 1 : -1, k & 16 ? 1 + tiny : -1, k & 32 ? 1 : other - 1}; break;  // its corners
        default: d = k & 1 ? glm::dvec3(tiny, other, -1) : glm::dvec3(d.x, d.y, tiny); break;   // rims
      }
      const glm::dvec3 step(random.in(-2e-9, 2e-9), random.in(-2e-9, 2e-9), random.in(-2e-9, 2e-9));
      worst = std::max(worst, difference(map.lookUp(d), map.lookUp(d + step)));
    }
    CAPTURE(int(projection), worst);
    CHECK(worst < (paraboloid ? 3e-3 : 1e-6));
  }
}

TEST_CASE("environment: a white map is white in every projection and direction") {
  raster::Parallel parallel(2);
  Random random;
  for (Projection from : kAll)
    for (Projection to : kAll) {
      const EnvironmentMap white = filledEnvironment(environmentProjector(from, 9), [](const glm::dvec3&) { return glm::dvec3(1, 1, 1); });
      const EnvironmentMap map = convertEnvironment(white, environmentProjector(to, 7), parallel);
      for (int k = 0; k < 500; ++k) REQUIRE(difference(map.lookUp(random.direction()), glm::dvec3(1)) < 1e-6);
    }
}

TEST_CASE("environment: a smooth sky survives every conversion, one after the other, and a round trip says how well") {
  raster::Parallel parallel(2);
  Random random;
  EnvironmentMap map = filledEnvironment(environmentProjector(Projection::Latlong, 64), sky);
  const EnvironmentMap first = map;
  for (Projection to : {Projection::Cube, Projection::Sphere, Projection::Paraboloid, Projection::Cube, Projection::Latlong}) {
    const EnvironmentProjector p = engine::projectorOfTexels(to, engine::usedTexels(first.projector()));
    CHECK(engine::usedTexels(p) >= engine::usedTexels(first.projector()));
    map = convertEnvironment(map, p, parallel);
    double worst = 0;
    for (int k = 0; k < 3000; ++k) {
      const glm::dvec3 d = random.direction();
      if (d.z > -0.9) worst = std::max(worst, difference(map.lookUp(d), sky(d)));  // but where a sphere map shows least
    }
    CAPTURE(int(to), worst);
    CHECK(worst < 0.02);
  }
  const engine::EnvironmentDifference lost = compareEnvironments(first, map, parallel);
  CHECK((lost.rmse > 0 && lost.rmse < 0.02));
  CHECK(lost.relative == Approx(lost.rmse / 1.55).epsilon(0.1));
  CHECK(lost.largest >= lost.rmse);
  CHECK(compareEnvironments(first, first, parallel).largest < 1e-12);
}

TEST_CASE("environment: a smaller map is a mean of the larger one: a checkerboard becomes grey") {
  raster::Parallel parallel(2);
  int k = 0;
  const EnvironmentMap board = filledEnvironment(environmentProjector(Projection::Latlong, 64), [&](const glm::dvec3&) { ++k; return glm::dvec3((k / 128 + k) % 2); });
  const EnvironmentMap small = convertEnvironment(board, environmentProjector(Projection::Latlong, 8), parallel);
  for (int x = 0; x < 16; ++x) CHECK(small.at(0, x, 4).x == Approx(0.5).margin(0.02));
}

TEST_CASE("environment: conversions have the same bits with any number of threads and on every machine") {
  const EnvironmentMap map = filledEnvironment(environmentProjector(Projection::Latlong, 20), sky);
  for (int threads : {1, 2, 8}) {
    raster::Parallel parallel(threads);
    uint64_t h = tests::kFnvStart;
    for (Projection to : kAll) {
      const engine::Image image = imageOfEnvironment(convertEnvironment(map, environmentProjector(to, 15), parallel));
      h = tests::fnv1a(image.bytes.data(), image.bytes.size(), h);
    }
    CHECK(h == 0x40783a3a392c3904ull);
  }
}

TEST_CASE("environment: of a file floats are radiance, bytes are sRGB, and what is no radiance is counted") {
  const TemporaryFolder folder;
  raster::Parallel parallel(2);
  const auto write = [&](const std::string& name, engine::FileFormat format, const engine::Image& image) {
    const auto bytes = engine::encodeImage(format, {{"color", {"R", "G", "B"}, image}});
    REQUIRE(bytes.ok());
    REQUIRE(engine::writeFileAtomically(folder / name, *bytes).ok());
    return readEnvironmentMap(folder / name, Projection::Latlong, parallel);
  };
  engine::Image floats(4, 2, 3, engine::Format::F32);
  float* v = floats.row<float>(0);
  for (int k = 0; k < 24; ++k) v[k] = float(k);
  v[3] = -1, v[4] = std::numeric_limits<float>::quiet_NaN(), v[5] = std::numeric_limits<float>::infinity();
  const auto radiance = write("a.npy", engine::FileFormat::Npy, floats);
  REQUIRE(radiance.ok());
  CHECK(radiance->clamped == 3);
  CHECK(radiance->map.at(0, 1, 0) == glm::vec3(0, 0, EnvironmentMap::kMostRadiance));
  CHECK(radiance->map.at(0, 3, 1) == glm::vec3(21, 22, 23));

  engine::Image bytes(4, 2, 1, engine::Format::U8);
  bytes.bytes = {0, 255, 188, 10, 0, 0, 0, 0};
  const auto grey = write("a.png", engine::FileFormat::Png, bytes);
  REQUIRE(grey.ok());
  CHECK(grey->map.at(0, 1, 0) == glm::vec3(1));
  CHECK(grey->map.at(0, 2, 0).y == Approx(0.5).margin(0.005));

  const auto wide = write("b.npy", engine::FileFormat::Npy, engine::Image(5, 2, 3, engine::Format::F32));
  REQUIRE_FALSE(wide.ok());
  CHECK(wide.error().code == engine::ErrorCode::BadInput);
  CHECK(wide.error().message.find("5 x 2") != std::string::npos);
  CHECK_FALSE(write("c.npy", engine::FileFormat::Npy, engine::Image(4, 2, 3, engine::Format::U32)).ok());
  CHECK_FALSE(readEnvironmentMap(folder / "none.exr", Projection::Cube, parallel).ok());
}

TEST_CASE("environment: only images of a map's shape are maps, and a map fills its image") {
  CHECK(engine::projectorOfImage(Projection::Latlong, 8, 4));
  CHECK(engine::projectorOfImage(Projection::Cube, 8, 6)->width == 2);
  CHECK(engine::projectorOfImage(Projection::Paraboloid, 8, 4)->width == 4);
  for (Projection p : kAll)
    for (const auto& [w, h] : {std::pair{0, 0}, {7, 4}, {9, 6}, {8, 7}, {3, 2}, {-8, -4}, {2, 3}})
      CHECK_FALSE(engine::projectorOfImage(p, w, h));
  const engine::Image cross = imageOfEnvironment(filledEnvironment(environmentProjector(Projection::Cube, 4), sky));
  CHECK((cross.width == 16 && cross.height == 12));
  CHECK(cross.row<float>(0)[0] == 0);
  const glm::dvec3 up = sky(glm::normalize(glm::dvec3(-0.75, 1, 0.75)));
  CHECK(cross.row<float>(0)[4 * 3] == Approx(up.x));
}
