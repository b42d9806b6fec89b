// A million random triangles against exact arithmetic, pixel for pixel.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

#include "raster_oracle.h"
#include "test_scene.h"

using namespace obscura;
using namespace obscura::raster;
using namespace obscura::tests;

namespace {

constexpr float kKeyRange = float(1 << 24);  // depth keys are integers below

// Every triangle has a cell of a large image to itself and may touch its borders, so one frame tests many.
struct Kind {
  const char* name;
  int cell, size;        // pixels: of a cell, of the square image (a power of two: then 1 unit is exactly 1 pixel)
  int fractionBits;      // vertices lie on multiples of 2^-bits sub-pixel before they are snapped; exact in float
  int framesOfMillion;   // of a run over a million triangles
};
constexpr Kind kKinds[] = {
    {"dust", 8, 16, 12, 1500},    // down to 2^-20 pixel
    {"small", 8, 1024, 6, 50},    // 16384 triangles a frame
    {"medium", 32, 1024, 6, 170},
    {"large", 128, 1024, 6, 80},  // beyond the 64 pixels of the short path
};

// 1 unit = 1 pixel, the origin is the image's centre; the key is z itself.
Camera pixelCamera(int width, int height) {
  Camera c = orthographic(width * 0.5, height * 0.5, 0.5, double(kKeyRange));
  return c;
}

// Rounds v / 2^bits to the nearest integer, halves to even, by integers alone.
int64_t snap(int64_t v, int bits) {
  if (bits == 0) return v;
  const int64_t half = int64_t(1) << (bits - 1), floor = (v + half) >> bits;
  const bool tie = ((v + half) & (2 * half - 1)) == 0;
  return tie && (floor & 1) ? floor - 1 : floor;
}

float randomKey(Random& random) {
  const int bits = random.integer(1, 24);
  return -float(1 + (random.bits() >> 8) % ((1u << bits) - 1));
}

// A coordinate inside a cell of `cell` pixels, in sub-pixels: anywhere, on centres, borders or quarters of pixels.
int coordinate(Random& random, int cell, int style) {
  const int pixel = random.integer(0, cell - 1) * kSub;
  if (style == 0) return random.integer(0, cell * kSub);
  if (style == 1) return pixel + kSub / 2;
  if (style == 2) return pixel + kSub * random.integer(0, 1);
  return pixel + kSub / 4 * random.integer(0, 4);
}

// The three vertices relative to the cell's corner, of a random shape; `previous` is the triangle of the cell before.
void randomShape(Random& random, int cell, SubPoint v[3], const SubPoint previous[3]) {
  const int last = cell * kSub, style = random.integer(0, 3), shape = random.integer(0, 8);
  const auto point = [&](int s) -> SubPoint {
    const int x = coordinate(random, cell, s);
    return {x, coordinate(random, cell, s)};
  };
  const auto around = [&](SubPoint p, int reach) -> SubPoint {
    const int64_t x = p.x + random.integer(-reach, reach), y = p.y + random.integer(-reach, reach);
    return {std::clamp<int64_t>(x, 0, last), std::clamp<int64_t>(y, 0, last)};
  };
  for (int i = 0; i < 3; ++i) v[i] = point(style);
  if (shape == 0) {  // tiny, about anything or a pixel's centre
    const int reach = random.integer(0, 1) ? 2 : 40;
    v[1] = around(v[0], reach), v[2] = around(v[0], reach);
  } else if (shape == 1) {  // sliver: the third vertex hardly off the edge of the others
    const int part = random.integer(0, 256);
    const SubPoint on{v[0].x + (v[1].x - v[0].x) * part / 256, v[0].y + (v[1].y - v[0].y) * part / 256};
    v[2] = around(on, random.integer(0, 2));
  } else if (shape == 2) {  // one edge horizontal or vertical
    if (random.integer(0, 1)) v[1].x = v[0].x;
    else v[1].y = v[0].y;
  } else if (shape == 3) {  // both
    v[1].x = v[0].x, v[2].y = v[0].y;
  } else if (shape == 4 && random.integer(0, 3) == 0) {  // no area
    v[random.integer(1, 2)] = v[0];
  } else if (shape == 5 || shape == 6) {  // a fan: an edge shared with the triangle before
    v[0] = previous[0], v[1] = previous[2];
  } else if (shape == 7) {  // an edge exactly through a centre
    const SubPoint c = point(1);
    const int64_t dx = c.x - v[0].x, dy = c.y - v[0].y;
    const SubPoint beyond{c.x + dx, c.y + dy};
    v[1] = beyond.x >= 0 && beyond.y >= 0 && beyond.x <= last && beyond.y <= last ? beyond : c;
  }
}

struct Batch {
  const Kind* kind = nullptr;
  int frame = 0;
  TestScene scene;
  std::vector<OracleTriangle> triangles;  // as they are snapped; triangle k has cell k
  bool singleSided = false;

