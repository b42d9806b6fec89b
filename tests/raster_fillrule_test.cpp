// The fill rule, in the manner of dEQP's rasterization tests: every pixel of a tessellated square exactly once.
#include <catch2/catch.hpp>

#include <cmath>

#include "obscura/raster/clip.h"
#include "obscura/raster/exact_math.h"
#include "raster_oracle.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

// A square of cells x cells x 2 triangles, placed on the screen and then given a depth w per vertex: the projection
// divides by w, so the outline and the pieces on the screen are the same whatever w is.
struct Grid {
  int cells = 4;
  double angle = 0;                    // radians
  double xSize = 40, ySize = 40;       // pixels
  double xCenter = 0, yCenter = 0;     // pixels from the image's centre, y up
  float wMin = 1, wMax = 1;
  bool reversed = false;               // clockwise
  uint32_t seed = 0;
};

struct Setup {
  Grid grid;
  int width = 64, height = 64;
  float zNear = 0.05f, zFar = 0;
  bool doubleSided = true;
};

// 90 degrees of height: a point at (x, y) pixels from the centre and depth w lies at (x, y) w / (height / 2).
Camera cameraOf(const Setup& s) {
  return perspective(3.14159265358979 / 2, double(s.width) / s.height, s.zNear, s.zFar);
}

void build(const Setup& setup, TestScene& s) {
  const Grid& g = setup.grid;
  Random random(g.seed);
  s.materials.resize(1);
  s.materials[0].doubleSided = setup.doubleSided;
  s.width = setup.width;
  s.height = setup.height;
  s.camera = cameraOf(setup);
  TestMesh& m = s.addMesh();
  const double cosine = exactCos(g.angle), sine = exactSin(g.angle);
  for (int j = 0; j <= g.cells; ++j)
    for (int i = 0; i <= g.cells; ++i) {
      const double u = (double(i) / g.cells - 0.5) * g.xSize, v = (double(j) / g.cells - 0.5) * g.ySize;
      const double w = double(random.real(g.wMin, g.wMax)), perPixel = w / (setup.height * 0.5);
      m.positions.push_back({float((u * cosine - v * sine + g.xCenter) * perPixel),
                             float((u * sine + v * cosine + g.yCenter) * perPixel), float(-w)});
    }
  for (int j = 0; j < g.cells; ++j)
    for (int i = 0; i < g.cells; ++i) {
      const uint32_t a = uint32_t(j * (g.cells + 1) + i), b = a + 1, d = a + uint32_t(g.cells) + 1, c = d + 1;
      const bool other = (i + j) % 2;  // diagonals of both directions
      const uint32_t corners[2][6] = {{a, b, c, a, c, d}, {a, b, d, b, c, d}};
      for (int k = 0; k < 6; k += 3)
        for (int n : {0, g.reversed ? 2 : 1, g.reversed ? 1 : 2}) m.indices.push_back(corners[other][k + n]);
    }
  s.place(m);
}

// How many of the triangles, each drawn alone, cover each pixel.
std::vector<int> coverage(const TestScene& s, Statistics* statistics = nullptr) {
  std::vector<int> count(size_t(s.width) * size_t(s.height));
  Rasterizer rasterizer({1, Target::Auto, 32, true});
  GBuffer g;
  PlaneSet planes;
  planes.triangle = true;
  for (size_t t = 0; t < s.meshes[0].indices.size(); t += 3) {
    MeshView one = s.meshes[0].view;
    one.indices = {s.meshes[0].indices.data() + t, 3};
    one.clusters = nullptr;
    const Instance instance{&one, 0, glm::dmat4(1)};
    rasterizer.render({Span<const Instance>(&instance, 1), s.materials, {}}, s.camera, s.width, s.height, planes, g);
    if (statistics) statistics->add(rasterizer.statistics());
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) count[size_t(y) * size_t(s.width) + size_t(x)] += g.triangle.at(x, y) == 0;
  }
  return count;
}

// The same from the oracle: a pixel counts once for a triangle, however many of its clipped pieces cover it.
std::vector<int> oracleCoverage(const TestScene& s) {
  const View view = makeView(s.camera, s.width, s.height);
  const std::vector<Draw> draws = makeDraws(s.list(), s.camera);
  const OracleImage image{s.width, s.height};
  std::vector<int> count(size_t(s.width) * size_t(s.height)), last(count.size(), -1);
  for (uint32_t t = 0; t < draws[0].triangleCount; ++t)
    for (const OracleTriangle& piece : snappedPieces(view, draws[0], t))
      for (int y = 0; y < s.height; ++y) {
        const Columns c = coveredColumns(piece, image, y);
        for (int x = c.begin; x < c.end; ++x) {
          const size_t at = size_t(y) * size_t(s.width) + size_t(x);
          count[at] += last[at] != int(t);
          last[at] = int(t);
        }
      }
  return count;
}

