// The traced truth against what mathematics says it must be.
#include <cmath>

#include "obscura/apps/sobol.h"
#include "obscura/post/transfer_samples.h"
#include "traced_scene.h"

using namespace obscura;
using namespace obscura::tests;
using apps::TruthQuantity;
using post::Membership;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr TruthQuantity kObscurances[] = {TruthQuantity::Classic, TruthQuantity::Linear, TruthQuantity::Sqrt, TruthQuantity::Exponential};

// O at the distance h (in units of R) from an infinite wall at a right angle: over the strips u of the unit disc on which
// cosine-distributed directions project evenly, u towards the wall, by the midpoint rule.
double cornerObscurance(Membership m, double h) {
  double blocked = 0;
  const int n = 4000;
  for (int i = 0; i < n && h < 1; ++i) {
    const double u = h + (1 - h) * (i + 0.5) / n;
    blocked += (1 - post::membershipOf(m, h / u)) * 2 * std::sqrt(1 - u * u) / kPi * (1 - h) / n;
  }
  return 1 - blocked;
}

// The mean of min(d / R, 1)^power over the half sphere there, evenly, by the midpoint rule.
double cornerEvenly(double h, int power) {
  double sum = 0;
  const int n = 200;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double up = (i + 0.5) / n, towards = std::sqrt(1 - up * up) * std::cos(2 * kPi * (j + 0.5) / n);
      sum += towards > 0 ? std::pow(std::min(h / towards, 1.0), power) : 1;
    }
  return sum / (n * n);
}

// The sphere of radius 1/2 less the cap behind the wall.
double cornerSphere(double h) {
  const double cap = std::max(0.0, 0.5 - h);
  return 1 - cap * cap * (1.5 - cap) / 3 * 6;
}

}  // namespace

TEST_CASE("truth: 2^k points of a scramble have one in each box of every shape") {
  for (uint32_t seed = 0; seed < 20; ++seed)
    for (int shape = 0; shape <= 6; ++shape) {
      std::vector<int> boxes(64);
      for (uint32_t i = 64; i < 128; ++i) {
        const glm::dvec2 p = apps::sobolPoint(i, seed);
        REQUIRE((p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1));
        ++boxes[size_t(int(p.x * (1 << shape)) + (int(p.y * (64 >> shape)) << shape))];
      }
      for (const int count : boxes) REQUIRE(count == 1);
    }
}

TEST_CASE("truth: a corner of two planes has the closed forms' O, tangent sphere and half spheres, and errs as it says") {
  TracedScene t(40, 30, 128);
  engine::Mesh& m = t.addMesh();
  TracedScene::addQuad(m, {0, 0, -4}, {0, 0, 4}, {4, 0, 4}, {4, 0, -4});  // floor
  TracedScene::addQuad(m, {0, 0, -4}, {0, 4, -4}, {0, 4, 4}, {0, 0, 4});  // wall
  t.look({2.2, 1.6, 0}, {0.3, 0.1, 0}, 0.4);
  t.trace();
  const auto distance = [&](int x, int y) {
    const glm::dvec3 p = t.world(x, y);
    return (p.x > p.y ? p.x : p.y) / t.truthSettings.radius;
  };
  for (int k = 0; k < 4; ++k)
    checkAgainst(t, kObscurances[k], 1e-3, [&](int x, int y) { return cornerObscurance(Membership(k), distance(x, y)); });
  checkAgainst(t, TruthQuantity::TangentSphere, 1e-3, [&](int x, int y) { return cornerSphere(distance(x, y)); });
  checkAgainst(t, TruthQuantity::Ball, 1e-3, [&](int x, int y) { return cornerEvenly(distance(x, y), 3); });
  checkAgainst(t, TruthQuantity::Horizon, 1e-3, [&](int x, int y) { return cornerEvenly(distance(x, y), 2); });
}

TEST_CASE("truth: from the very edge of a corner no ray slips through the other side") {
  TracedScene t(24, 24, 64);
  engine::Mesh& m = t.addMesh();
  TracedScene::addQuad(m, {0, 0, 4}, {4, 0, 4}, {4, 0, -4}, {0, 0, -4});
  TracedScene::addQuad(m, {0, 0, 4}, {0, 0, -4}, {0, 4, -4}, {0, 4, 4});
  t.look({1, 1, 7}, {1, 1, 0}, 0.4);  // the edge is a diagonal of the image, through the centres of pixels
  t.trace();
  int onEdge = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      if (!t.seen(x, y) || std::max(t.world(x, y).x, t.world(x, y).y) > 1e-4) continue;
      ++onEdge;
      CHECK(t.truth[TruthQuantity::Classic].at(x, y) == Approx(0.5).margin(0.12));
    }
  CHECK(onEdge >= 4);
}

