// How surfaces reflect: tables, energy, and that kernels and twins agree.
#include <catch2/catch.hpp>

#include <cmath>

#include "brdf_kernel.h"
#include "obscura/post/make_brdf_table.h"
#include "obscura/raster/target.h"
#include "raster_oracle.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::post;
using namespace obscura::tests;

namespace {

constexpr double kPi = 3.141592653589793;
constexpr Brdf kGlossy[] = {Brdf::Gltf, Brdf::BlinnPhong, Brdf::BlinnPhongThresholded};
constexpr float kFacings[] = {0.004f, 0.03f, 0.1f, 0.33f, 0.68f, 0.97f};

// By roughness, of Gltf, BlinnPhong and BlinnPhongThresholded: the tables of docs/lighting.md.
struct ErrorRow {
  float roughness;
  double error[3];
};
constexpr ErrorRow kTableErrors[] = {
    {0, {0.002, 0.0015, 0.001}}, {0.1f, {0.003, 0.0015, 0.001}}, {0.3f, {0.0006, 0.0015, 0.001}},
    {0.5f, {0.0005, 0.0015, 0.0015}}, {0.7f, {0.0002, 0.0006, 0.0015}}, {0.85f, {0.0001, 0.001, 0.005}},
    {1, {0.0001, 0.0002, 0.0005}},
};
constexpr ErrorRow kFurnaceErrors[] = {
    {0, {0.003, 0.002, 0.003}}, {0.1f, {0.003, 0.002, 0.0015}}, {0.3f, {0.0015, 0.002, 0.0005}},
    {0.5f, {0.001, 0.002, 0.001}}, {0.7f, {0.0003, 0.0007, 0.002}}, {0.85f, {0.001, 0.001, 0.006}},
    {1, {0.0005, 0.0003, 0.0005}},
};

glm::vec3 ambient(Brdf brdf, const ref::Surface& s) {
  const ref::Reflectance r = ref::ambientReflectance(brdf, s);
  return r.diffuse + r.specular;
}

// Turned to the eye by nv.
ref::Surface facing(float nv) {
  ref::Surface s;
  s.v = {std::sqrt(1 - nv * nv), 0, nv};
  return s;
}

// The integral of f(l, v) cos over the hemisphere of a surface that scatters nothing below itself. By half vectors, which
// highlights are narrow around: tan n.h = width tan(pi / 2 t) for evenly spread t, and evenly round the normal.
glm::dvec3 integrated(Brdf brdf, const ref::Surface& s) {
  const int rings = kFastBuild ? 1500 : 300, steps = kFastBuild ? 240 : 80;
  const double nv = s.v.z, sv = s.v.x, width = std::max(double(s.roughness) * s.roughness, 1 / 256.0);
  glm::dvec3 sum(0);
  for (int ring = 0; ring < rings; ++ring) {
    const double t = kPi / 2 * (ring + 0.5) / rings, tangent = width * std::tan(t), theta = std::atan(tangent);
    const double dTheta = width * kPi / 2 / rings / (std::cos(t) * std::cos(t)) / (1 + tangent * tangent);
    for (int step = 0; step < steps; ++step) {
      const double azimuth = kPi * (step + 0.5) / steps;  // the other half is alike
      const glm::dvec3 h(std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta));
      const double vh = h.x * sv + h.z * nv, nl = 2 * vh * h.z - nv;
      if (!(nl > 0 && vh > 0)) continue;
      const glm::dvec3 f(ref::reflection(brdf, s, glm::vec3(h * (2 * vh) - glm::dvec3(sv, 0, nv)), float(nl)));
      sum += f * (nl * 4 * vh * std::sin(theta) * dTheta * 2 * kPi / steps);
    }
  }
  return sum;
}