// The outline of the grid as it is snapped; only where nothing is clipped.
std::vector<SubPoint> outline(const Setup& setup, const TestScene& s) {
  const View view = makeView(s.camera, s.width, s.height);
  const int n = setup.grid.cells;
  std::vector<int> border;
  for (int i = 0; i < n; ++i) border.push_back(i);
  for (int i = 0; i < n; ++i) border.push_back(n + i * (n + 1));
  for (int i = n; i > 0; --i) border.push_back(n * (n + 1) + i);
  for (int i = n; i > 0; --i) border.push_back(i * (n + 1));
  std::vector<SubPoint> polygon;
  for (int v : border) {
    int32_t x, y;
    float key;
    snapVertex(view, s.meshes[0].positions[size_t(v)], x, y, key);
    polygon.push_back({x, y});
  }
  return polygon;
}

// What must be seen at a pixel of a clipped grid: 1 or 0 where the surface, as the exact projection has it, lies within
// the near and far planes or without, and -1 within two sub-pixels of a limit.
int expectedAt(const Setup& setup, const TestScene& s, double xSub, double ySub) {
  const double slack = 2;
  const TestMesh& m = s.meshes[0];
  int result = 0;
  for (size_t t = 0; t < m.indices.size(); t += 3) {
    double x[3], y[3], inverse[3];
    for (size_t i = 0; i < 3; ++i) {
      const glm::vec3& p = m.positions[m.indices[t + i]];
      const double perSub = setup.height * 0.5 * kSub / -double(p.z);
      x[i] = p.x * perSub, y[i] = -p.y * perSub, inverse[i] = 1 / -double(p.z);
    }
    const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    double weight[3], value = 0, xSlope = 0, ySlope = 0;
    bool inside = true, near = true;
    for (int i = 0; i < 3; ++i) {
      const int p = (i + 1) % 3, q = (i + 2) % 3;
      const double dx = x[q] - x[p], dy = y[q] - y[p], length = std::sqrt(dx * dx + dy * dy);
      weight[i] = (dx * (ySub - y[p]) - dy * (xSub - x[p])) / area;
      const double distance = weight[i] * std::fabs(area) / length;
      inside &= distance >= 0;
      near &= distance >= -slack;
      value += weight[i] * inverse[i];
      xSlope -= dy / area * inverse[i];
      ySlope += dx / area * inverse[i];
    }
    if (!near) continue;
    const double change = slack * (std::fabs(xSlope) + std::fabs(ySlope));
    const double nearest = 1 / double(setup.zNear), farthest = setup.zFar > 0 ? 1 / double(setup.zFar) : 0;
    if (value > nearest + change || value < farthest - change) continue;
    const bool decided = value < nearest - change && (setup.zFar == 0 || value > farthest + change);
    if (!decided) return -1;
    if (inside) result = 1;
    else if (result == 0) result = -1;  // outside by a hair: a neighbour may have it
  }
  return result;
}

struct Checked {
  int covered = 0, decided = 0;
  Statistics statistics;
};

Checked checkGrid(const Setup& setup) {
  TestScene s;
  build(setup, s);
  Checked checked;
  const std::vector<int> count = coverage(s, &checked.statistics), expected = oracleCoverage(s);
  const OracleImage image{s.width, s.height};
  const bool cut = checked.statistics.clipped > 0;
  const std::vector<SubPoint> polygon = cut ? std::vector<SubPoint>() : outline(setup, s);
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const size_t at = size_t(y) * size_t(s.width) + size_t(x);
      const SubPoint c{image.xCenter(x), image.yCenter(y)};
      const int exactly = cut ? expectedAt(setup, s, double(c.x), double(c.y)) : int(insidePolygon(polygon, c));
      const bool wrong = count[at] != expected[at] || count[at] > 1 || (exactly >= 0 && count[at] != exactly);
      if (wrong)
        FAIL("pixel (" << x << ", " << y << ") is covered " << count[at] << " times, oracle " << expected[at]
                       << ", expected " << exactly << "; angle " << setup.grid.angle << " seed " << setup.grid.seed
                       << " near " << setup.zNear);
      checked.covered += count[at];
      checked.decided += exactly >= 0;
    }
  return checked;
}

constexpr double kSixteenth = 3.14159265358979 / 8;

}  // namespace

TEST_CASE("fill rule: a square covers each of its pixels exactly once, at sixteen rotations, and reversed") {
  for (int turn = 0; turn < 16; ++turn)
    for (bool reversed : {false, true})
      for (double center : {0.0, 0.5, 0.25}) {  // vertices on pixel corners, on centres, between
        Setup s;
        s.grid.angle = turn * kSixteenth;
        s.grid.reversed = reversed;
        s.grid.xCenter = s.grid.yCenter = center;
        CHECK(checkGrid(s).covered > 1500);
      }
}

