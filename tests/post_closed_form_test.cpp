// The ambient transfer against what mathematics says it must be.
#include <catch2/catch.hpp>

#include <cmath>

#include "post_frame.h"

using namespace obscura;
using namespace obscura::tests;
using post::AmbientSettings;
using post::Membership;

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Measured {
  double o, w;
};

struct ClosedScene {
  TestScene scene;
  PostFrame frame;

  explicit ClosedScene(glm::vec3 albedo, int width = 120, int height = 90) {
    scene.materials.resize(1);
    scene.materials[0].baseColor = glm::vec4(albedo, 1);
    scene.materials[0].doubleSided = true;
    scene.width = width;
    scene.height = height;
  }
  void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    TestMesh& m = scene.addMesh();
    TestScene::addQuad(m, a, b, c, d);
    scene.place(m);
  }
  void look(glm::dvec3 eye, glm::dvec3 target, double fov = 0.8) {
    scene.camera = raster::perspective(fov, double(scene.width) / scene.height, 0.01);
    scene.camera.viewFromWorld = raster::lookAt(eye, target, {0, 1, 0});
  }
  void run(const AmbientSettings& s) {
    frame.g = gbufferOf(scene);
    runPost(frame, scene.camera, s, raster::Target::Auto);
  }
  // O and W (channel 0) in the pixel that sees the world point.
  Measured at(glm::dvec3 p) const {
    const glm::dvec4 v = scene.camera.viewFromWorld * glm::dvec4(p, 1);
    const post::Projector& q = frame.in.projector;
    const int x = int(v.x / -v.z * q.xScale + q.xCenter), y = int(v.y / -v.z * q.yScale + q.yCenter);
    return {frame.transfer.obscurance.at(x, y), frame.transfer.w[0].at(x, y)};
  }
};

AmbientSettings manySamples(Membership membership = Membership::Linear, float radius = 0.5f) {
  AmbientSettings s;
  s.samples = 64;
  s.membership = membership;
  s.radius = radius;
  s.bias = radius / 200;
  s.filterThreshold = radius / 2;
  return s;
}

// Obscurance of a floor point at distance h from an infinite wall at a right angle, by the midpoint rule.
double cornerObscurance(Membership membership, double h) {
  double sum = 0;
  const int n = 250;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double xi = (i + 0.5) / n, phi = 2 * kPi * (j + 0.5) / n;  // cosine-distributed: sin^2 theta = xi
      const double towardsWall = std::sqrt(xi) * std::cos(phi);
      sum += towardsWall > 0 ? post::membershipOf(membership, h / towardsWall) : 1;
    }
  return sum / (double(n) * n);
}

template <class Visit>
void forEach(const raster::GBuffer& g, const Visit& visit) {
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if (g.triangle.at(x, y) != raster::kNoTriangle) visit(x, y);
}

}  // namespace

TEST_CASE("open plane: O and W are exactly 1 where it faces the camera") {
  for (int m = 0; m < 4; ++m) {
    ClosedScene c({0.5f, 0.5f, 0.5f});
    c.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
    c.look({0, 0, 4}, {0, 0, 0});
    c.run(manySamples(Membership(m)));
    int seen = 0;
    forEach(c.frame.g, [&](int x, int y) {
      ++seen;
      REQUIRE(c.frame.transfer.obscurance.at(x, y) == 1);
      REQUIRE(c.frame.transfer.w[1].at(x, y) == 1);
    });
    CHECK(seen == c.scene.width * c.scene.height);
  }
}

TEST_CASE("open plane: by every estimator and filter guide O and W are exactly 1 where it faces the camera") {
  for (int e = 0; e < 4; ++e)
    for (const int samples : {1, 3, 8}) {
      ClosedScene c({0.5f, 0.5f, 0.5f}, 60, 45);
      c.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
      c.look({0, 0, 4}, {0, 0, 0});
      AmbientSettings s = manySamples();
      s.estimator = post::Estimator(e);
      s.samples = samples;
      s.filterGuide = e % 2 ? post::FilterGuide::Plane : post::FilterGuide::Depth;
      c.run(s);
      INFO("estimator " << e << " n " << samples);
      forEach(c.frame.g, [&](int x, int y) {
        REQUIRE(c.frame.transfer.obscurance.at(x, y) == 1);
        REQUIRE(c.frame.transfer.w[1].at(x, y) == 1);
      });
    }
}

