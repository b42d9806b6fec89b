// Any number of classes of the extended ambient term: how they part the sphere, and what becomes of light with more of them.
#include <catch2/catch.hpp>

#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/engine/extended_ambient.h"
#include "room_scene.h"

using namespace obscura;
using namespace obscura::tests;
using engine::spreadDirections;

namespace {

// Weights of a normal by class, which add up to 1.
std::vector<double> weightsOf(const glm::dvec3& n, const std::vector<glm::dvec3>& directions) {
  std::vector<double> w;
  double all = 0;
  for (const glm::dvec3& f : directions) all += w.emplace_back(std::max(0.0, glm::dot(n, f)));
  REQUIRE(all > 0);
  for (double& v : w) v /= all;
  return w;
}

std::vector<post::AmbientDirection> lightIn(const engine::Scene& scene, int classes, int threads = 1) {
  raster::Parallel parallel(threads);
  const auto light = engine::extendedAmbient(scene, glm::dvec3(1), parallel, nullptr, classes);
  REQUIRE(light.ok());
  return *light;
}

// D(n) of these directions.
glm::dvec3 lightAt(const glm::dvec3& n, const std::vector<post::AmbientDirection>& directions) {
  std::vector<glm::dvec3> all;
  for (const post::AmbientDirection& k : directions) all.push_back(glm::dvec3(k.direction));
  const std::vector<double> w = weightsOf(n, all);
  glm::dvec3 sum(0);
  for (size_t k = 0; k < w.size(); ++k) sum += w[k] * glm::dvec3(directions[k].color);
  return sum;
}

const engine::Scene& redAndGreen() {
  static const engine::Scene scene = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f)).scene;
  return scene;
}

}  // namespace

TEST_CASE("ambient classes: any number of directions parts the sphere: unit, none twice, each with the same share, their mean along the normal") {
  const std::vector<glm::dvec3> normals = spreadDirections(256);
  const struct { int count; double degrees; } kMost[] = {{4, 37}, {5, 43}, {6, 0.01}, {7, 21.5}, {8, 0.01}, {9, 17.5}, {12, 0.01}, {16, 5.5}, {20, 0.01}, {64, 1.2}, {255, 0.5}};
  for (const auto& most : kMost) {
    const std::vector<glm::dvec3> f = spreadDirections(most.count);
    INFO(most.count << " classes");
    REQUIRE(f.size() == size_t(most.count));
    for (size_t i = 0; i < f.size(); ++i) {
      CHECK(glm::dot(f[i], f[i]) == Approx(1).epsilon(1e-14));
      for (size_t j = 0; j < i; ++j) REQUIRE(glm::dot(f[i], f[j]) < 0.999);
    }
    std::vector<double> shares(f.size());
    double worst = 1;
    for (const glm::dvec3& n : normals) {
      const std::vector<double> w = weightsOf(n, f);
      glm::dvec3 mean(0);
      for (size_t k = 0; k < w.size(); ++k) mean += w[k] * f[k], shares[k] += w[k] * double(f.size()) / double(normals.size());
      worst = std::min(worst, glm::dot(n, glm::normalize(mean)));
    }
    CHECK(std::acos(std::min(1.0, worst)) * 57.29578 <= most.degrees);
    for (double share : shares) CHECK(std::fabs(share - 1) < 0.08);
  }
}

TEST_CASE("ambient classes: with any number of them a closed room of one reflectance has the light of its reflections, and no class more than others") {
  const engine::Scene grey = room(glm::vec3(0.5f), glm::vec3(0.5f), glm::vec3(0.5f)).scene;
  for (int count : {4, 5, 6, 8, 17, 64, 256})
    for (const post::AmbientDirection& k : lightIn(grey, count)) CHECK(k.color.x == Approx(2));
}

TEST_CASE("ambient classes: what faces the red wall is reddish with any number, ever less so, and in the end all walls light all alike") {
  double last = 2;
  for (int count : {6, 12, 20, 64, 256}) {
    const auto light = lightIn(redAndGreen(), count);
    const glm::dvec3 left = lightAt({-1, 0, 0}, light), right = lightAt({1, 0, 0}, light);  // the red wall is at the left
    INFO(count << " classes");
    CHECK(left.r > left.g);
    CHECK(right.g > right.r);
    CHECK(left.r / left.g < last);
    CHECK(left.r == Approx(right.g).epsilon(0.01));
    CHECK(left.b == Approx(right.b).epsilon(0.01));
    last = left.r / left.g;
  }
  CHECK(last < 1.01);
  // All classes see all: B = rho (1 + mean B), so that the light is 1 / (1 - mean rho) where classes blend all walls.
  const glm::dvec3 many = lightAt({0, 1, 0}, lightIn(redAndGreen(), 256)), more = lightAt({0, 1, 0}, lightIn(redAndGreen(), 128));
  for (int c = 0; c < 3; ++c) CHECK(many[c] == Approx(more[c]).epsilon(0.005));
  CHECK(many.b == Approx(1 / (1 - (4 * 0.5 + 2 * 0.1) / 6)).epsilon(0.03));
}

TEST_CASE("ambient classes: the number of threads changes no bit of any number of classes") {
  const auto expected = lightIn(redAndGreen(), 31);
  for (int threads : {2, 8}) {
    const auto found = lightIn(redAndGreen(), 31, threads);
    for (size_t k = 0; k < expected.size(); ++k) CHECK((found[k].color == expected[k].color && found[k].direction == expected[k].direction));
  }
}

TEST_CASE("ambient classes: frames with other numbers have one digest for threads, targets and the twins, and change smoothly over a ball") {
  Builder b = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f));
  b.add(ball(0.8), glm::vec3(0.95f));
  engine::FrameSettings s;
  s.width = 61, s.height = 41;
  s.camera = raster::perspective(1.0, 1.5, 0.01);
  s.camera.viewFromWorld = raster::lookAt({0.2, 0.3, 1.9}, {0, 0, 0}, {0, 1, 0});
  s.ambient = post::Occlusion::None;
  s.brdf = post::Brdf::Lambert;
  for (int count : {4, 5, 33}) {
    s.ambientDirections = lightIn(b.scene, count);
    const engine::Frame expected = frameOf(b.scene, s, {}, true);
    for (raster::Target target : raster::supportedTargets())
      for (int threads : {1, 3}) {
        const engine::Frame found = frameOf(b.scene, s, {threads, target});
        INFO(count << " classes, " << raster::targetName(target));
        for (int c = 0; c < 3; ++c) REQUIRE(firstDifference("color", found.color.rgb[c], expected.color.rgb[c]) == "");
      }
    for (int x = 17; x < 43; ++x) CHECK(std::fabs(expected.color.rgb[0].at(x, 22) - expected.color.rgb[0].at(x - 1, 22)) < 0.06f * expected.color.rgb[0].at(x, 22));
  }
}