TEST_CASE("truth: a ball on a plane casts the O that quadrature finds") {
  TracedScene t(40, 30, 128);
  addBall(t.addMesh(), {0, 0.3, 0}, 0.3, 64);
  TracedScene::addQuad(t.addMesh(), {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
  t.look({0, 1.2, 1.5}, {0, 0.1, 0}, 0.7);
  t.trace();
  // Of a floor point at the distance s from where the ball stands; half of the disc of directions is enough.
  const auto expected = [&](int x, int y) {
    const glm::dvec3 p = t.world(x, y);
    if (t.frame.g.instance.at(x, y) != 1) return -1.0;
    const double r = 0.3, s = std::hypot(p.x, p.z), reach = t.truthSettings.radius;
    double open = 0;
    const int n = 60;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double square = (i + 0.5) / n, phi = kPi * (j + 0.5) / n;
        const double along = std::sqrt(square) * std::cos(phi) * s + std::sqrt(1 - square) * r;  // w . (center - p)
        const double root = along * along - s * s;  // |center - p|^2 - r^2 = s^2
        const double d = along > 0 && root > 0 ? (along - std::sqrt(root)) / reach : 1;
        open += post::membershipOf(Membership::Linear, d) / (n * n);
      }
    return open;
  };
  checkAgainst(t, TruthQuantity::Linear, 2e-3, expected);
}

TEST_CASE("truth: in a closed ball of one albedo the exact W is O / (1 - a (1 - O))") {
  TracedScene t(20, 15, 128);
  t.paint({0.9f, 0.5f, 0});
  t.truthSettings.radius = 3;
  addBall(t.addMesh(), {0, 0, 0}, 1, 48);
  t.look({0, 0, 0.9}, {0, 0.2, -1}, 1.5);
  t.trace();
  // d = 2 cos over the diameter's end: the mean of 2 cos / R by the cosine density.
  const double o = 2.0 / 3 * 2 / 3;
  checkAgainst(t, TruthQuantity::Linear, 2e-3, [&](int, int) { return o; });
  const double albedo[] = {0.9, 0.5, 0};
  for (int c = 0; c < 3; ++c)
    checkAgainst(t, TruthQuantity(int(TruthQuantity::TransferR) + c), 2e-3, [&](int, int) { return o / (1 - albedo[c] * (1 - o)); });
}

TEST_CASE("truth: the closed white room has W = 1 for every membership, and no ray leaves it") {
  for (int membership = 0; membership < 4; ++membership) {
    TracedScene t(16, 12, 32);
    t.paint({1, 1, 1});
    t.truthSettings.radius = 8;
    t.truthSettings.membership = Membership(membership);
    engine::Mesh& room = t.addMesh();
    addBox(room, {1000, -1, 2000}, {1002, 1, 2002});  // far away, where floats are coarse
    t.look({1001, 0, 2001.9}, {1001, -0.2, 2000}, 1.6);
    t.trace();
    double w = 0, darkest = 1;
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 16; ++x) {
        REQUIRE(t.truth[TruthQuantity::Classic].at(x, y) == 0);  // every ray has hit
        w += t.truth[TruthQuantity::TransferG].at(x, y) / (16.0 * 12);
        darkest = std::min(darkest, double(t.truth[TruthQuantity::TransferG].at(x, y)));
      }
    INFO("membership " << membership << " mean " << w << " least " << darkest);
    CHECK(w == Approx(1).margin(membership == 0 ? 1e-6 : 2e-3));
    CHECK(darkest > 0.95);
  }
}

TEST_CASE("truth: rays do not meet the surface that they start from") {
  for (const double scale : {0.001, 1.0, 3000.0})
    for (const bool huge : {false, true}) {
      TracedScene t(24, 18, 32);
      glm::dmat4 at = glm::dmat4(glm::dmat3(scale));
      at[3] = glm::dvec4(scale * 7, -scale * 3, scale * 11, 1);
      engine::Mesh& m = t.addMesh(at);
      const int n = huge ? 1 : 40;
      const float size = huge ? 500.f : 3.f;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const auto corner = [&](int u, int v) {
            const float x = (float(2 * u) / float(n) - 1) * size, y = (float(2 * v) / float(n) - 1) * size;
            return glm::vec3(x, y, 0.4f * x - 0.7f * y);
          };
          TracedScene::addQuad(m, corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
      t.truthSettings.radius = float(scale);
      t.look(glm::dvec3(at[3]) + scale * glm::dvec3(0, 0.5, 3), glm::dvec3(at[3]), 0.6);
      t.trace();
      for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 24; ++x) REQUIRE(t.truth[TruthQuantity::Classic].at(x, y) == 1);
    }
}

