// The extended ambient term: what classes of surfaces send each other, against closed forms and the paper's room.
#include <catch2/catch.hpp>

#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/engine/extended_ambient.h"
#include "room_scene.h"

using namespace obscura;
using namespace obscura::tests;
using engine::AmbientClass;
using engine::Scene;

namespace {

std::vector<AmbientClass> classesOf(const Scene& scene, const std::vector<glm::dvec3>& directions = engine::spreadDirections(6), int threads = 1) {
  raster::Parallel parallel(threads);
  return engine::ambientClasses(scene, directions, parallel);
}

double totalArea(const std::vector<AmbientClass>& classes) {
  double sum = 0;
  for (const AmbientClass& c : classes) sum += c.area;
  return sum;
}

}  // namespace

TEST_CASE("extended ambient: the classes of a room have its walls' areas and reflectances, and a slanted triangle is divided") {
  const std::vector<AmbientClass> walls = classesOf(room({1, 0, 0}, {0, 1, 0}, glm::vec3(0.5f)).scene);
  for (const AmbientClass& c : walls) CHECK(c.area == Approx(16));
  CHECK(walls[0].reflected == glm::dvec3(16, 0, 0));
  CHECK(walls[1].reflected == glm::dvec3(0, 16, 0));
  CHECK(walls[4].reflected == glm::dvec3(8));

  Builder slanted;
  TestMesh triangle;
  triangle.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}, {5, 5, 5}, {6, 5, 5}};  // and one without area
  triangle.indices = {0, 1, 2, 3, 4, 5};
  slanted.add(triangle, glm::vec3(0.5f), {3, 0, 0});
  const double area = std::sqrt(3.0) / 2;
  std::vector<AmbientClass> c = classesOf(slanted.scene);
  for (size_t k : {0, 2, 4}) {
    CHECK(c[k].area == Approx(area / 3));
    CHECK(c[k].emitted.x == Approx(area));
  }
  for (size_t k : {1, 3, 5}) CHECK(c[k].area == 0);

  slanted.scene.materials[0].doubleSided = true;
  CHECK(totalArea(classesOf(slanted.scene)) == Approx(2 * area));
  slanted.scene.materials[0].doubleSided = false;
  slanted.scene.instances[0].worldFromObject = glm::dmat4(-2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1);  // mirrored: as seen, it turns its face along
  c = classesOf(slanted.scene);
  CHECK(c[0].area == 0);
  CHECK(c[1].area == Approx(4 * area / 3));
  slanted.scene.materials[0].unlit = true;
  c = classesOf(slanted.scene);
  CHECK(c[1].reflected == glm::dvec3(0));
  CHECK(c[1].emitted == glm::dvec3(c[1].area / 2));
}

TEST_CASE("extended ambient: vertex colours and the means of textures are part of the reflectance") {
  Builder b = room({0.5f, 0.5f, 0.5f}, glm::vec3(1), glm::vec3(1));
  engine::Mesh& wall = b.scene.meshes[0];
  wall.colors.assign(wall.positions.size(), glm::vec4(0.5f, 1, 0, 1));
  CHECK(classesOf(b.scene)[0].reflected == glm::dvec3(4, 8, 0));
  for (bool srgb : {false, true})
    for (int levels : {1, 2}) {
      auto texels = std::make_shared<std::vector<uint32_t>>(std::vector<uint32_t>{0xFF0000FF, 0xFF00FF00, 0xFF7F7F00});
      raster::TextureView view;
      view.texels = *texels, view.width = 2, view.height = 1, view.levels = levels, view.srgb = srgb;
      b.scene.textures = {{"", texels, view}};
      b.scene.materials[1].baseColorMap.texture = 0;
      CHECK(classesOf(b.scene)[1].reflected == glm::dvec3(8, 8, 0));
    }
}

TEST_CASE("extended ambient: light in a closed room of one reflectance is the sum of its reflections") {
  // All walls emit E: B = E + rho B, and In = B = E / (1 - rho).
  for (const double rho : {0.0, 0.3, 0.9}) {
    std::vector<AmbientClass> classes;
    for (const glm::dvec3& d : engine::spreadDirections(6)) classes.push_back({d, 2.0, glm::dvec3(2 * rho), glm::dvec3(2 * 0.7)});
    for (const glm::vec3& in : engine::incomingLight(classes, glm::dvec3(0))) CHECK(in.x == Approx(0.7 / (1 - rho)));
    // The same light from outside: In = light + rho In.
    for (AmbientClass& c : classes) c.emitted = glm::dvec3(0);
    for (const glm::vec3& in : engine::incomingLight(classes, glm::dvec3(0.7))) CHECK(in.y == Approx(0.7 / (1 - rho)));
  }
}