  int columns() const { return kind->size / kind->cell; }
  OracleImage image() const { return {scene.width, scene.height}; }
};

Batch makeBatch(const Kind& kind, int frame) {
  Batch b;
  b.kind = &kind;
  b.frame = frame;
  TestScene& s = b.scene;
  s.width = s.height = kind.size;
  s.camera = pixelCamera(kind.size, kind.size);
  s.materials.resize(1);
  // Up to 8 pixels and on whole sub-pixels, the plane's normal is exact in float, so the facing is known exactly.
  b.singleSided = kind.cell <= 8 && frame % 4 == 3;
  s.materials[0].doubleSided = !b.singleSided;
  Random random(uint32_t(frame) * 8 + uint32_t(&kind - kKinds));
  TestMesh& m = s.addMesh();
  SubPoint v[3], previous[3];
  for (int k = 0; k < b.columns() * b.columns(); ++k) {
    std::copy(v, v + 3, previous);
    randomShape(random, kind.cell, v, previous);
    const int bits = b.singleSided || random.integer(0, 2) ? 0 : kind.fractionBits;
    const int64_t one = int64_t(1) << bits, half = int64_t(kind.size) * (kSub / 2), last = int64_t(kind.cell) * kSub;
    const int64_t cellX = int64_t(k % b.columns()) * last - half, cellY = int64_t(k / b.columns()) * last - half;
    OracleTriangle t;
    for (int i = 0; i < 3; ++i) {
      const auto jitter = [&](int64_t c) {
        const int64_t fine = c * one + (bits ? random.integer(-(1 << bits), 1 << bits) : 0);
        return std::clamp<int64_t>(fine, 0, last * one);
      };
      const int64_t x = cellX * one + jitter(v[i].x), y = cellY * one + jitter(v[i].y);
      t.at[i] = {snap(x, bits), snap(y, bits)};
      t.key[i] = randomKey(random);
      const float unit = 1.0f / float(kSub * one);
      m.indices.push_back(uint32_t(m.positions.size()));
      m.positions.push_back({float(x) * unit, -float(y) * unit, t.key[i]});
    }
    b.triangles.push_back(t);
  }
  s.place(m);
  return b;
}

// y points down: counter-clockwise is a negative area.
bool counterClockwise(const OracleTriangle& t) {
  return (t.at[1].x - t.at[0].x) * (t.at[2].y - t.at[0].y) < (t.at[2].x - t.at[0].x) * (t.at[1].y - t.at[0].y);
}

constexpr double kHalfUlp = 1.0 / (1 << 24);

// Empty, or what is wrong with the key of a covered pixel. Each of the two gradients, their products with the distance
// and the two sums are rounded once: at most four half ulps of `terms`; and a key never leaves its triangle's range.
std::string checkKey(const OracleTriangle& t, SubPoint center, float key) {
  const auto range = std::minmax({t.key[0], t.key[1], t.key[2]});
  const KeyError e = keyError(t, center, key);
  if (key >= range.first && key <= range.second && e.error <= 4 * kHalfUlp * e.terms) return "";
  return "key " + std::to_string(key) + " errs by " + std::to_string(e.error) + ", bound " +
         std::to_string(4 * kHalfUlp * e.terms);
}

// Empty, or the first pixel of the box [x0, x1) x [y0, y1) in which the frame is not what the oracle says of triangle
// `id`.
std::string checkBox(const GBuffer& g, const OracleTriangle& t, uint32_t id, bool seen, int x0, int y0, int x1,
                     int y1) {
  const OracleImage image{g.width, g.height};
  const auto at = [&](int x, int y) { return "pixel (" + std::to_string(x) + ", " + std::to_string(y) + "): "; };
  for (int y = y0; y < y1; ++y) {
    const Columns c = seen ? coveredColumns(t, image, y) : Columns{};
    for (int x = x0; x < x1; ++x) {
      const uint32_t expected = x >= c.begin && x < c.end ? id : kNoTriangle, found = g.triangle.at(x, y);
      if (found != expected)
        return at(x, y) + "triangle " + std::to_string(found) + ", expected " + std::to_string(expected);
    }
    if (c.begin == c.end) continue;
    for (int x : {c.begin, c.end - 1}) {  // the key is linear: it errs most at the ends
      const std::string wrong = checkKey(t, {image.xCenter(x), image.yCenter(y)}, 0 - g.depth.at(x, y));
      if (!wrong.empty()) return at(x, y) + wrong;
    }
  }
  return "";
}

Settings settingsOf(int frame) {
  static const std::vector<Target> targets = supportedTargets();
  return {1, targets[size_t(frame) % targets.size()], 16 << (frame / 2 % 3), frame % 5 != 0};
}

PlaneSet depthAndTriangle() {
  PlaneSet planes;
  planes.depth = planes.triangle = true;
  return planes;
}

void runBatch(const Kind& kind, int frame, uint64_t& triangles) {
  const Batch b = makeBatch(kind, frame);
  const Settings settings = settingsOf(frame);
  Rasterizer rasterizer(settings);
  GBuffer g;
  rasterizer.render(b.scene.list(), b.scene.camera, b.scene.width, b.scene.height, depthAndTriangle(), g);
  for (uint32_t k = 0; k < b.triangles.size(); ++k) {
    const int x = int(k) % b.columns() * kind.cell, y = int(k) / b.columns() * kind.cell;
    const OracleTriangle& t = b.triangles[k];
    const bool seen = !b.singleSided || counterClockwise(t);
    const std::string wrong = checkBox(g, t, k, seen, x, y, x + kind.cell, y + kind.cell);
    if (!wrong.empty())
      FAIL(wrong << "\ntriangle " << k << ": " << textOf(t) << " sub-pixels from the centre of " << kind.size << " x "
                 << kind.size << ", " << (b.singleSided ? "single" : "double") << "-sided, target "
                 << targetName(settings.target) << ", tile " << settings.tile
                 << "\nrepeat with OBSCURA_ORACLE=" << kind.name << ":" << frame);
  }
  triangles += b.triangles.size();
}

// A coordinate of 10^0 ... 10^6 pixels, in sub-pixels; exact in float (24 bits).
int64_t hugeCoordinate(Random& random, int64_t limit) {
  const int bits = random.integer(8, 28);
  int64_t v = int64_t(random.bits() >> 4) % (int64_t(1) << bits);
  v = std::min(v, limit);
  if (v >= 1 << 24) v &= ~int64_t(31);
  return random.integer(0, 1) ? v : -v;
}

}  // namespace

