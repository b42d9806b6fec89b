#include "obscura/apps/error_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "obscura/apps/ray_scene.h"
#include "obscura/apps/sobol.h"
#include "obscura/post/depth_filter.h"
#include "obscura/post/transfer_samples.h"
#include "obscura/raster/parallel.h"

namespace obscura::apps {
namespace {

using raster::Plane;

constexpr double kStartOffset = 0.002;  // of R, along the normal
constexpr double kSameSurface = 0.1;    // of R: how far a point of what a texel shows may lie from its depth

struct Start {
  glm::dvec3 position{0}, normal{0};  // camera space, z towards the eye
  uint32_t seed = 0;                  // of the pixel
};

class Steps {
 public:
  Steps(const engine::Scene& scene, const ResolvedFrame& resolved, const engine::Frame& frame, int rays)
      : settings_(resolved.frame), frame_(frame), rays_(rays), threads_(resolved.raster.threads),
        parallel_(resolved.raster.threads),
        projector_(post::makeProjector(settings_.camera, frame.imageWidth, frame.imageHeight)),
        surface_(scene, settings_.camera), starts_(scene, surface_, settings_, frame) {}

  // From the G-buffer's point.
  Plane<float> traced() const {
    const RayScene scene(surface_, threads_);
    return ofPixels([&](const Start& s, int, int) {
      return openOf(scene, s, s.position + s.normal * (kStartOffset * radius()), glm::dvec3(0));
    });
  }

  // From the triangle's, about its own normal or that of the G-buffer.
  Plane<float> tracedFromTriangle(bool ownNormal) const {
    const RayScene scene(surface_, threads_);
    return ofPixels([&](Start s, int x, int y) {
      const TruthStart at = starts_.at(x, y);
      if (ownNormal) s.normal = at.outside;
      return openOf(scene, s, at.position, at.outside);
    });
  }

  // A test point is inside where a ray from it to the eye meets, as the first thing, the inner side of a triangle; with
  // firstLayer it must be what the depth map shows there, too.
  Plane<float> inSolids(const RayKeep* keep, bool firstLayer) const {
    const RayScene scene(surface_, threads_, keep);
    return ofPixels([&](const Start& s, int, int) {
      int outside = 0;
      RayBatch batch;
      for (int first = 0; first < rays_; first += RayBatch::kSize) {
        batch.count = std::min(RayBatch::kSize, rays_ - first);
        for (int i = 0; i < batch.count; ++i) {
          const glm::dvec3 p = testPoint(s, first + i), toEye = projector_.perspective ? -p : glm::dvec3(0, 0, -p.z);
          const double distance = glm::length(toEye);
          for (int c = 0; c < 3; ++c) batch.origin[c][i] = float(p[c]), batch.direction[c][i] = float(toEye[c] / distance);
          batch.reach[i] = float(distance);
        }
        scene.intersect(batch);
        for (int i = 0; i < batch.count; ++i) outside += batch.instance[i] == RayBatch::kMiss || !leaves(batch, i) || (firstLayer && !meetsDepthMap(batch, i));
      }
      return double(outside) / rays_;
    });
  }

  // Everything that the depth map shows is R deep.
  Plane<float> inDepthMap() const {
    const double deepest = settings_.transfer.silhouetteBound ? radius() : std::numeric_limits<double>::infinity();
    return ofPixels([&](const Start& s, int, int) {
      int outside = 0;
      for (int i = 0; i < kErrorTests; ++i) {
        const glm::dvec3 p = testPoint(s, i);
        const double behind = -p.z - depthAt(p);
        outside += !(-p.z > double(projector_.zNear) && behind > settings_.transfer.bias && behind < deepest);
      }
      return double(outside) / kErrorTests;
    });
  }

