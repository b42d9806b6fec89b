// In:  a scene, the G-buffer of a frame of it, the truth of its O.
// Out: O again and again, on the way from the truth to the estimator, where each step gives up one more exact ingredient.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "obscura/apps/error_measures.h"
#include "obscura/apps/frame_options.h"
#include "obscura/apps/truth.h"

namespace obscura::apps {

// Steps, each with all that the earlier ones gave up:
//   normals      the G-buffer's normal, interpolated and mapped, says where the surface faces, instead of the triangle. The truth
//                takes it from there, too: it is what is found here, so that it has no error, and the change is that of O by as many
//                rays as the next steps have
//   surface      rays start where depth map and normal say, not on the triangle, and directions below it are traced, too
//   containment  one test point a ray at mu^-1(xi), inside of a solid or not, instead of what the ray meets first (long paper,
//                equation 8). Exactly: solids are what triangles enclose by their winding, whether it is seen or not
//   off-screen   what lies outside of the image is not there
//   hidden       nor is a solid whose outer side the depth map does not show where the test point projects
//   thickness    everything that the depth map shows is R deep (or endless, without the silhouette bound), closed or not
//   filter       the mean over the filter's window instead of the pixel's own value
//   sampling     the estimator itself, with its n samples, m steps and layers
constexpr int kErrorSteps = 8;
constexpr int kErrorTests = 256;  // of a pixel, against the depth map

struct ErrorStep {
  std::string name, what;
  raster::Plane<float> value;  // O; 1 where empty
  double change = 0;           // root mean square of the difference to the step before, over what is seen
  ErrorMeasures error;         // against the truth
};

// The frame has truthAovs() and is neither cropped nor supersampled; `estimate` is the estimator's O of it. rays: of a pixel, for
// the first five steps. done(part) is told from 0 to 1. The result does not depend on the number of threads.
std::vector<ErrorStep> errorSteps(const engine::Scene& scene, const ResolvedFrame& resolved, const engine::Frame& frame,
                                  const raster::Plane<float>& truth, raster::Plane<float> estimate, int rays,
                                  const std::function<void(double)>& done);

}  // namespace obscura::apps
