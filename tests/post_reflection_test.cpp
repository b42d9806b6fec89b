// What surfaces reflect of an environment: directions, levels by roughness, occlusion, and that kernel and twin agree.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "obscura/post/environment_reflection.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();

// A chain whose texels are radiance(level, direction), borders included.
template <class F>
std::vector<glm::vec3> filled(post::EnvironmentChain& chain, const F& radiance) {
  const glm::vec3 forward[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::vec3 up[] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
  std::vector<glm::vec3> texels;
  chain.levels = post::kRoughnessLevels;
  for (int level = 0; level < post::kRoughnessLevels; ++level) {
    const int size = chain.sizes[level] = 40 - 3 * level;
    for (int face = 0; face < 6; ++face)
      for (int y = -1; y <= size; ++y)
        for (int x = -1; x <= size; ++x) {
          const float s = (2 * float(x) + 1) / float(size) - 1, t = 1 - (2 * float(y) + 1) / float(size);
          texels.push_back(radiance(level, glm::normalize(forward[face] + s * glm::cross(forward[face], up[face]) + t * up[face])));
        }
  }
  chain.texels = texels;
  return texels;
}

raster::GBuffer buffer(int width, int height) {
  raster::PlaneSet planes;
  planes.depth = planes.normal = planes.roughness = planes.instance = true;
  return {width, height, planes};
}

// One pixel that looks along -z at a surface with this normal.
struct Pixel {
  post::EnvironmentChain chain;
  std::vector<glm::vec3> texels;
  raster::GBuffer g = buffer(1, 1);
  raster::Plane<float> o{1, 1};
  post::ReflectionInput in;

  template <class F>
  explicit Pixel(const F& radiance) : texels(filled(chain, radiance)) {
    g.depth.at(0, 0) = 1;
    set({0, 0, 1}, 0);
    in.g = &g;
    in.projector = post::makeProjector(raster::perspective(1, 1, 0.1), 1, 1);
    in.environment.chain = chain;
  }
  void set(const glm::vec3& n, float roughness) {
    for (int c = 0; c < 3; ++c) g.normal[c].at(0, 0) = n[c];
    g.roughness.at(0, 0) = roughness;
  }
  glm::vec3 reflected() const {
    post::LinearColor out = post::makeLinearColor(1, 1);
    environmentReflectionRef(in, 0, 1, out);
    return {out.rgb[0].at(0, 0), out.rgb[1].at(0, 0), out.rgb[2].at(0, 0)};
  }
  float occlusion(float openness, float nv, float roughness) {
    set({std::sqrt(1 - nv * nv), 0, nv}, roughness);
    o.at(0, 0) = openness;
    in.obscurance = &o;
    return reflected().x;
  }
};

glm::vec3 asLight(int, const glm::vec3& d) { return d + 2.0f; }

}  // namespace

TEST_CASE("environment reflection: kernel and twin agree for any directions, roughness, occlusion and odd values") {
  post::EnvironmentChain chain;
  const std::vector<glm::vec3> texels = filled(chain, [](int level, const glm::vec3& d) { return glm::fract(d * (12.3f + float(level))) * 3.0f; });
  const std::vector<glm::vec3> groups = {{1, 2, 3}, {0.5f, 0, 7}};
  const float odd[] = {0, -0.f, 1, kNaN, kInf, -kInf, 1e-42f, -3};
  for (uint32_t seed = 0; seed < 16; ++seed) {
    Random random(seed);
    const int width = random.integer(1, 70), height = random.integer(1, 20);
    raster::GBuffer g = buffer(width, height);
    raster::Plane<float> o(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        g.depth.at(x, y) = random.integer(0, 3) ? 3 : random.integer(0, 1) ? kInf : kNaN;
        const glm::vec3 n = glm::normalize(glm::vec3(random.vector(-1, 1)));
        for (int c = 0; c < 3; ++c) g.normal[c].at(x, y) = random.integer(0, 60) ? n[c] : odd[random.integer(0, 7)];
        g.roughness.at(x, y) = seed % 4 == 1 ? 1 : random.integer(0, 20) ? random.real(0, 1.f) : odd[random.integer(0, 7)];
        g.instance.at(x, y) = random.integer(0, 3) ? 7 : uint32_t(random.integer(0, 2));
        o.at(x, y) = random.real(0, 1.f);
      }
    const raster::Camera camera = seed % 4 == 3 ? raster::orthographic(2, 1, 0.1, 50) : raster::perspective(1.9, 1.5, 0.1);
    post::ReflectionInput in{&g, seed % 3 ? &o : nullptr, post::makeProjector(camera, 200, 100, raster::Window{random.integer(-20, 90), 3, width, height}), {}, {}};
    in.environment = {chain, glm::mat3(glm::dmat3(raster::lookAt({0, 0, 0}, glm::dvec3(random.vector(-1, 1)), {0.1, 1, 0}))), 0.75f};
    if (seed % 2) in.instances = groups;
    post::LinearColor expected = post::makeLinearColor(width, height);
    environmentReflectionRef(in, 0, height, expected);
    for (raster::Target target : raster::supportedTargets()) {
      post::LinearColor found = post::makeLinearColor(width, height);
      environmentReflection(in, 0, height, found, target);
      INFO("seed " << seed << " target " << raster::targetName(target));
      for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            if (!(g.depth.at(x, y) < kInf)) found.rgb[c].at(x, y) = expected.rgb[c].at(x, y) = 0;
        REQUIRE(firstDifference("reflection", found.rgb[c], expected.rgb[c]) == "");
      }
    }
  }
}