  Plane<float> filtered(const Plane<float>& value) const {
    post::AmbientSettings transfer = settings_.transfer;
    transfer.samples = 1;  // the sums are means already
    post::TransferInput in{&frame_.g, projector_, transfer, {}, nullptr};
    in.settings.albedo = post::TransferAlbedo::Own;
    post::TransferSums sums = post::makeTransferSums(in);
    for (int y = 0; y < frame_.height; ++y) {
      std::copy_n(value.row(y), frame_.width, sums.numerator.row(y));
      std::fill_n(sums.open.row(y), sums.open.width(), uint8_t(0));
    }
    post::Transfer out = post::makeTransfer(frame_.width, frame_.height, {true}, {});
    post::depthFilterRef(in, sums, 0, frame_.height, out);
    return std::move(out.obscurance);
  }

  RayKeep insideOfImage() const {
    RayKeep out(surface_.instances());
    for (size_t i = 0; i < out.size(); ++i) {
      out[i].resize(surface_.indices(i).size() / 3);
      for (size_t t = 0; t < out[i].size(); ++t) out[i][t] = mayBeInImage(uint32_t(i), uint32_t(t));
    }
    return out;
  }

  double change(const Plane<float>& a, const Plane<float>& b) const {
    double sum = 0, n = 0;
    for (int y = 0; y < frame_.height; ++y)
      for (int x = 0; x < frame_.width; ++x)
        if (isSeen(x, y)) sum += std::pow(double(a.at(x, y)) - double(b.at(x, y)), 2), ++n;
    return std::sqrt(sum / std::max(n, 1.0));
  }

 private:
  double radius() const { return settings_.transfer.radius; }
  bool isSeen(int x, int y) const { return frame_.g.instance.at(x, y) != raster::kNoTriangle; }
  double openAt(double d) const { return post::membershipOf(settings_.transfer.membership, d); }
  glm::dvec3 direction(const Start& s, int i) const { return cosineDirection(s.normal, sobolPoint(uint32_t(i), s.seed)); }

  // O by rays from `from`; directions that lead to the other side of `outside` are blocked at once, if it is not 0.
  double openOf(const RayScene& scene, const Start& s, const glm::dvec3& from, const glm::dvec3& outside) const {
    double sum = 0;
    RayBatch batch;
    for (int first = 0; first < rays_; first += RayBatch::kSize) {
      batch.count = std::min(RayBatch::kSize, rays_ - first);
      for (int i = 0; i < batch.count; ++i) {
        const glm::dvec3 d = direction(s, first + i);
        for (int c = 0; c < 3; ++c) batch.origin[c][i] = float(from[c]), batch.direction[c][i] = float(d[c]);
        batch.reach[i] = glm::dot(d, outside) < 0 ? -1 : float(radius());
      }
      scene.intersect(batch);
      for (int i = 0; i < batch.count; ++i)
        if (batch.reach[i] >= 0) sum += batch.instance[i] == RayBatch::kMiss ? 1 : openAt(double(batch.reach[i]) / radius());
    }
    return sum / rays_;
  }

  Start startAt(int x, int y) const {
    Start s;
    const double depth = frame_.g.depth.at(x, y), w = projector_.perspective ? depth : 1;
    s.position = {(x + 0.5 - projector_.xCenter) * projector_.xInverse * w, (y + 0.5 - projector_.yCenter) * projector_.yInverse * w, -depth};
    for (int c = 0; c < 3; ++c) s.normal[c] = frame_.g.normal[c].at(x, y);
    s.seed = hashed(uint32_t(x), uint32_t(y));
    return s;
  }

  // Not all corners lie beyond the same side of the image or the near plane.
  bool mayBeInImage(uint32_t instance, uint32_t triangle) const {
    glm::dvec3 corner[3];
    surface_.corners(instance, triangle, corner);
    int beyond = ~0;
    for (const glm::dvec3& p : corner) {
      const double w = projector_.perspective ? -p.z : 1;
      const double x = p.x * projector_.xScale + projector_.xCenter * w, y = p.y * projector_.yScale + projector_.yCenter * w;
      beyond &= (x < 0) | (x > frame_.imageWidth * w) << 1 | (y < 0) << 2 | (y > frame_.imageHeight * w) << 3 |
                (-p.z < double(projector_.zNear)) << 4;
    }
    return beyond == 0;
  }