TEST_CASE("open plane: tilted by 30 to 75 degrees O stays within 0.02 of 1, at a bias of two pixels of depth") {
  // The depth map is a staircase: a point just above the plane may project to a texel whose depth lies before it by up
  // to the plane's slope times a pixel. The bias is what takes care of that.
  for (double tilt : {30.0, 50.0, 65.0, 75.0}) {
    ClosedScene c({0.5f, 0.5f, 0.5f});
    const float slope = float(std::tan(tilt * kPi / 180));
    c.quad({-9, -9, 9 * slope}, {9, -9, 9 * slope}, {9, 9, -9 * slope}, {-9, 9, -9 * slope});
    c.look({0, 0, 4}, {0, 0, 0}, 0.3);
    AmbientSettings s = manySamples();
    const double pixel = 4 * 2 * std::tan(0.15) / c.scene.height;
    s.bias = float(2 * pixel * slope);
    c.run(s);
    double least = 1;
    for (int y = 30; y < 60; ++y)
      for (int x = 30; x < 90; ++x) least = std::min(least, double(c.frame.transfer.obscurance.at(x, y)));
    INFO("tilt " << tilt);
    CHECK(least >= 0.98);
  }
}

TEST_CASE("corner: O of a point at distance h from a wall matches quadrature within 0.015 at n = 64") {
  for (Membership membership : {Membership::Classic, Membership::Linear, Membership::Sqrt, Membership::Exponential}) {
    ClosedScene c({0.5f, 0.5f, 0.5f}, 240, 180);
    c.quad({0, 0, -4}, {0, 0, 4}, {4, 0, 4}, {4, 0, -4});  // floor
    c.quad({0, 0, -4}, {0, 4, -4}, {0, 4, 4}, {0, 0, 4});  // wall
    c.look({2.2, 1.6, 0}, {0.2, 0, 0}, 0.5);
    const double radius = 0.5;
    c.run(manySamples(membership, float(radius)));
    for (double h : {0.1, 0.2, 0.3, 0.45, 0.6}) {
      // The mean over a stretch along the wall: the closed form holds on all of it.
      double o = 0;
      const int points = 21;
      for (int i = 0; i < points; ++i) o += c.at({h, 0, (i - points / 2) * 0.01}).o / points;
      INFO("membership " << int(membership) << " h " << h << " measured " << o << " expected " << cornerObscurance(membership, h / radius));
      CHECK(std::fabs(o - cornerObscurance(membership, h / radius)) < 0.015);
    }
  }
}

TEST_CASE("corner: dealt samples, lines and marched rays estimate the same O, within 0.015 at n = 16") {
  for (auto estimator : {post::Estimator::Sobol, post::Estimator::Box, post::Estimator::Lines, post::Estimator::March}) {
    ClosedScene c({0.5f, 0.5f, 0.5f}, 240, 180);
    c.quad({0, 0, -4}, {0, 0, 4}, {4, 0, 4}, {4, 0, -4});
    c.quad({0, 0, -4}, {0, 4, -4}, {0, 4, 4}, {0, 0, 4});
    c.look({2.2, 1.6, 0}, {0.2, 0, 0}, 0.5);
    AmbientSettings s = manySamples();
    s.estimator = estimator;
    s.samples = 16;
    s.steps = estimator == post::Estimator::March ? 4 : 1;
    s.filterGuide = post::FilterGuide::Plane;
    c.run(s);
    for (double h : {0.1, 0.2, 0.3, 0.45, 0.6}) {
      double o = 0;
      for (int i = -10; i <= 10; ++i) o += c.at({h, 0, i * 0.01}).o / 21;
      INFO("estimator " << int(estimator) << " h " << h << " measured " << o << " expected " << cornerObscurance(s.membership, h / 0.5));
      CHECK(std::fabs(o - cornerObscurance(s.membership, h / 0.5)) < 0.015);
    }
  }
}

TEST_CASE("white room: W is 1 in every pixel, although O is not") {
  for (auto [albedo, estimator] : {std::pair(post::TransferAlbedo::Own, post::Estimator::Paper),
                                   std::pair(post::TransferAlbedo::Neighbour, post::Estimator::Paper),
                                   std::pair(post::TransferAlbedo::Neighbour, post::Estimator::Lines),
                                   std::pair(post::TransferAlbedo::Neighbour, post::Estimator::March)}) {
    ClosedScene c({1, 1, 1});
    const glm::vec3 lo(-1, -1, -1), hi(1, 1, 1);
    c.quad({lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z});
    c.quad({lo.x, lo.y, lo.z}, {lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, lo.y, lo.z});
    c.quad({lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z});
    c.quad({lo.x, lo.y, lo.z}, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z}, {lo.x, lo.y, hi.z});
    c.quad({hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {hi.x, hi.y, lo.z});
    c.look({0, 0, 0.95}, {0, 0, -1}, 1.4);
    AmbientSettings s = manySamples();
    s.albedo = albedo;
    s.estimator = estimator;
    c.run(s);
    double darkest = 1;
    forEach(c.frame.g, [&](int x, int y) {
      darkest = std::min(darkest, double(c.frame.transfer.obscurance.at(x, y)));
      REQUIRE(std::fabs(c.frame.transfer.w[0].at(x, y) - 1) < 1e-6);
    });
    CHECK(darkest < 0.8);
  }
}