TEST_CASE("environment reflection: a mirror shows what lies in the direction r = 2 (n.v) n - v, in the map's space, times the intensity") {
  Pixel p(asLight);
  Random random(5);
  for (int k = 0; k < 50; ++k) {
    const glm::vec3 n = glm::normalize(glm::vec3(random.vector(-1, 1))), v(0, 0, 1);
    const glm::mat3 turn(glm::dmat3(raster::lookAt({0, 0, 0}, glm::dvec3(random.vector(-1, 1)), {0.1, 1, 0})));
    p.set(n, 0);
    p.in.environment.mapFromView = turn;
    p.in.environment.intensity = 3;
    const glm::vec3 expected = 3.0f * (turn * (2 * glm::dot(n, v) * n - v) + 2.0f);
    CHECK(glm::length(p.reflected() - expected) < 0.01f);
  }
}

TEST_CASE("environment reflection: what is rough looks nearer its normal, and along it in the end") {
  Pixel p(asLight);
  const glm::vec3 n(0.6f, 0, 0.8f), r = 2 * 0.8f * n - glm::vec3(0, 0, 1);
  float last = -2;
  for (int k = 0; k <= 8; ++k) {
    p.set(n, float(k) / 8);
    const float towards = glm::dot(p.reflected() - 2.0f, n);
    CHECK(towards > last - 1e-3f);
    last = towards;
    if (k == 0) CHECK(glm::length(p.reflected() - 2.0f - r) < 0.01f);
  }
  CHECK(glm::length(p.reflected() - 2.0f - n) < 0.01f);
}

TEST_CASE("environment reflection: the roughness chooses the level, and between two it is linear") {
  Pixel p([](int level, const glm::vec3&) { return glm::vec3(float(level * level)); });
  for (int level = 0; level <= 8; ++level) {
    p.set({0, 0, 1}, float(level) / 8);
    CHECK(p.reflected().x == float(level * level));
    if (level == 8) break;
    p.set({0, 0, 1}, (float(level) + 0.25f) / 8);
    CHECK(p.reflected().x == Approx(level * level + 0.25 * (2 * level + 1)));
  }
}

TEST_CASE("environment reflection: things of a group with a light of its own reflect that instead") {
  Pixel p(asLight);
  const std::vector<glm::vec3> groups = {{4, 5, 6}};
  p.in.instances = groups;
  p.g.instance.at(0, 0) = 0;
  CHECK(p.reflected() == glm::vec3(4, 5, 6));
  p.g.instance.at(0, 0) = 1;
  CHECK(p.reflected().z == Approx(3).margin(0.01));
}

TEST_CASE("environment reflection: where nothing occludes all is reflected, of rough things O is, and it grows with O") {
  Pixel p([](int, const glm::vec3&) { return glm::vec3(1); });
  for (float nv : {0.f, 0.1f, 0.5f, 1.f}) {
    for (float roughness : {0.f, 0.2f, 0.5f, 1.f}) {
      CHECK(p.occlusion(1, nv, roughness) == 1);
      float last = 0;
      for (int k = 0; k <= 20; ++k) {
        const float found = p.occlusion(float(k) / 20, nv, roughness);
        CHECK(found >= last);
        last = found;
      }
    }
    for (int k = 0; k <= 8; ++k) CHECK(p.occlusion(float(k) / 8, nv, 1) == float(k) / 8);
  }
}

TEST_CASE("environment reflection: the occlusion differs by less than 0.05 from that of Lagarde and de Rousiers") {
  Pixel p([](int, const glm::vec3&) { return glm::vec3(1); });
  double worst = 0;
  for (int i = 0; i <= 20; ++i)
    for (int j = 1; j <= 20; ++j)
      for (int k = 0; k <= 20; ++k) {
        const double o = i / 20.0, nv = j / 20.0, q = k / 20.0;
        const double expected = std::min(1.0, std::max(0.0, std::pow(nv + o, std::exp2(-16 * q - 1)) - 1 + o));
        worst = std::max(worst, std::fabs(double(p.occlusion(float(o), float(nv), float(q))) - expected));
      }
  CHECK(worst < 0.05);
  CHECK(p.occlusion(0.3f, 0.5f, 0) == Approx(std::sqrt(0.8) - 0.7));  // theirs
}
