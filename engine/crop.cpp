#include "obscura/engine/crop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/raster/view.h"

namespace obscura::engine {
namespace {

using raster::Window;

std::string textOf(const Window& w) {
  return std::to_string(w.x) + "," + std::to_string(w.y) + "," + std::to_string(w.width) + "x" + std::to_string(w.height);
}

// `before` pixels more on the left and above, `after` on the right and below, as far as `whole` has them.
Window grown(const Window& w, int xBefore, int yBefore, int xAfter, int yAfter, const Window& whole) {
  const int x0 = std::max(w.x - xBefore, whole.x), x1 = std::min(w.x + w.width + xAfter, whole.x + whole.width);
  const int y0 = std::max(w.y - yBefore, whole.y), y1 = std::min(w.y + w.height + yAfter, whole.y + whole.height);
  return {x0, y0, x1 - x0, y1 - y0};
}

// How many pixels, along one axis, a test point may be projected away from the pixel that it is a sample of. With
// c = (a z, ., z) the pixel's point, s pixels per unit at z = 1, and c + d the test point, |d| <= R, that is
//     s |(a z + d.x) / (z + d.z) - a| = s |d.x - a d.z| / (z + d.z) <= s R sqrt(1 + a^2) / max(z - R, zNear):
// points nearer than zNear count as outside wherever they are projected. Orthographic: s R. What float arithmetic may
// add is far less than what is added here.
int reach(const post::Projector& p, double scale, double center, int first, int size, double radius, double nearest) {
  constexpr double kEverywhere = 2 * raster::kMaxImageSize;
  const double offCenter = std::max(std::fabs(first - center), std::fabs(first + size - center));
  const double a = offCenter / scale, r = radius * 1.001;
  double pixels = scale * r;
  if (p.perspective) pixels *= std::sqrt(1 + a * a) / std::max(nearest * 0.99999 - r, double(p.zNear) * 0.99999);
  pixels += 2 + 1e-5 * (std::fabs(center) + offCenter);
  return pixels < kEverywhere ? int(std::ceil(pixels)) : int(kEverywhere);  // NaN is everywhere, too
}

}  // namespace

std::string wrongCrop(const FrameSettings& s) {
  const std::string image = "the image of " + std::to_string(s.width) + "x" + std::to_string(s.height) + " pixels";
  if (std::min(s.width, s.height) < 1 || std::max(s.width, s.height) > raster::kMaxImageSize)
    return image + " does not have 1 to " + std::to_string(raster::kMaxImageSize) + " a side";
  if (s.border < 0 || s.border > (raster::kMaxImageSize - std::max(s.width, s.height)) / 2)
    return "a border of " + std::to_string(s.border) + " pixels: it must be 0 or more, and with " + image + " at most " +
           std::to_string(raster::kMaxImageSize) + " a side";
  if (!s.crop) return "";
  const Window& c = *s.crop;
  const bool inside = c.x >= 0 && c.y >= 0 && c.width > 0 && c.height > 0 && c.width <= s.width && c.height <= s.height &&
                      c.x <= s.width - c.width && c.y <= s.height - c.height;
  return inside ? "" : "the crop " + textOf(c) + " does not lie in " + image;
}

Window outputWindow(const FrameSettings& s) { return s.crop.value_or(Window{0, 0, s.width, s.height}); }

Window wholeWindow(const FrameSettings& s) {
  return {-s.border, -s.border, s.width + 2 * s.border, s.height + 2 * s.border};
}

Window filteredWindow(const FrameSettings& s) {
  const Window w = outputWindow(s);
  return s.transfer.filter ? grown(w, 2, 2, 1, 1, wholeWindow(s)) : w;  // see depthFilter
}

Window transferWindow(const FrameSettings& s, float nearest) {
  const Window w = filteredWindow(s);
  if (!(nearest < std::numeric_limits<float>::infinity())) return w;  // nothing is seen, so nothing is sampled
  const post::Projector p = post::makeProjector(s.camera, s.width, s.height);
  const int x = reach(p, std::fabs(double(p.xScale)), p.xCenter, w.x, w.width, s.transfer.radius, nearest);
  const int y = reach(p, std::fabs(double(p.yScale)), p.yCenter, w.y, w.height, s.transfer.radius, nearest);
  return grown(w, x, y, x, y, wholeWindow(s));
}

float nearestDepth(const raster::Plane<float>& depth) {
  float nearest = std::numeric_limits<float>::infinity();
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) nearest = std::min(nearest, depth.at(x, y));
  return nearest;
}

void cutOut(const post::Transfer& from, const Window& part, post::Transfer& to) {
  raster::cutOut(from.obscurance, part, to.obscurance);
  for (int c = 0; c < 3; ++c) raster::cutOut(from.w[c], part, to.w[c]), raster::cutOut(from.bounced[c], part, to.bounced[c]);
}

}  // namespace obscura::engine