TEST_CASE("oracle: a million random triangles, alone in their cells, agree with exact arithmetic pixel for pixel") {
  const char* only = std::getenv("OBSCURA_ORACLE");  // "small:17": this frame alone; "x100": a hundred times as many
  const std::string wanted = only ? only : "";
  const int times = wanted[0] == 'x' ? std::max(1, std::atoi(wanted.c_str() + 1)) : 1;
  uint64_t triangles = 0;
  for (const Kind& kind : kKinds) {
    const std::string prefix = std::string(kind.name) + ":";
    if (!wanted.empty() && wanted[0] != 'x') {
      if (wanted.compare(0, prefix.size(), prefix) == 0)
        runBatch(kind, std::atoi(wanted.c_str() + prefix.size()), triangles);
      continue;
    }
    const int frames = kFastBuild ? kind.framesOfMillion * times : std::max(2, kind.framesOfMillion / 50);
    for (int frame = 0; frame < frames; ++frame) runBatch(kind, frame, triangles);
  }
  if (kFastBuild && wanted.empty()) CHECK(triangles >= 1000000);
}

TEST_CASE("oracle: triangles of up to a thousand images' size agree with exact arithmetic inside the guard band") {
  const int rounds = kFastBuild ? 6000 : 300;
  const int sizes[][2] = {{64, 64}, {1, 1}, {17, 33}, {130, 65}, {200, 9}};
  std::vector<Rasterizer> rasterizers;
  for (int i = 0; i < 6; ++i) rasterizers.emplace_back(settingsOf(i));
  GBuffer g;
  int64_t covered = 0;
  for (int round = 0; round < rounds; ++round) {
    Random random(uint32_t(round) + 77000);
    const auto& size = sizes[round % 5];
    const OracleImage image{size[0], size[1]};
    TestScene s;
    s.materials.resize(1);
    s.materials[0].doubleSided = true;
    OracleTriangle t;
    for (int i = 0; i < 3; ++i) {
      const int64_t x = hugeCoordinate(random, kGuardSub);
      t.at[i] = {x, hugeCoordinate(random, kGuardSub)};
      t.key[i] = randomKey(random);
    }
    if (round % 3 == 0) {  // an edge exactly through a centre, at any slope, to vertices far away
      const SubPoint c{image.xCenter(random.integer(0, size[0] - 1)), image.yCenter(random.integer(0, size[1] - 1))};
      const int dx = random.integer(-1000, 1000), dy = random.integer(-1000, 1000);
      const int before = random.integer(0, 2000), after = random.integer(0, 2000);
      t.at[0] = {c.x - dx * before, c.y - dy * before};
      t.at[1] = {c.x + dx * after, c.y + dy * after};
    }
    TestMesh& m = s.addMesh();
    for (int i = 0; i < 3; ++i) {
      m.indices.push_back(uint32_t(i));
      m.positions.push_back({float(t.at[i].x) / kSub, -float(t.at[i].y) / kSub, t.key[i]});
    }
    s.place(m);
    rasterizers[size_t(round % 6)].render(s.list(), pixelCamera(size[0], size[1]), size[0], size[1], depthAndTriangle(),
                                          g);
    INFO("round " << round << ", " << size[0] << " x " << size[1] << " pixels: " << textOf(t));
    REQUIRE(checkBox(g, t, 0, true, 0, 0, size[0], size[1]) == "");
    for (int y = 0; y < size[1]; ++y) covered += coveredColumns(t, image, y).end - coveredColumns(t, image, y).begin;
  }
  CHECK(covered > rounds * 100);
}