  glm::dvec3 testPoint(const Start& s, int i) const {
    const double xi = sobolPoint(uint32_t(i), hashed(s.seed, 1)).x;
    return s.position + direction(s, i) * (post::inverseMembership(settings_.transfer.membership, xi) * radius());
  }

  // Of the depth map's nearest texel.
  double depthAt(const glm::dvec3& p) const {
    const double w = projector_.perspective ? -p.z : 1;
    const double u = p.x / w * projector_.xScale + projector_.xCenter, v = p.y / w * projector_.yScale + projector_.yCenter;
    return frame_.g.depth.at(int(std::clamp(u, 0.0, frame_.width - 1.0)), int(std::clamp(v, 0.0, frame_.height - 1.0)));
  }

  // The ray leaves what it meets, farther than the bias away.
  bool leaves(const RayBatch& rays, int i) const {
    const glm::dvec3 outside = surface_.outside(rays.instance[i], rays.triangle[i]);
    const double along = outside.x * rays.direction[0][i] + outside.y * rays.direction[1][i] + outside.z * rays.direction[2][i];
    return along > 0 && rays.reach[i] > settings_.transfer.bias;
  }

  bool meetsDepthMap(const RayBatch& rays, int i) const {
    glm::dvec3 p;
    for (int c = 0; c < 3; ++c) p[c] = rays.origin[c][i] + double(rays.reach[i]) * rays.direction[c][i];
    return std::fabs(-p.z - depthAt(p)) < kSameSurface * radius();
  }

  template <class F>
  Plane<float> ofPixels(const F& value) const {
    Plane<float> out(frame_.width, frame_.height);
    parallel_.forRanges(size_t(frame_.height), 1, [&](size_t begin, size_t end, int) {
      for (int y = int(begin); y < int(end); ++y)
        for (int x = 0; x < frame_.width; ++x) out.at(x, y) = isSeen(x, y) ? float(value(startAt(x, y), x, y)) : 1.0f;
    });
    return out;
  }

  const engine::FrameSettings& settings_;
  const engine::Frame& frame_;
  int rays_, threads_;
  mutable raster::Parallel parallel_;
  post::Projector projector_;
  RaySurface surface_;
  TruthStarts starts_;
};

}  // namespace

std::vector<ErrorStep> errorSteps(const engine::Scene& scene, const ResolvedFrame& resolved, const engine::Frame& frame,
                                  const Plane<float>& truth, Plane<float> estimate, int rays,
                                  const std::function<void(double)>& done) {
  const Steps steps(scene, resolved, frame, rays);
  std::vector<ErrorStep> out;
  const auto add = [&](const char* name, const char* what, Plane<float> value) {
    const double change = steps.change(value, out.empty() ? truth : out.back().value);
    out.push_back({name, what, std::move(value), change, {}});
    done(double(out.size()) / kErrorSteps);
  };
  Plane<float> exact(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y) std::copy_n(truth.row(y), frame.width, exact.row(y));
  add("normals", "the G-buffer's normal says where the surface faces, as for the truth", std::move(exact));
  out.back().change = steps.change(steps.tracedFromTriangle(false), steps.tracedFromTriangle(true));
  add("surface", "rays start at the G-buffer's point, about its normal", steps.traced());
  add("containment", "one test point a ray, in solids, instead of the first surface on it", steps.inSolids(nullptr, false));
  const RayKeep keep = steps.insideOfImage();
  add("off-screen", "what lies outside of the image is not there", steps.inSolids(&keep, false));
  add("hidden", "what the depth map does not show is not there", steps.inSolids(&keep, true));
  add("thickness", "everything is R deep", steps.inDepthMap());
  add("filter", "the mean over the filter's window", steps.filtered(out.back().value));
  add("sampling", "n samples", std::move(estimate));

  Plane<uint8_t> seen(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) seen.at(x, y) = frame.g.instance.at(x, y) != raster::kNoTriangle;
  raster::Parallel parallel(resolved.raster.threads);
  const ErrorMeter meter({&truth}, seen, parallel);
  for (ErrorStep& s : out) s.error = meter.measure({&s.value});
  return out;
}

}  // namespace obscura::apps
