#include "obscura/apps/figure_stage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "obscura/apps/pictures.h"
#include "obscura/engine/camera_choice.h"
#include "obscura/engine/gltf.h"

namespace obscura::apps {
namespace {

using engine::Aov;
using engine::Image;
using raster::Plane;

engine::Scene load(const GlbScene& made) {
  engine::Result<engine::Scene> scene = engine::sceneFromGltf(glbFromScene(made), "a scene of a figure");
  if (!scene) throw FigureError(scene.error().text());
  return std::move(*scene);
}

// Calls body(value) for the pixels that pass, row by row.
template <class Body>
size_t forPixels(const Plane<float>& plane, const PixelTest& test, const Body& body) {
  size_t count = 0;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x)
      if (test(x, y)) body(x, y), ++count;
  return count;
}

}  // namespace

FigureStage::FigureStage(const GlbScene& made, const FigureSettings& figure, double radius)
    : scene_(load(made)), renderer_(figure.raster) {
  settings.width = figure.width;
  settings.height = figure.height;
  const engine::Result<raster::Camera> camera = engine::chooseCamera(scene_, {}, figure.width, figure.height);
  if (!camera) throw FigureError(camera.error().text());
  settings.camera = *camera;
  settings.brdf = post::Brdf::Lambert;  // as in the papers
  settings.transfer.radius = float(radius);
  settings.transfer.bias = float(engine::kDefaultBias * radius);
  settings.transfer.filterThreshold = float(engine::kDefaultFilterThreshold * radius);
  settings.aovs = {Aov::Color, Aov::Depth, Aov::Normal, Aov::Albedo, Aov::Obscurance, Aov::Transfer, Aov::Instance};
  settings.display = true;
}

engine::Frame FigureStage::render(const engine::FrameSettings& frame) const {
  engine::Frame out;
  if (const auto done = renderer_.render(scene_, frame, out); !done) throw FigureError(done.error().text());
  return out;
}

Image colorPicture(const engine::Frame& frame) { return picture(frame, Aov::Color, 8); }
Image obscurancePicture(const engine::Frame& frame) { return greyPicture(frame.transfer.obscurance); }
Image transferPicture(const engine::Frame& frame) { return picture(frame, Aov::Transfer, 8); }

Image greyPicture(const Plane<float>& plane, float white) {
  Image out(plane.width(), plane.height(), 3, engine::Format::U8);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      std::fill_n(out.row<uint8_t>(y) + 3 * x, 3, uint8_t(std::clamp(plane.at(x, y) / white, 0.0f, 1.0f) * 255 + 0.5f));
  return out;
}

double meanOf(const Plane<float>& plane, const PixelTest& test) {
  double sum = 0;
  const size_t count = forPixels(plane, test, [&](int x, int y) { sum += double(plane.at(x, y)); });
  return count > 0 ? sum / double(count) : 0;
}

double deviationOf(const Plane<float>& plane, const PixelTest& test) {
  const double mean = meanOf(plane, test);
  double sum = 0;
  const size_t count = forPixels(plane, test, [&](int x, int y) { sum += (double(plane.at(x, y)) - mean) * (double(plane.at(x, y)) - mean); });
  return count > 0 ? std::sqrt(sum / double(count)) : 0;
}

double rmseOf(const Plane<float>& a, const Plane<float>& b, const PixelTest& test) {
  double sum = 0;
  const size_t count = forPixels(a, test, [&](int x, int y) {
    const double d = double(a.at(x, y)) - double(b.at(x, y));
    sum += d * d;
  });
  return count > 0 ? std::sqrt(sum / double(count)) : 0;
}

double leastOf(const Plane<float>& plane, const PixelTest& test) {
  double least = std::numeric_limits<double>::infinity();
  const size_t count = forPixels(plane, test, [&](int x, int y) { least = std::min(least, double(plane.at(x, y))); });
  return count > 0 ? least : 0;
}

double largestOf(const Plane<float>& plane, const PixelTest& test) {
  double largest = 0;
  forPixels(plane, test, [&](int x, int y) { largest = std::max(largest, double(plane.at(x, y))); });
  return largest;
}

double localContrastOf(const Plane<float>& plane, const PixelTest& test) {
  double sum = 0;
  const auto both = [&](int x, int y) { return x > 0 && test(x, y) && test(x - 1, y); };
  const size_t count = forPixels(plane, both, [&](int x, int y) { sum += std::fabs(double(plane.at(x, y)) - double(plane.at(x - 1, y))); });
  const double mean = meanOf(plane, test);
  return count > 0 && mean > 0 ? sum / double(count) / mean : 0;
}

double share(const Plane<float>& plane, const PixelTest& test) {
  const size_t count = forPixels(plane, test, [](int, int) {});
  return double(count) / (double(plane.width()) * plane.height());
}

PixelTest isSeen(const engine::Frame& frame) {
  return [&frame](int x, int y) { return frame.g.depth.at(x, y) < std::numeric_limits<float>::infinity(); };
}

PixelTest isNode(const engine::Frame& frame, const engine::Scene& scene, const std::string& name) {
  return [&frame, &scene, name](int x, int y) {
    const uint32_t i = frame.g.instance.at(x, y);
    return i < scene.instances.size() && scene.nodeNames[scene.instances[i].node] == name;
  };
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace obscura::apps