TEST_CASE("fill rule: single-sided, counter-clockwise covers what two sides cover, and reversed nothing") {
  for (int turn = 0; turn < 16; ++turn) {
    Setup s;
    s.grid.angle = turn * kSixteenth;
    s.grid.wMin = 0.1f, s.grid.wMax = 4;
    s.grid.seed = uint32_t(turn);
    TestScene both, front, back;
    build(s, both);
    s.doubleSided = false;
    build(s, front);
    s.grid.reversed = true;
    build(s, back);
    CHECK(coverage(front) == coverage(both));
    CHECK(coverage(back) == std::vector<int>(size_t(s.width * s.height), 0));
  }
}

TEST_CASE("fill rule: projected with random w in [0.1, 4], each pixel exactly once") {
  for (int turn = 0; turn < 16; ++turn)
    for (uint32_t seed = 0; seed < 4; ++seed) {
      Setup s;
      s.grid.angle = turn * kSixteenth + seed * 0.01;
      s.grid.wMin = 0.1f, s.grid.wMax = 4;
      s.grid.cells = 3 + int(seed) * 3;
      s.grid.seed = seed * 100 + uint32_t(turn);
      CHECK(checkGrid(s).covered > 1500);
    }
}

TEST_CASE("fill rule: partly outside the image on each side, each pixel exactly once") {
  for (int turn = 0; turn < 16; ++turn)
    for (int side = 0; side < 4; ++side) {
      Setup s;
      s.width = 63, s.height = 49;
      s.grid.angle = turn * kSixteenth;
      s.grid.xCenter = side == 0 ? -40 : side == 1 ? 40 : 0;
      s.grid.yCenter = side == 2 ? -35 : side == 3 ? 35 : 0;
      s.grid.wMin = 0.1f, s.grid.wMax = 4;
      s.grid.seed = uint32_t(side);
      const Checked c = checkGrid(s);
      CHECK(c.covered > 100);
      CHECK(c.covered < 1600);
    }
}

TEST_CASE("fill rule: cut by the near plane, the far plane and both, no hole and no overlap") {
  for (int turn = 0; turn < 16; turn += kFastBuild ? 1 : 3)
    for (int planes = 1; planes <= 3; ++planes)
      for (uint32_t seed = 0; seed < 2; ++seed) {
        Setup s;
        s.grid.angle = turn * kSixteenth;
        s.grid.wMin = 0.1f, s.grid.wMax = 4;
        s.grid.seed = seed * 31 + uint32_t(turn);
        s.zNear = planes & 1 ? 1.0f : 0.05f;
        s.zFar = planes & 2 ? 2.5f : 0;
        const Checked c = checkGrid(s);
        CHECK(c.statistics.clipped > 0);
        CHECK(c.covered > 100);
        CHECK(c.decided > 3500);
      }
}

TEST_CASE("fill rule: cut by each side of the guard band, no hole and no overlap") {
  for (int turn = 0; turn < 16; turn += kFastBuild ? 1 : 3)
    for (int side = 0; side < 5; ++side) {
      Setup s;
      s.grid.angle = turn * kSixteenth;
      s.grid.xSize = s.grid.ySize = side == 4 ? 60000 : 19000;  // the band ends at 8192; side 4: on all sides at once
      s.grid.xCenter = side == 0 ? -8000 : side == 1 ? 8000 : 13;
      s.grid.yCenter = side == 2 ? -8000 : side == 3 ? 8000 : -7;
      s.grid.wMin = 0.1f, s.grid.wMax = 4;
      s.grid.cells = 5;
      s.grid.seed = uint32_t(side * 16 + turn);
      const Checked c = checkGrid(s);
      CHECK(c.statistics.clipped > 5);
      CHECK(c.covered == s.width * s.height);
    }
}

TEST_CASE("fill rule: entirely clipped away by any plane, nothing is covered") {
  for (int plane = 0; plane < 6; ++plane) {
    Setup s;
    s.grid.wMin = 1, s.grid.wMax = 2;
    if (plane == 0) s.zNear = 2.5f;
    if (plane == 1) s.zFar = 0.5f;
    s.grid.xCenter = plane == 2 ? -20000 : plane == 3 ? 20000 : 0;
    s.grid.yCenter = plane == 4 ? -20000 : plane == 5 ? 20000 : 0;
    TestScene scene;
    build(s, scene);
    CHECK(coverage(scene) == std::vector<int>(size_t(s.width * s.height), 0));
  }
}

