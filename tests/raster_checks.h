// What every frame must satisfy, for the tests of odd geometry and odd numbers. Uses Catch2's assertions.
#pragma once

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>

#include "test_scene.h"

namespace obscura::tests {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

inline raster::GBuffer render(const TestScene& s, const raster::Settings& settings = {},
                              raster::Statistics* statistics = nullptr, const raster::PlaneSet& planes = kAllPlanes) {
  raster::Rasterizer rasterizer(settings);
  raster::GBuffer g;
  rasterizer.render(s.list(), s.camera, s.width, s.height, planes, g);
  if (statistics) *statistics = rasterizer.statistics();
  return g;
}

// Equal to the scalar twins with and without skipping, with the best target and the plainest; and so are depths alone, with
// the layers behind the first.
inline void checkAgainstReference(const TestScene& s) {
  raster::GBuffer expected, depths;
  raster::renderReference(s.list(), s.camera, s.width, s.height, kAllPlanes, expected);
  raster::renderReference(s.list(), s.camera, s.width, s.height, kDepths, depths);
  for (raster::Target target : {raster::supportedTargets().front(), raster::supportedTargets().back()})
    for (bool skip : {true, false}) {
      INFO(raster::targetName(target) << (skip ? "" : ", no skip"));
      REQUIRE(firstDifference(render(s, {1, target, 16, skip}), expected) == "");
      REQUIRE(firstDifference(render(s, {1, target, 16, skip}, nullptr, kDepths), depths) == "");
    }
}

inline void eachPixel(const raster::GBuffer& g, const std::function<void(int, int)>& body) {
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if (g.triangle.at(x, y) != raster::kNoTriangle) body(x, y);
}

// Every number of a covered pixel is one that the next stage can use.
inline void checkUsable(const raster::GBuffer& g, float zNear, float zFar) {
  eachPixel(g, [&](int x, int y) {
    const float z = g.depth.at(x, y);
    bool good = z >= zNear && z <= zFar && std::isfinite(z);
    float length = 0;
    for (int c = 0; c < 3; ++c) {
      good &= g.albedo[c].at(x, y) >= 0 && g.albedo[c].at(x, y) <= 1 && g.emissive[c].at(x, y) >= 0;
      length += g.normal[c].at(x, y) * g.normal[c].at(x, y);
    }
    if (!g.metallic.empty())
      good &= g.metallic.at(x, y) >= 0 && g.metallic.at(x, y) <= 1 && g.roughness.at(x, y) >= 0 && g.roughness.at(x, y) <= 1;
    good &= std::fabs(length - 1) < 1e-5f;
    if (!good)
      FAIL("pixel (" << x << ", " << y << "), triangle " << g.triangle.at(x, y) << ": depth " << z << " in [" << zNear
                     << ", " << zFar << "], |normal|^2 " << length << ", albedo " << g.albedo[0].at(x, y) << " "
                     << g.albedo[1].at(x, y) << " " << g.albedo[2].at(x, y) << ", emissive " << g.emissive[0].at(x, y));
  });
}

inline int covered(const raster::GBuffer& g) {
  int n = 0;
  eachPixel(g, [&](int, int) { ++n; });
  return n;
}

// Triangles of one mesh with the given vertices, three each, seen along -z from the origin.
inline TestScene sceneOf(const std::vector<glm::vec3>& positions, double zNear = 0.01, double zFar = 0) {
  TestScene s;
  s.materials.resize(1);
  s.materials[0].doubleSided = true;
  TestMesh& m = s.addMesh();
  m.positions = positions;
  for (uint32_t i = 0; i < positions.size(); ++i) m.indices.push_back(i);
  s.place(m);
  s.width = 61, s.height = 43;
  s.camera = raster::perspective(1.2, 61.0 / 43, zNear, zFar);
  return s;
}

}  // namespace obscura::tests
