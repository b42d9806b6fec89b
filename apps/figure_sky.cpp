#include "obscura/apps/figure_sky.h"

#include <algorithm>
#include <cmath>

#include "obscura/apps/demo_random.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using glm::dvec3;

// Hills: how high the horizon lies, as the y of a direction, by where it looks to.
double horizonOf(const dvec3& d) {
  const double across = std::sqrt(d.x * d.x + d.z * d.z);
  if (across < 1e-6) return -1;
  const dvec3 around{d.x / across, 0, d.z / across};
  return 0.06 + 0.05 * fractalNoise(around * 2.5, 3, 701);
}

}  // namespace

dvec3 skyRadiance(const dvec3& d) {
  const dvec3 sun = unit({0.62, 0.5, 0.6});
  const double toSun = dot(d, sun);
  const double above = d.y - horizonOf(d);
  dvec3 sky = mix(dvec3(0.80, 0.82, 0.84), dvec3(0.16, 0.33, 0.75), smoothstep(0, 0.6, d.y));
  if (d.y > 0) {  // clouds on a plane high above
    const dvec3 plane = d / (d.y + 0.12);
    const double cloud = smoothstep(0.05, 0.75, fractalNoise({plane.x * 1.1, 0, plane.z * 1.1}, 4, 711)) * smoothstep(0.02, 0.2, d.y);
    sky = mix(sky, dvec3(1.05, 1.03, 1.0), 0.9 * cloud);
  }
  sky += dvec3(1.0, 0.85, 0.6) * (0.5 * smoothstep(0.8, 1.0, toSun) + 150 * smoothstep(0.9975, 0.9988, toSun));
  const double fields = 0.5 + 0.5 * fractalNoise(d / (0.15 + std::fabs(d.y)) * 1.2, 3, 721);
  const dvec3 ground = mix(dvec3(0.16, 0.20, 0.07), dvec3(0.33, 0.26, 0.15), clamp01(fields)) * (0.65 + 0.35 * clamp01(toSun + 0.5));
  return mix(ground, sky, smoothstep(-0.008, 0.008, above));
}

engine::EnvironmentMap makeSky(int height, int threads) {
  raster::Parallel parallel(threads);
  engine::EnvironmentMap map({engine::EnvironmentProjection::Latlong, 2 * height, height});
  parallel.forRanges(size_t(height), 1, [&](size_t begin, size_t end, int) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < 2 * height; ++x) map.at(0, x, y) = glm::vec3(skyRadiance(map.projector().directionAt({0, x + 0.5, y + 0.5})));
  });
  map.fillBorders(parallel);
  return map;
}

std::shared_ptr<const engine::Environment> makeSkyLight(const FigureSettings& settings, engine::EnvironmentParts parts) {
  const int threads = settings.raster.threads;
  raster::Parallel parallel(threads);
  return std::make_shared<const engine::Environment>(engine::environmentOf(makeSky(std::min(512, settings.width), threads), parts, parallel));
}

}  // namespace obscura::apps
