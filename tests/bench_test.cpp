// obscura-bench on tiny sizes: what it prints is complete, and its own scenes are what they claim to be.
#include "bench_program.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <set>
#include <thread>
#include <tuple>

#include <glm/geometric.hpp>

#include "obscura/apps/bench_measure.h"
#include "obscura/apps/bench_scenes.h"
#include "obscura/raster/rasterizer.h"
#include "obscura/raster/target.h"

using namespace obscura;
using namespace obscura::tests;

namespace {

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("bench: a grid's triangles turn one way and cover its area exactly once") {
  for (const int cell : {1, 2, 3, 16}) {
    const apps::BenchScene scene = apps::makeGrid(70, 45, cell, raster::Projection::Orthographic);
    double least = 1e30, sum = 0;
    glm::dvec2 lo(1e30), hi(-1e30);
    for (const engine::Mesh& mesh : scene.meshes)
      for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        glm::dvec2 p[3];
        for (size_t k = 0; k < 3; ++k) {
          p[k] = glm::dvec2(mesh.positions[mesh.indices[t + k]]);
          REQUIRE(p[k] * 256.0 == glm::floor(p[k] * 256.0));
          lo = glm::min(lo, p[k]);
          hi = glm::max(hi, p[k]);
        }
        const glm::dvec2 e = p[1] - p[0], f = p[2] - p[0];
        least = std::min(least, e.x * f.y - f.x * e.y);
        sum += e.x * f.y - f.x * e.y;
      }
    INFO("cell " << cell);
    CHECK((lo.x <= -35 && lo.y <= -22.5 && hi.x >= 35 && hi.y >= 22.5));
    CHECK(least > 0.25 * cell * cell);
    CHECK(sum == 2 * (hi.x - lo.x) * (hi.y - lo.y));  // whole numbers of 1 / 65536: exact
    CHECK(scene.triangles >= 2 * size_t(70 / cell) * size_t(45 / cell));
  }
}

