// In:  a scene and the G-buffer of a frame of it.
// Out: per pixel what the estimators aim at, by tracing rays: obscurances, ambient occlusion, the exact ambient transfer.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "obscura/apps/ray_scene.h"
#include "obscura/engine/frame.h"
#include "obscura/post/settings.h"

namespace obscura::apps {

struct TruthSettings {
  float radius = 0.5f;                                          // R, scene units
  post::Membership membership = post::Membership::Linear;      // of the ambient transfer
  int rays = 256;                                               // a pixel, a multiple of kTruthScrambles
  int threads = 0;                                              // 0: one per core; changes no bit
};

constexpr int kTruthScrambles = 8;      // independent estimates of each value, whose spread is the standard error
constexpr int kTruthHits = 256;         // of a path; what is left of its light then counts with W = 1, as in a closed white room
constexpr double kTruthOffset = 0x1p-20;  // see TruthStart

enum class TruthQuantity : uint8_t {
  Classic, Linear, Sqrt, Exponential,  // O for each membership, long paper, equation 3; Classic is ambient occlusion within R
  TangentSphere,                       // what of the sphere of radius R/2 that touches the surface is in sight of the point
  Ball,                                // what of the half ball of radius R over the surface is in sight of the point
  Horizon,                             // mean of min(d / R, 1)^2 over the half sphere, without the cosine
  TransferR, TransferG, TransferB,     // W, equation 4, with the albedo at each hit
  BounceR, BounceG, BounceB,           // B = (1 / pi) int (1 - mu) a(y) cos, y what is hit first (long paper, equation 6)
  // Of an environment, see environment_truth.h.
  OpenR, OpenG, OpenB, ShadowedR, ShadowedG, ShadowedB, ObscuredR, ObscuredG, ObscuredB, LitR, LitG, LitB
};
constexpr int kTruthQuantities = 13;        // without an environment: up to B
constexpr int kEnvironmentQuantities = 12;  // from Open on

// One plane per quantity, the first ones or all: the mean of the scrambles and its standard error. Empty pixels hold what open
// ones do: 1, of B 0; of an environment's light 0; and no error.
struct Truth {
  std::vector<raster::Plane<float>> value, error;

  Truth() = default;
  Truth(int width, int height, int quantities = kTruthQuantities);
  bool hasEnvironment() const { return value.size() > size_t(kTruthQuantities); }
  const raster::Plane<float>& operator[](TruthQuantity q) const { return value[size_t(q)]; }
};

// The planes of the G-buffer that the truth is of.
const std::vector<engine::Aov>& truthAovs();

// Where the rays of a pixel begin: the point of the triangle seen there (by its id, in double: the depth map's point is off
// by what snapping to 1/256 pixel costs), moved by kTruthOffset times the largest coordinate of point and corners, about 16
// roundings, out of it, so that no ray meets where it starts, and by as much to the triangle's middle, so that a point on
// the edge of a corner is not behind the corner's other side. The cosine is that of the G-buffer's normal. Directions below the triangle itself, which a
// normal that is not the triangle's has, are blocked at distance 0 by this very point.
struct TruthStart {
  glm::dvec3 position{0}, normal{0}, outside{0};  // camera space; the normals are unit, `outside` is the triangle's
  glm::vec3 albedo{0};
};

// Of a pixel of the frame in which something is seen.
class TruthStarts {
 public:
  // The frame needs truthAovs(), no supersampling; all must outlive this.
  TruthStarts(const engine::Scene& scene, const RaySurface& surface, const engine::FrameSettings& settings,
              const engine::Frame& frame);
  bool seen(int x, int y) const { return frame_.g.instance.at(x, y) != raster::kNoTriangle; }
  TruthStart at(int x, int y) const;
  uint32_t seed(int x, int y) const;  // of the pixel in the image, so that a crop has the values of the whole

 private:
  const RaySurface& surface_;
  const engine::Frame& frame_;
  raster::Camera camera_;
  std::vector<uint32_t> firstTriangle_;  // of each instance
};

// A path that has hit something goes on from there: out of the triangle, on the side that it came from.
TruthStart startAtHit(const RaySurface& surface, const TrianglePoint& p, const glm::dvec3& direction);

// A cosine-distributed direction about n for a point of the unit square, and one evenly spread over the half sphere.
glm::dvec3 cosineDirection(const glm::dvec3& n, const glm::dvec2& xi);
glm::dvec3 evenDirection(const glm::dvec3& n, const glm::dvec2& xi);

// done(rows) is told of finished rows, from any thread. Throws std::bad_alloc.
Truth traceTruth(const RaySurface& surface, const RayScene& rays, const TruthStarts& starts, int width, int height,
                 const TruthSettings& settings, const std::function<void(int)>& done);

}  // namespace obscura::apps
