// In:  an environment map in one projection.
// Out: its radiance in any direction, and so any other projection of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <glm/vec3.hpp>

#include "obscura/engine/environment_projection.h"
#include "obscura/engine/image.h"
#include "obscura/engine/large_vector.h"
#include "obscura/engine/result.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/span.h"

namespace obscura::engine {

// Linear radiance, >= 0 and at most kMostRadiance. Around each panel lies a border of one texel that continues it, and so do
// the corners of panels that show a circle: lookUp() interpolates in one panel and knows no seams.
class EnvironmentMap {
 public:
  static constexpr float kMostRadiance = 1e30f;

  EnvironmentMap() = default;
  explicit EnvironmentMap(const EnvironmentProjector& projector);  // black; throws std::bad_alloc

  const EnvironmentProjector& projector() const { return projector_; }

  // Panel by panel, row by row, with the border; of a cube as post::EnvironmentChain has them.
  raster::Span<const glm::vec3> texels() const { return {texels_.data(), texels_.size()}; }
  LargeVector<glm::vec3> taken() && { return std::move(texels_); }  // the same

  // Texels from -1 to width and height: the border counts.
  const glm::vec3& at(int panel, int x, int y) const { return texels_[index(panel, x, y)]; }
  glm::vec3& at(int panel, int x, int y) { return texels_[index(panel, x, y)]; }

  // After the texels that the projector shows have been set: all others.
  //   latlong     columns wrap; beyond a pole what makes its value the mean of the row there, whatever the longitude
  //   cube        the nearest texel of the neighbouring face; at the corners the mean of three
  //   paraboloid  from the other half, interpolated between what that shows
  //   sphere      the mean of the outermost ring, which is also what lookUp() tends to at -z
  void fillBorders(raster::Parallel& parallel);

  // Bilinear, continuous over the whole sphere but for what is said of paraboloids: over their rim it may jump by as much as
  // the interpolation errs there. Any length but 0.
  glm::dvec3 lookUp(const glm::dvec3& direction) const;

 private:
  size_t index(int panel, int x, int y) const {
    return (size_t(panel) * size_t(projector_.height + 2) + size_t(y + 1)) * size_t(projector_.width + 2) + size_t(x + 1);
  }
  glm::dvec3 bilinear(const PanelPoint& p, bool shownOnly) const;
  glm::dvec3 ringOfSphere() const;
  void fillPoles();
  void fillCubeCorners();

  EnvironmentProjector projector_;
  LargeVector<glm::vec3> texels_;
};

// Each texel is the mean of as many points of `from` as that is finer (at most 16 x 16): 1 at about equal sizes.
EnvironmentMap convertEnvironment(const EnvironmentMap& from, const EnvironmentProjector& to, raster::Parallel& parallel);

// Over the sphere, by the texels of `a` and their solid angles.
struct EnvironmentDifference {
  double rmse = 0;      // root mean square over texels and channels
  double relative = 0;  // that over the root mean square of a; 0 where a is black
  double largest = 0;   // of any texel and channel
  double clamped = 0;   // root mean square with values above 1 taken as 1: what a display would show of it
};
EnvironmentDifference compareEnvironments(const EnvironmentMap& a, const EnvironmentMap& b, raster::Parallel& parallel);

// From and to an image of the projector's layout; F32 RGB, black where nothing is shown.
Image imageOfEnvironment(const EnvironmentMap& map);

struct EnvironmentFile {
  EnvironmentMap map;
  size_t clamped = 0;  // channels of texels that were negative, NaN or beyond kMostRadiance, and are now 0 or that
};

// Reads any image file: floats are linear radiance, integers sRGB (8 and 16 bits), grey is replicated, alpha is ignored.
// BadInput: no image, or none of a size that a map of this projection has.
Result<EnvironmentFile> readEnvironmentMap(const std::string& path, EnvironmentProjection projection, raster::Parallel& parallel);

// The same from its bytes; `name` is that of error messages.
Result<EnvironmentFile> decodeEnvironmentMap(raster::Span<const uint8_t> file, const std::string& name, EnvironmentProjection projection,
                                             raster::Parallel& parallel);

}  // namespace obscura::engine