TEST_CASE("bench: a ball is closed and its outside is outside") {
  const engine::Mesh ball = apps::makeBall(1000);
  CHECK(ball.indices.size() / 3 == 12 * 9 * 9);
  double volume = 0;
  std::map<std::tuple<float, float, float>, int> numbers;
  std::map<std::pair<int, int>, int> edges;  // times there less times back
  for (size_t t = 0; t < ball.indices.size(); t += 3) {
    int v[3];
    glm::dvec3 p[3];
    for (size_t k = 0; k < 3; ++k) {
      const glm::vec3& at = ball.positions[ball.indices[t + k]];
      v[k] = numbers.try_emplace({at.x, at.y, at.z}, int(numbers.size())).first->second;
      p[k] = glm::dvec3(at);
    }
    for (int k = 0; k < 3; ++k) {
      const int a = v[k], b = v[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
    volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6;
  }
  CHECK((volume > 3 && volume < 6));
  for (const auto& [edge, sum] : edges) REQUIRE(sum == 0);
}

TEST_CASE("bench: copies of a mesh draw the image that its instances draw") {
  const apps::BenchScene instances = apps::makeField(600000, false, 1.5), copies = apps::makeField(600000, true, 1.5);
  CHECK((instances.meshes.size() == 1 && copies.meshes.size() == 3));
  CHECK(instances.triangles == copies.triangles);
  raster::PlaneSet planes;
  planes.depth = true;
  raster::GBuffer a, b;
  raster::Rasterizer rasterizer;
  rasterizer.render(instances.list(), instances.camera, 60, 40, planes, a);
  rasterizer.render(copies.list(), copies.camera, 60, 40, planes, b);
  int seen = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      REQUIRE(a.depth.at(x, y) == b.depth.at(x, y));
      seen += a.depth.at(x, y) < 100;
    }
  CHECK(seen > 600);
}

TEST_CASE("bench: a value that changes in any plane changes the digest") {
  raster::PlaneSet planes;
  planes.depth = planes.normal = planes.albedo = planes.triangle = true;
  raster::GBuffer g(5, 3, planes);
  const auto clear = [](auto& plane) {
    for (int y = 0; y < 3; ++y) std::fill_n(plane.row(y), 5, 0);
  };
  std::vector<raster::Plane<float>*> floats = {&g.depth};
  for (int c = 0; c < 3; ++c) floats.insert(floats.end(), {&g.normal[c], &g.albedo[c]});
  for (auto* plane : floats) clear(*plane);
  clear(g.triangle);
  std::set<std::string> digests = {apps::digestOf(g, planes)};
  for (auto* plane : floats) {
    plane->at(4, 2) = 1;
    digests.insert(apps::digestOf(g, planes));
    plane->at(4, 2) = 0;
  }
  g.triangle.at(0, 0) = 1;
  digests.insert(apps::digestOf(g, planes));
  CHECK(digests.size() == 9);
}

TEST_CASE("bench: pixels that differ end with exit code 1, what is impossible with 3") {
  CHECK(apps::guarded([] { return 4; }) == 4);
  CHECK(apps::guarded([]() -> int { throw apps::Differs("as the test wants it"); }) == 1);
  CHECK(apps::guarded([]() -> int { throw std::bad_alloc(); }) == 3);
}

TEST_CASE("bench: raster measures every cell size by every instruction set, all with the reference's digest") {
  for (const char* projection : {"perspective", "orthographic"}) {
    const Json out = printedBy({"raster", "--width", "70", "--height", "45", "--frames", "2", "--cell", "1,3,64",
                              "--threads", "2", "--projection", projection});
    CHECK(out["size"] == Json({70, 45}));
    CHECK(out["threads"] == 2);
    std::map<int, std::set<std::string>> targets, digests;
    for (const Json& cell : out["cells"]) {
      targets[cell["cell"]].insert(cell["target"]);
      digests[cell["cell"]].insert(cell["digest"]);
      CHECK(cell["equals_reference"] == true);
      CHECK(cell["frames"] == 2);
      for (const char* figure : {"mtri_per_s", "ns_per_triangle", "ns_per_pixel", "frame_ms"}) CHECK(cell[figure] > 0);
      CHECK(cell["frame_ms_p10"] <= cell["frame_ms"]);
      CHECK(cell["frame_ms"] <= cell["frame_ms_p90"]);
    }
    std::set<std::string> all;
    for (const raster::Target t : raster::supportedTargets()) all.insert(raster::targetName(t));
    CHECK(out["cells"].size() == 3 * all.size());
    for (const int cell : {1, 3, 64}) {
      CHECK(targets[cell] == all);
      CHECK(digests[cell].size() == 1);
    }
  }
}

TEST_CASE("bench: raster prints one row a cell size, and only the target asked for") {
  const Finished f = runProgram({"raster", "--width", "64", "--height", "32", "--frames", "1", "--cell", "2,4",
                                 "--target", raster::targetName(raster::supportedTargets().back())});
  CHECK(f.code == 0);
  CHECK(count(f.out, "Mtri/s") == 1);
  CHECK(count(f.out, " = reference\n") == 2);
  CHECK(f.err.empty());
}

TEST_CASE("bench: scaling sweeps triangles, pixels and threads, and one scene has one digest") {
  const TemporaryFolder folder;
  const Json out = printedBy({"scaling", "--most-triangles", "3e5", "--most-pixels", "250x170", "--size", "64x48",
                            "--seconds", "0.001", "--plot", folder / "plot.gp"});
  const Json& triangles = out["triangles"];
  REQUIRE(triangles.size() == 5);  // 10^3, 10^4, 10^5, 3 10^5, and the last without instances
  CHECK(triangles[4]["unique"] == true);
  CHECK(triangles[4]["triangles"] == triangles[3]["triangles"]);
  CHECK(triangles[4]["digest"] == triangles[3]["digest"]);
  CHECK(triangles[0]["digest"] != triangles[1]["digest"]);
  for (size_t k = 0; k < 4; ++k) {
    const double asked = k == 0 ? 1e3 : k == 1 ? 1e4 : k == 2 ? 1e5 : 4e5;
    CHECK(double(triangles[k]["triangles"]) == Approx(asked).epsilon(0.05));
  }
  REQUIRE(out["pixels"].size() == 2);
  CHECK(out["pixels"][0]["size"] == Json({160, 120}));
  CHECK(out["pixels"][1]["size"] == Json({250, 170}));
  CHECK(out["threads"].size() == std::max(1u, std::thread::hardware_concurrency()));
  for (const Json& cell : out["threads"]) CHECK(cell["digest"] == triangles[3]["digest"]);
  for (const char* sweep : {"triangles", "pixels", "threads"})
    for (const Json& cell : out[sweep]) {
      REQUIRE(!cell.contains("skipped"));
      for (const char* figure : {"drawn", "frame_ms", "ns_per_submitted", "ns_per_drawn", "ns_per_pixel", "peak_mb"})
        CHECK(cell[figure] > 0);
      CHECK(cell["frames"] >= 3);
    }
  const std::string script = contentOf(folder / "plot.gp");
  CHECK(count(script, "set title ") == 4);
  CHECK(count(script, " << EOD\n") == 4 + 2 + 3 + 2);
  CHECK(count(script, " title \"in proportion\"") == 1);
  CHECK(script.find("nan") == script.npos);
}

TEST_CASE("bench: transfer has a line for each number of samples with and without interleaving") {
  const Json out = printedBy({"transfer", "--size", "200x150", "--frames", "2", "--samples", "1,3", "--threads", "2"});
  CHECK(out["size"] == Json({200, 150}));
  REQUIRE(out["cells"].size() == 4);
  std::set<std::string> digests;
  for (size_t k = 0; k < 4; ++k) {
    const Json& cell = out["cells"][k];
    CHECK(cell["samples"] == (k < 2 ? 1 : 3));
    CHECK(cell["interleave"] == (k % 2 == 1));
    for (const char* stage : {"transfer_ms", "filter_ms"}) {
      CHECK(cell[stage] > 0);
      CHECK(cell[std::string(stage) + "_p10"] <= cell[stage]);
      CHECK(cell[stage] <= cell[std::string(stage) + "_p90"]);
    }
    const int empty = cell["pixels_empty"], open = cell["pixels_open"], sampled = cell["pixels_sampled"];
    CHECK(empty + open + sampled == 200 * 150);
    CHECK(open > 200 * 150 / 5);
    digests.insert(cell["digest"]);
  }
  CHECK(digests.size() == 4);
  const Finished table = runProgram({"transfer", "--size", "40x30", "--frames", "1"});
  CHECK(table.code == 0);
  CHECK(count(table.out, " yes ") == 4);
  CHECK(count(table.out, " no ") == 4);
  CHECK(runProgram({"transfer", "/nonexistent.glb"}).code == 3);
}

TEST_CASE("bench: nonsense ends with exit code 2 and a plot that cannot be written with 4") {
  for (const Words& words :
       {Words{}, Words{"nonsense"}, Words{"raster", "--width", "0"}, Words{"raster", "--height", "4097"},
        Words{"raster", "--target", "mmx"}, Words{"raster", "--cell", "0"}, Words{"raster", "--frames", "-3"},
        Words{"raster", "--projection", "fish"}, Words{"scaling", "--most-triangles", "12"},
        Words{"scaling", "--most-pixels", "100"}, Words{"scaling", "--most-pixels", "16385x1"},
        Words{"scaling", "--size", "4x4x4"}, Words{"scaling", "--plot", "plot.jpg"},
        Words{"scaling", "--seconds", "0"}, Words{"transfer", "--samples", "0"},
        Words{"transfer", "--interleave", "on"}})
    checkFails(words, 2);
  const Finished f = runProgram({"scaling", "--most-triangles", "1e3", "--most-pixels", "8x8", "--size", "8x8",
                                 "--seconds", "0.001", "--plot", "/nonexistent/plot.svg"});
  CHECK(f.code == 4);
}

TEST_CASE("bench: llvmpipe draws the same picture, or its absence is said and ends with exit code 3") {
#ifndef OBSCURA_SANITIZED  // the driver is not made for sanitizers
  const obscura::tests::SceneFolder s;
  const std::vector<std::string> words = {"peers", s.scene, "--size", "64x48", "--frames", "2", "--threads", "2"};
  const Finished table = runProgram(words);
  INFO(table.err);
  if (table.code != 0) {
    CHECK(table.code == 3);
    CHECK(table.err.find("no llvmpipe to compare with: ") != table.err.npos);
    CHECK(table.out.empty());
    return;
  }
  for (const char* line : {"G-buffer", "transfer", "filter, light", "frame", "pictures"}) CHECK(table.out.find(line) != table.out.npos);
  const Json out = printedBy(words);
  REQUIRE(out["stages"].size() == 4);
  for (const Json& stage : out["stages"]) CHECK((stage["obscura_ms"] > 0 && stage["peer_ms"] > 0 && stage["ratio"] > 0));
  CHECK(out["difference"]["rms"] < 0.03);  // what a few pixels on edges differ by
  CHECK(std::fabs(double(out["difference"]["mean"])) < 0.003);
#endif
}