TEST_CASE("fill rule: an edge whose end lies in the last quarter pixel of the guard band is the same for both sides") {
  // One of the two triangles that share the edge is cut elsewhere, the other is not. The edge runs exactly through a
  // pixel's centre, so whoever moves it by a fraction of a sub-pixel loses that pixel or covers it twice.
  const int width = 64, height = 64;
  const OracleImage image{width, height};
  const Camera camera = orthographic(width / 2.0, height / 2.0, 0.1, 100);
  int wrong = 0, rounds = 0;
  std::string first;
  for (int round = 0; round < 400; ++round) {
    Random random(700u + uint32_t(round));
    const SubPoint c{image.xCenter(random.integer(0, width - 1)), image.yCenter(random.integer(0, height - 1))};
    // c + k (dx, dy) ends at x in (guard - 64, guard].
    const int64_t target = kGuardSub - random.integer(0, 63) - c.x;
    int64_t dx = random.integer(100, 3000);
    while (target % dx != 0) --dx;
    const int64_t k = target / dx, dy = random.integer(-int(dx), int(dx));
    if (std::abs(c.y + k * dy) > kGuardSub - 1000) continue;
    const SubPoint p{c.x + k * dx, c.y + k * dy}, q{c.x - dx, c.y - dy};
    const SubPoint above{kGuardSub + 300000, p.y - 900000}, below{p.x - 200000, p.y + 100000};
    TestScene s;
    s.width = width, s.height = height;
    s.camera = camera;
    s.materials.resize(1);
    s.materials[0].doubleSided = true;
    TestMesh& m = s.addMesh();
    for (const SubPoint& v : {p, q, above, below}) m.positions.push_back({float(v.x) / kSub, -float(v.y) / kSub, -1});
    m.indices = {0, 1, 2, 0, 1, 3};
    s.place(m);
    const OracleTriangle upper{{p, q, above}, {}}, lower{{p, q, below}, {}};
    const std::vector<int> count = coverage(s);
    for (int y = 0; y < height; ++y) {
      const Columns a = coveredColumns(upper, image, y), b = coveredColumns(lower, image, y);
      for (int x = 0; x < width; ++x) {
        const SubPoint center{image.xCenter(x), image.yCenter(y)};
        const int expected = int(x >= a.begin && x < a.end) + int(x >= b.begin && x < b.end);
        const int found = count[size_t(y) * width + size_t(x)];
        // Only along the shared edge; the others are rightly moved by their cuts.
        if (!nearAnEdge({{p, q, p}, {}}, center, 1) || nearAnEdge({{q, above, q}, {}}, center, 2)) continue;
        if (found != expected && wrong++ == 0)
          first = "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") covered " + std::to_string(found) +
                  " times, not " + std::to_string(expected) + "; cut: " + textOf(upper) + "; whole: " + textOf(lower);
      }
    }
    ++rounds;
  }
  INFO(first);
  CHECK(rounds > 200);
  CHECK(wrong == 0);
}

TEST_CASE("fill rule: single-sided needles leave no hole in a plane, however thin they are") {
  // The needle's corners are c + a, c + b, c - a - b with det(a, b) = 1: it holds the pixel's centre c and no other
  // sub-pixel inside, and its doubled area is 3, which float products of its sides cannot tell from 0.
  const int width = 256, height = 256;
  for (int k = 8; k < 22; ++k) {
    int64_t f[3] = {1, 1, 2};
    for (int i = 0; i < k; ++i) f[0] = f[1], f[1] = f[2], f[2] = f[0] + f[1];
    const SubPoint c{kSub / 2, kSub / 2}, a{f[1], f[2]}, b{f[0], f[1]};
    SubPoint v[3] = {{c.x + a.x, c.y + a.y}, {c.x + b.x, c.y + b.y}, {c.x - a.x - b.x, c.y - a.y - b.y}};
    if ((v[1].x - v[0].x) * (v[2].y - v[0].y) > (v[2].x - v[0].x) * (v[1].y - v[0].y)) std::swap(v[1], v[2]);
    TestScene s;
    s.width = width, s.height = height;
    s.camera = orthographic(width / 2.0, height / 2.0, 0.1, 100);
    s.materials.resize(1);
    TestMesh& m = s.addMesh();
    for (const SubPoint& p : v) m.positions.push_back({float(p.x) / kSub, -float(p.y) / kSub, -1});
    m.indices = {0, 1, 2};
    s.place(m);
    const OracleImage image{width, height};
    const OracleTriangle needle{{v[0], v[1], v[2]}, {}};
    const Columns row = coveredColumns(needle, image, height / 2);
    REQUIRE(row.end - row.begin == 1);
    INFO("k " << k << ": " << textOf(needle));
    CHECK(coverage(s)[size_t(height / 2) * width + size_t(row.begin)] == 1);
  }
}