TEST_CASE("extended ambient: any number of classes fulfils the paper's equation 1, as iteration does") {
  Random random(9);
  for (const size_t count : {1, 2, 3, 6, 14, 40}) {
    std::vector<AmbientClass> classes(count);
    for (AmbientClass& c : classes) {
      c.area = random.integer(0, 4) == 0 ? 0 : random.real(0.1f, 5);
      c.reflected = c.area * glm::dvec3(random.vector(0, 1));
      c.emitted = c.area * glm::dvec3(random.vector(0, 3));
    }
    const glm::dvec3 light(0.2, 0, 1);
    const std::vector<glm::vec3> found = engine::incomingLight(classes, light);
    for (int c = 0; c < 3; ++c) {
      std::vector<double> in(count, light[c]), sent(count, 0.0);
      for (int round = 0; round < 6000; ++round) {
        for (size_t k = 0; k < count; ++k) {
          const double area = classes[k].area;
          sent[k] = area > 0 ? classes[k].emitted[c] / area + std::min(classes[k].reflected[c] / area, 0.99) * in[k] : 0;
        }
        for (size_t k = 0; k < count; ++k) {
          in[k] = light[c];
          for (size_t j = 0; j < count; ++j) in[k] += j == k ? 0 : sent[j] / double(count - 1);
        }
      }
      for (size_t k = 0; k < count; ++k) CHECK(found[k][c] == Approx(in[k]).epsilon(1e-5));
    }
  }
}

TEST_CASE("extended ambient: classes without area, white rooms and nothing at all give finite light") {
  CHECK(engine::incomingLight({}, glm::dvec3(1)).empty());
  raster::Parallel parallel;
  const Scene empty;
  const auto nothing = engine::extendedAmbient(empty, glm::dvec3(0.5), parallel);
  REQUIRE(nothing.ok());
  for (const post::AmbientDirection& in : *nothing) CHECK(in.color == glm::vec3(0.5f));

  Builder white = room(glm::vec3(1), glm::vec3(1), glm::vec3(1));
  const auto lit = engine::extendedAmbient(white.scene, glm::dvec3(1), parallel);
  REQUIRE(lit.ok());
  for (const post::AmbientDirection& in : *lit) CHECK((in.color.x > 50 && in.color.x < 101));

  white.scene.materials[2].emissive = glm::vec3(1e38f);
  const auto blinding = engine::extendedAmbient(white.scene, glm::dvec3(1), parallel);
  REQUIRE_FALSE(blinding.ok());
  CHECK(blinding.error().code == engine::ErrorCode::BadInput);
}

TEST_CASE("extended ambient: without a light it is that of the emitters, or as bright as the constant term where nothing emits") {
  raster::Parallel parallel;
  Builder b = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f));
  const auto dark = engine::extendedAmbient(b.scene, std::nullopt, parallel);
  REQUIRE(dark.ok());
  float mean = 0;
  for (const post::AmbientDirection& in : *dark) mean += (in.color.x + in.color.y + in.color.z) / 18;
  CHECK(mean == Approx(1));
  CHECK((*dark)[1].color.x > 1.03f * (*dark)[0].color.x);  // towards the red wall
  b.scene.materials[3].emissive = glm::vec3(2);
  const auto lit = engine::extendedAmbient(b.scene, std::nullopt, parallel), alone = engine::extendedAmbient(b.scene, glm::dvec3(0), parallel);
  REQUIRE((lit.ok() && alone.ok()));
  for (size_t k = 0; k < 6; ++k) CHECK((*lit)[k].color == (*alone)[k].color);
  CHECK((*lit)[2].color.x > 0.1f);
}

TEST_CASE("extended ambient: the number of threads changes no bit") {
  const TestScene soup = soupScene(7);
  Builder b;
  TestMesh many = soup.meshes.front();
  for (int k = 0; k < 3; ++k) many.indices.insert(many.indices.end(), many.indices.begin(), many.indices.end());
  REQUIRE(many.indices.size() / 3 > 10000);
  b.add(many, {0.3f, 0.6f, 0.9f}, {0.1f, 0, 0});
  const std::vector<AmbientClass> expected = classesOf(b.scene);
  for (int threads : {2, 3, 8}) {
    const std::vector<AmbientClass> found = classesOf(b.scene, engine::spreadDirections(6), threads);
    for (size_t k = 0; k < 6; ++k) {
      CHECK(found[k].area == expected[k].area);
      CHECK(found[k].reflected == expected[k].reflected);
      CHECK(found[k].emitted == expected[k].emitted);
    }
  }
}