TEST_CASE("oracle: triangles of up to a million pixels, cut by the guard band, are right up to the cut's rounding") {
  const int rounds = kFastBuild ? 6000 : 300, width = 70, height = 50;
  const OracleImage image{width, height};
  const Camera camera = pixelCamera(width, height);
  const View view = makeView(camera, width, height);
  Rasterizer rasterizer({1, Target::Auto, 32, true});
  GBuffer g;
  int clipped = 0;
  int64_t decided = 0;
  for (int round = 0; round < rounds; ++round) {
    Random random(uint32_t(round) + 99000);
    TestScene s;
    s.materials.resize(1);
    s.materials[0].doubleSided = true;
    TestMesh& m = s.addMesh();
    OracleTriangle whole;
    for (int i = 0; i < 3; ++i) {
      const int64_t x = hugeCoordinate(random, 256000000);
      whole.at[i] = {x, hugeCoordinate(random, 256000000)};
      m.indices.push_back(uint32_t(i));
      m.positions.push_back({float(whole.at[i].x) / kSub, -float(whole.at[i].y) / kSub, randomKey(random)});
    }
    s.place(m);
    rasterizer.render(s.list(), camera, width, height, depthAndTriangle(), g);
    clipped += rasterizer.statistics().clipped > 0;
    const std::vector<Draw> draws = makeDraws(s.list(), camera);
    const std::vector<OracleTriangle> pieces = snappedPieces(view, draws[0], 0);
    const bool cut = rasterizer.statistics().clipped > 0;
    for (int y = 0; y < height; ++y) {
      std::vector<bool> defined(size_t(width), false);
      for (const OracleTriangle& t : pieces) {
        const Columns c = coveredColumns(t, image, y);
        for (int x = c.begin; x < c.end; ++x) defined[size_t(x)] = true;
      }
      const Columns exact = coveredColumns(whole, image, y);
      for (int x = 0; x < width; ++x) {
        const bool found = g.triangle.at(x, y) == 0, expected = x >= exact.begin && x < exact.end;
        // A cut end is rounded by half a sub-pixel in x and y, so the edge moves by less than one.
        const bool near = nearAnEdge(whole, {image.xCenter(x), image.yCenter(y)}, 1);
        decided += !near;
        if ((cut && found != defined[size_t(x)]) || (!near && found != expected))
          FAIL("round " << round << ", pixel (" << x << ", " << y << "), cut " << cut << ": " << textOf(whole));
      }
    }
  }
  CHECK(clipped > rounds / 2);
  CHECK(decided > int64_t(rounds) * width * height * 9 / 10);
}