TEST_CASE("truth: what a mirrored instance shows is what its mirror image is, and single-sided triangles block from behind") {
  const auto traced = [](bool mirrored, bool doubleSided, TracedScene& t) {
    t.scene.materials.resize(2);
    t.scene.materials[1].baseColor = {0.9f, 0.2f, 0.1f, 1};
    t.scene.materials[1].doubleSided = doubleSided;
    TracedScene::addQuad(t.addMesh(), {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
    glm::dmat4 at(1);
    if (mirrored) at[0][0] = -1;
    engine::Mesh& box = t.addMesh(at);
    addBox(box, {-0.3f, 0, -0.3f}, {0.3f, 0.6f, 0.3f});
    box.material = 1;
    // A card whose face looks away from the floor in front of it.
    engine::Mesh& card = t.addMesh(at);
    TracedScene::addQuad(card, {-0.6f, 0.01f, 0.6f}, {-0.6f, 0.4f, 0.6f}, {0.6f, 0.4f, 0.6f}, {0.6f, 0.01f, 0.6f});
    t.look({0, 1, 2.4}, {0, 0.2, 0}, 0.7);
    t.trace();
  };
  TracedScene plain(32, 24, 64), mirror(32, 24, 64), open(32, 24, 64);
  traced(false, true, plain);
  traced(true, true, mirror);
  traced(false, false, open);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      for (int q = 0; q < apps::kTruthQuantities; ++q) {
        REQUIRE(mirror.truth.value[q].at(x, y) == Approx(plain.truth.value[q].at(x, y)).margin(0.02));
        REQUIRE(open.truth.value[q].at(x, y) == Approx(plain.truth.value[q].at(x, y)).margin(0.02));
      }
}

TEST_CASE("truth: light that is reflected has the colour of texture, vertices and factor, holes of a mask let rays through") {
  const auto texels = std::make_shared<std::vector<uint32_t>>(16);
  const auto traced = [&](uint32_t texel, raster::AlphaMode mode, TracedScene& t) {
    std::fill(texels->begin(), texels->end(), texel);
    engine::Texture texture;
    texture.texels = texels;
    texture.view.texels = *texels;
    texture.view.width = texture.view.height = 4;
    t.scene.textures.push_back(texture);
    t.scene.materials.resize(2);
    t.scene.materials[0].baseColor = {0, 0, 0, 1};  // the floor reflects nothing: W = O + (1 - mu) a of the wall
    raster::Material& wall = t.scene.materials[1];
    wall.baseColor = {1, 0.5f, 1, 1};
    wall.baseColorMap.texture = 0;
    wall.alphaMode = mode;
    wall.doubleSided = true;
    TracedScene::addQuad(t.addMesh(), {0, 0, -4}, {0, 0, 4}, {4, 0, 4}, {4, 0, -4});
    engine::Mesh& m = t.addMesh();
    TracedScene::addQuad(m, {0, 0, -4}, {0, 4, -4}, {0, 4, 4}, {0, 0, 4});
    m.material = 1;
    m.uvs[0].assign(4, {0.3f, 0.6f});
    m.colors.assign(4, {0.5f, 0.5f, 0.25f, 1});
    t.look({1, 1.5, 0}, {0.2, 0, 0}, 0.1);  // a bit of floor near the wall
    t.trace();
  };
  TracedScene solid(4, 3, 512), hole(4, 3, 64);
  traced(0xFF00FFFFu, raster::AlphaMode::Mask, solid);  // alpha 1; red and green 1, blue 0
  const double o = solid.truth[TruthQuantity::Linear].at(2, 1);
  CHECK((o < 0.95 && o > 0.5));
  // Light from the wall comes after one reflection there, of albedo (0.5, 0.25, 0); the wall sees the black floor.
  const double red = solid.truth[TruthQuantity::TransferR].at(2, 1) - o, green = solid.truth[TruthQuantity::TransferG].at(2, 1) - o;
  CHECK(solid.truth[TruthQuantity::TransferB].at(2, 1) == Approx(o).margin(1e-6));
  CHECK(red > 0.01);
  CHECK(green == Approx(red / 2).epsilon(0.02));
  traced(0x00FFFFFFu, raster::AlphaMode::Mask, hole);
  for (const TruthQuantity q : kObscurances) CHECK(hole.truth[q].at(2, 1) == 1);
  CHECK(hole.truth[TruthQuantity::TransferR].at(2, 1) == 1);
}
