#include "obscura/post/ray_march.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "obscura/raster/float_environment.h"

namespace obscura::post {

std::vector<RayMarch> rayMarches(const AmbientSettings& settings, const std::vector<glm::vec3>& offsets) {
  const raster::FloatEnvironment environment;
  const float endless = std::numeric_limits<float>::infinity(), base = kShell * settings.radius;
  std::vector<RayMarch> out;
  out.reserve(offsets.size());
  for (const glm::vec3& o : offsets) {
    const uint32_t turn = uint32_t(out.size()) * 2654435769u;  // 2^32 times the golden section
    const float u = float(turn >> 8) * 0x1p-24f, soft = 1 + kShellSpread * (2 * u - 1);
    const float gap = std::sqrt(o.x * o.x + o.y * o.y + o.z * o.z) / float(settings.steps);
    RayMarch march{kEarly * (1 - u), endless, endless};
    if (settings.silhouetteBound) march.shell = (base + kShellOfGap * gap) * soft, march.shell2 = base * soft;
    out.push_back(march);
  }
  return out;
}

}  // namespace obscura::post