TEST_CASE("extended ambient: in the paper's room the ball's side towards the red wall turns reddish, the other greenish") {
  Builder b = room({0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, glm::vec3(0.5f));
  b.addQuad({-0.5f, 1.99f, -0.5f}, {0.5f, 1.99f, -0.5f}, {0.5f, 1.99f, 0.5f}, {-0.5f, 1.99f, 0.5f}, glm::vec3(0), glm::vec3(20));
  b.add(ball(0.8), glm::vec3(0.95f));
  raster::Parallel parallel;
  const auto colors = engine::extendedAmbient(b.scene, glm::dvec3(0), parallel);
  REQUIRE(colors.ok());

  engine::FrameSettings s;
  s.width = s.height = 61;
  s.camera = raster::perspective(1.0, 1, 0.01);
  s.camera.viewFromWorld = raster::lookAt({0, 0, 1.9}, {0, 0, 0}, {0, 1, 0});
  s.ambient = post::Occlusion::None;
  s.ambientDirections = *colors;
  const engine::Frame frame = frameOf(b.scene, s);
  const auto at = [&](int x, int y) { return glm::vec3(frame.color.rgb[0].at(x, y), frame.color.rgb[1].at(x, y), frame.color.rgb[2].at(x, y)); };
  const glm::vec3 left = at(12, 30), right = at(48, 30), middle = at(30, 30);
  CHECK(left.r > 1.03f * left.g);   // the red wall is at the left
  CHECK(right.g > 1.03f * right.r);
  CHECK(middle.r == Approx(middle.g).epsilon(0.02));
  CHECK(left.r == Approx(right.g).epsilon(0.02));
  CHECK(middle.b > 0.1f);
  // Smooth over the curved surface: from pixel to pixel little changes.
  for (int x = 13; x < 48; ++x) CHECK(std::abs(at(x, 30).r - at(x - 1, 30).r) < 0.08f * at(x, 30).r);
}

TEST_CASE("extended ambient: the first bounce of direct light is rho E / pi of each triangle, unshot, none of what lies in shadow") {
  Builder b;
  b.addQuad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}, {0.5f, 0.25f, 0});  // faces up
  b.scene.bounds = {glm::dvec3(-3), glm::dvec3(3), false};
  engine::SceneLight sun;
  sun.direction = glm::normalize(glm::dvec3(1, -1, 0));
  sun.color = {2, 4, 8};
  const auto unshot = [&](const engine::SceneLight& light) {
    const engine::BouncedLight direct(b.scene, {&light, 1}, true, {});
    raster::Parallel parallel(2);
    std::vector<AmbientClass> classes = engine::ambientClasses(b.scene, engine::spreadDirections(6), parallel, &direct);
    for (size_t k : {0u, 1u, 3u, 4u, 5u}) CHECK(classes[k].emitted == glm::dvec3(0));
    return classes[2].emitted;
  };
  const double expected = 16 * std::sqrt(0.5) / 3.14159265358979;  // of rho = 1 and E = 1
  const glm::dvec3 found = unshot(sun);
  CHECK(found.x == Approx(0.5 * 2 * expected));
  CHECK(found.y == Approx(0.25 * 4 * expected));
  CHECK(found.z == 0);

  engine::SceneLight lamp;
  lamp.kind = post::LightKind::Point;
  lamp.position = {0, 2, 0};
  // The two triangles' centres, (+-2/3, 0, -+2/3): E = I cos / d^2 = 2 I / d^3.
  const double d = std::sqrt(4 + 8.0 / 9);
  CHECK(unshot(lamp).x == Approx(0.5 * 16 * 2 / (d * d * d) / 3.14159265358979));
  engine::SceneLight spot = lamp;
  spot.kind = post::LightKind::Spot;
  spot.direction = {0, 1, 0};
  CHECK(unshot(spot) == glm::dvec3(0));

  // A roof that hides one of the two centres from the sun: it lies 1 higher, and so 1 farther against the sun.
  b.addQuad({-1.9f, 1, -0.4f}, {-1.4f, 1, -0.4f}, {-1.4f, 1, -0.9f}, {-1.9f, 1, -0.9f}, glm::vec3(0));
  CHECK(unshot(sun).x == Approx(0.5 * 2 * expected / 2));
}

TEST_CASE("extended ambient: in a box whose floor the sun lights, the other walls get a fifth of what it sends") {
  Builder b = room(glm::vec3(0), glm::vec3(0), glm::vec3(0));
  b.scene.materials[2].baseColor = {0.5f, 0.5f, 0.5f, 1};
  b.scene.bounds = {glm::dvec3(-2), glm::dvec3(2), false};
  engine::SceneLight lamp;  // straight down through the lid, as it has no shadows
  lamp.direction = {0, -1, 0};
  lamp.color = glm::vec3(3.14159265f);
  lamp.shadows = false;
  const engine::BouncedLight direct(b.scene, {&lamp, 1}, true, {});
  raster::Parallel parallel(2);
  const auto in = engine::extendedAmbient(b.scene, std::nullopt, parallel, &direct);
  REQUIRE(in.ok());
  for (size_t k = 0; k < 6; ++k) CHECK((*in)[k].color.x == Approx(k == 2 ? 0 : 0.5 / 5).margin(1e-6));
}