TEST_CASE("W is never below O, and equals it where the albedo is 0") {
  for (uint32_t seed = 0; seed < 12; ++seed) {
    TestScene s = soupScene(seed);
    s.meshes[0].view.colors = {};
    for (raster::Material& m : s.materials) {
      m.unlit = false;
      m.baseColorMap.texture = -1;
      m.baseColor = glm::vec4(0, 0.4f, 1, 1);
    }
    for (auto albedo : {post::TransferAlbedo::Own, post::TransferAlbedo::Neighbour}) {
      PostFrame f;
      f.g = gbufferOf(s);
      AmbientSettings settings;
      settings.albedo = albedo;
      settings.radius = 1;
      runPost(f, s.camera, settings, raster::Target::Auto);
      forEach(f.g, [&](int x, int y) {
        const float o = f.transfer.obscurance.at(x, y);
        REQUIRE(f.transfer.w[0].at(x, y) == o);
        REQUIRE(f.transfer.w[1].at(x, y) >= o);
        REQUIRE(f.transfer.w[2].at(x, y) >= f.transfer.w[1].at(x, y));
      });
    }
  }
}

TEST_CASE("false silhouettes: a foreground object farther than R away does not darken the background") {
  ClosedScene c({0.5f, 0.5f, 0.5f});
  c.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  c.quad({-0.3f, -0.3f, 2}, {0.3f, -0.3f, 2}, {0.3f, 0.3f, 2}, {-0.3f, 0.3f, 2});
  c.look({0, 0, 5}, {0, 0, 0});
  c.run(manySamples(Membership::Linear, 1.0f));
  forEach(c.frame.g, [&](int x, int y) {
    if (c.frame.g.instance.at(x, y) == 0) REQUIRE(c.frame.transfer.obscurance.at(x, y) == 1);
  });
  // Without the bound it does, as does all that is before the background.
  AmbientSettings unbounded = manySamples(Membership::Linear, 1.0f);
  unbounded.silhouetteBound = false;
  c.run(unbounded);
  double darkest = 1;
  forEach(c.frame.g, [&](int x, int y) {
    if (c.frame.g.instance.at(x, y) == 0) darkest = std::min(darkest, double(c.frame.transfer.obscurance.at(x, y)));
  });
  CHECK(darkest < 0.9);
  // With R beyond the gap the object counts as an occluder, as the paper's figure shows.
  c.run(manySamples(Membership::Linear, 2.5f));
  double least = 1;
  forEach(c.frame.g, [&](int x, int y) { least = std::min(least, double(c.frame.transfer.obscurance.at(x, y))); });
  CHECK(least < 0.99);
}

TEST_CASE("light: albedo x W x La + emission, and the background where nothing is seen") {
  TestScene s = soupScene(10);
  PostFrame f;
  f.g = gbufferOf(s);
  runPost(f, s.camera, AmbientSettings{}, raster::Target::Auto);
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const bool seen = f.g.triangle.at(x, y) != raster::kNoTriangle;
      const float lit = f.g.albedo[2].at(x, y) * f.transfer.w[2].at(x, y) * 1.3f + f.g.emissive[2].at(x, y);
      REQUIRE(f.color.rgb[2].at(x, y) == (seen ? lit : 0.3f));
    }
}

TEST_CASE("memberships: the inverse undoes mu, from 0 at the surface to 1 at R") {
  for (int m = 1; m < 4; ++m)
    for (int i = 0; i < 100; ++i) {
      const double xi = i / 100.0, r = post::inverseMembership(Membership(m), xi);
      CHECK(std::fabs(post::membershipOf(Membership(m), r) - xi) < 1e-12);
    }
  for (int m = 0; m < 4; ++m) CHECK(post::membershipOf(Membership(m), 1) == 1);
  CHECK(post::inverseMembership(Membership::Classic, 0.3) == 1);
}
