// In:  a made scene, settings of frames.
// Out: frames, pictures of them, and numbers.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "obscura/apps/figure.h"
#include "obscura/apps/glb_writer.h"
#include "obscura/engine/frame.h"
#include "obscura/engine/image.h"

namespace obscura::apps {

struct FigureError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A scene that is drawn more than once, from its own camera.
class FigureStage {
 public:
  FigureStage(const GlbScene& made, const FigureSettings& settings, double radius);

  // White light from everywhere, W with the neighbours' albedo, R = radius and what follows from it as by default, n = 8,
  // linear membership.
  engine::FrameSettings settings;
  const engine::Scene& scene() const { return scene_; }
  engine::Scene& scene() { return scene_; }

  // With depth, normals, albedo, O, W, instances, colour and its display.
  engine::Frame render(const engine::FrameSettings& frame) const;

 private:
  engine::Scene scene_;
  mutable engine::Renderer renderer_;
};

// The colour as displayed, O and W (1 is white).
engine::Image colorPicture(const engine::Frame& frame);
engine::Image obscurancePicture(const engine::Frame& frame);
engine::Image transferPicture(const engine::Frame& frame);
// Planes of 0 ... 1 as grey; what lies beyond is clamped.
engine::Image greyPicture(const raster::Plane<float>& plane, float white = 1);

using PixelTest = std::function<bool(int x, int y)>;

// Of the pixels that pass; 0 without any.
double meanOf(const raster::Plane<float>& plane, const PixelTest& test);
double deviationOf(const raster::Plane<float>& plane, const PixelTest& test);  // standard deviation
double rmseOf(const raster::Plane<float>& a, const raster::Plane<float>& b, const PixelTest& test);
double leastOf(const raster::Plane<float>& plane, const PixelTest& test);
double largestOf(const raster::Plane<float>& plane, const PixelTest& test);
// Mean step between neighbours in a row that both pass, over the mean: how much detail there is.
double localContrastOf(const raster::Plane<float>& plane, const PixelTest& test);
double share(const raster::Plane<float>& plane, const PixelTest& test);  // of all pixels

// Where something is seen; where it is this node's mesh.
PixelTest isSeen(const engine::Frame& frame);
PixelTest isNode(const engine::Frame& frame, const engine::Scene& scene, const std::string& name);

std::string number(double value);  // four digits

}  // namespace obscura::apps