// Surfaces of all kinds, and lights.
std::vector<Lit> manyLit() {
  Random random(7);
  std::vector<Lit> all;
  const float ends[] = {0, 1, 0.5f, kLeastFacing};
  for (int i = 0; i < 3000; ++i) {
    const auto unit = [&] { return random.integer(0, 5) ? random.real(0, 1) : ends[random.integer(0, 3)]; };
    Lit l;
    for (int c = 0; c < 3; ++c) l.surface.base[c] = unit();
    l.surface.metallic = unit(), l.surface.roughness = unit();
    if (i % 20 == 0) l.surface.metallic = -0.0f;  // unlit
    const auto direction = [&] {
      const glm::vec3 v = random.vector(-1, 1);
      return v * (1 / std::sqrt(std::max(v.x * v.x + v.y * v.y + v.z * v.z, 1e-6f)));
    };
    l.surface.n = random.integer(0, 9) ? direction() : glm::vec3(0);
    l.surface.v = random.integer(0, 9) ? direction() : l.surface.n;
    l.l = i % 9 ? direction() : i % 2 ? l.surface.v : -l.surface.v;
    l.nl = i % 7 ? std::fabs(l.surface.n.x * l.l.x + l.surface.n.y * l.l.y + l.surface.n.z * l.l.z) : 0;
    all.push_back(l);
  }
  return all;
}

}  // namespace

TEST_CASE("brdf: the tables are what the generator makes") {
  for (const Brdf brdf : kGlossy)
    for (int k = 0; k < kBrdfTable * kBrdfTable; k += kFastBuild ? 17 : 151) {
      INFO("table " << int(brdf) << ", element " << k);
      REQUIRE(brdfTable(brdf)[k] == makeBrdfElement(brdf, k % kBrdfTable, k / kBrdfTable));
      REQUIRE((brdfTable(brdf)[k] & 0xFFFF) <= 32768);
      REQUIRE(brdfTable(brdf)[k] >> 16 < 32768);
    }
}

TEST_CASE("brdf: kernels equal their scalar twin in every bit") {
  const std::vector<Lit> lit = manyLit();
  for (const Brdf brdf : {Brdf::Lambert, Brdf::Gltf, Brdf::BlinnPhong, Brdf::BlinnPhongThresholded})
    for (const raster::Target target : raster::supportedTargets()) {
      const std::vector<Reflected> found = reflectAll(brdf, lit, target);
      for (size_t i = 0; i < lit.size(); ++i) {
        INFO("brdf " << int(brdf) << " " << raster::targetName(target) << ", surface " << i);
        const ref::Reflectance r = ref::ambientReflectance(brdf, lit[i].surface);
        const glm::vec3 f = ref::reflection(brdf, lit[i].surface, lit[i].l, lit[i].nl);
        for (int c = 0; c < 3; ++c) {
          REQUIRE(found[i].diffuse[c] == r.diffuse[c]);
          REQUIRE(found[i].specular[c] == r.specular[c]);
          REQUIRE(found[i].towards[c] == f[c]);
          REQUIRE((std::isfinite(f[c]) && f[c] >= 0));
        }
      }
    }
}

TEST_CASE("brdf: the direction to the eye is unit, and that of the pixel's centre") {
  raster::Camera c = raster::perspective(0.9, 1.3, 0.1);
  c.xShift = 0.4f;
  for (int kind = 0; kind < 2; ++kind) {
    const Projector p = makeProjector(kind ? raster::orthographic(2, 2, 0.1, 9) : c, 53, 41, raster::Window{-3, 5, 53, 41});
    for (int y : {0, 17, 40})
      for (const raster::Target target : raster::supportedTargets()) {
        const std::vector<glm::vec3> found = viewDirections(p, y, target);
        for (int x = 0; x < 53; ++x) {
          const glm::vec3 v = found[size_t(x)], expected = ref::viewDirection(p, x, y);
          REQUIRE((v.x == expected.x && v.y == expected.y && v.z == expected.z));
          REQUIRE(std::fabs(v.x * v.x + v.y * v.y + v.z * v.z - 1) < 4e-7f);
          if (kind) continue;
          CHECK(-v.x / v.z * p.xScale + p.xCenter == Approx(x - 3 + 0.5).epsilon(1e-5));
          CHECK(-v.y / v.z * p.yScale + p.yCenter == Approx(y + 5 + 0.5).epsilon(1e-5));
        }
      }
  }
}

TEST_CASE("brdf: white furnace: white reflects all of the ambient light, and nothing reflects more") {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    ref::Surface s = facing(random.real(0, 1));
    s.metallic = random.real(0, 1), s.roughness = random.real(0, 1);
    if (i % 3 == 0) s.metallic = float(i % 2);
    s.base = glm::vec3(1);
    REQUIRE(ambient(Brdf::Lambert, s) == glm::vec3(1));
    REQUIRE(ambient(Brdf::Gltf, s) == glm::vec3(1));
    const glm::vec3 base = random.vector(0, 1);
    for (const Brdf brdf : kGlossy) {
      s.base = glm::vec3(1);
      const float white = ambient(brdf, s).x;
      if (s.metallic == 0) REQUIRE(white == Approx(1).margin(1.2e-7));
      REQUIRE(white <= 1);
      s.base = base;
      const glm::vec3 r = ambient(brdf, s);
      for (int c = 0; c < 3; ++c) REQUIRE((r[c] >= 0 && r[c] <= 1));
    }
  }
}

TEST_CASE("brdf: the tables err by little against direct integration") {
  for (const ErrorRow& row : kTableErrors)
    for (const Brdf brdf : kGlossy) {
      double worst = 0;
      for (float nv : kFacings) {
        const LobeIntegrals exact = integrateLobe(brdf, nv, row.roughness);
        ref::Surface s = facing(nv);
        s.roughness = row.roughness;
        for (float f0 : {0.04f, 0.3f, 0.9f}) {
          s.base = glm::vec3(f0), s.metallic = 1;
          double expected = (exact.share + f0 * (1 - exact.share)) * exact.e;
          if (brdf == Brdf::Gltf) expected *= 1 + f0 * (1 - exact.e) / exact.e;
          worst = std::max(worst, std::fabs(double(ref::ambientReflectance(brdf, s).specular.x) - expected));
        }
      }
      INFO("table " << int(brdf) << ", roughness " << row.roughness);
      CHECK(worst <= row.error[int(brdf) - 1]);
    }
}

TEST_CASE("brdf: f(l, v) cos over the hemisphere adds up to the ambient reflectance, and never to more than 1") {
  for (const ErrorRow& row : kFurnaceErrors)
    for (const Brdf brdf : kGlossy) {
      double worst = 0, most = 0;
      for (float nv : kFacings) {
        ref::Surface s = facing(nv);
        s.roughness = row.roughness;
        for (const float metallic : {0.0f, 1.0f}) {
          // Metals scatter nothing below themselves, other things nothing where they are black.
          s.metallic = metallic;
          s.base = metallic > 0 ? glm::vec3(1, 0.5f, 0.1f) : glm::vec3(0);
          const glm::dvec3 sum = integrated(brdf, s);
          const glm::vec3 expected = ambient(brdf, s);
          for (int c = 0; c < 3; ++c) {
            worst = std::max(worst, std::fabs(sum[c] - double(expected[c])));
            most = std::max(most, sum[c]);
          }
        }
        // What they do scatter does not depend on l.
        s.metallic = 0, s.base = glm::vec3(0.8f, 0.2f, 1);
        ref::Surface black = s;
        black.base = glm::vec3(0);
        const ref::Reflectance r = ref::ambientReflectance(brdf, s);
        const glm::vec3 scattered = ref::reflection(brdf, s, {-0.8f, 0, 0.6f}, 0.6f) - ref::reflection(brdf, black, {-0.8f, 0, 0.6f}, 0.6f);
        if (brdf == Brdf::Gltf)
          for (int c = 0; c < 3; ++c) CHECK(scattered[c] * kPi == Approx(r.diffuse[c]).margin(2e-4));
      }
      INFO("brdf " << int(brdf) << ", roughness " << row.roughness);
      const double error = row.error[int(brdf) - 1] * (kFastBuild ? 1 : 5);  // with few half vectors
      CHECK(worst <= error);
      CHECK(most <= 1 + error);
    }
}
