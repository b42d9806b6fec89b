#include "obscura/apps/pictures.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "obscura/engine/plane_image.h"
#include "obscura/engine/stages.h"
#include "obscura/raster/srgb.h"

namespace obscura::apps {
namespace {

using engine::Aov;
using engine::Format;
using engine::Frame;
using engine::Image;
using Plane = raster::Plane<float>;

float clamped(float v) { return v >= 1 ? 1.0f : v > 0 ? v : 0.0f; }  // NaN is 0

uint8_t byteOf(float v) { return uint8_t(clamped(v) * 255.0f + 0.5f); }
uint16_t wordOf(double v) { return uint16_t(v * 65535.0 + 0.5); }

// One channel a plane, value by value.
template <class T, class F>
Image mapped(const Image& planes, Format format, const F& map) {
  Image image(planes.width, planes.height, planes.channels, format);
  const size_t count = size_t(image.width) * size_t(image.height) * size_t(image.channels);
  const float* from = planes.row<float>(0);
  T* to = image.row<T>(0);
  for (size_t i = 0; i < count; ++i) to[i] = map(from[i]);
  return image;
}

Image encoded(const Image& planes, int bits) {
  if (bits == 16) return mapped<uint16_t>(planes, Format::U16, [](float v) { return wordOf(raster::srgbFromLinear(v)); });
  const post::DisplayTable table;  // so that a colour has the same byte here as in the displayed picture
  const float* first = table.threshold + 1;
  return mapped<uint8_t>(planes, Format::U8, [&](float v) {
    return v >= 0 ? uint8_t(std::upper_bound(first, first + 255, v) - first) : uint8_t(0);
  });
}

Image linear(const Image& planes, int bits) {
  if (bits == 16) return mapped<uint16_t>(planes, Format::U16, [](float v) { return wordOf(clamped(v)); });
  return mapped<uint8_t>(planes, Format::U8, byteOf);
}

Image positionPicture(const Frame& frame) {
  const int width = frame.width, height = frame.height;
  Image image(width, height, 3, Format::U8);
  const auto seen = [&](int x, int y) { return frame.g.depth.at(x, y) < std::numeric_limits<float>::infinity(); };
  for (int c = 0; c < 3; ++c) {
    const Plane& p = frame.g.position[c];
    float least = std::numeric_limits<float>::infinity(), greatest = -least;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (seen(x, y)) least = std::min(least, p.at(x, y)), greatest = std::max(greatest, p.at(x, y));
    const double range = double(greatest) - double(least);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (seen(x, y) && range > 0) image.row<uint8_t>(y)[x * 3 + c] = byteOf(float((double(p.at(x, y)) - double(least)) / range));
  }
  return image;
}

Image greyToRgb(const Image& grey) {
  Image rgb(grey.width, grey.height, 3, Format::U8);
  for (size_t i = 0; i < grey.bytes.size(); ++i) std::fill_n(&rgb.bytes[i * 3], 3, grey.bytes[i]);
  return rgb;
}

Image interleaved(const Plane (&p)[3]) { return engine::interleave({&p[0], &p[1], &p[2]}); }

}  // namespace

Image planeImage(const Frame& frame, Aov aov) {
  switch (aov) {
    case Aov::Color: return interleaved(frame.color.rgb);
    case Aov::Depth: return engine::interleave({&frame.g.depth});
    case Aov::Normal: return interleaved(frame.g.normal);
    case Aov::Albedo: return interleaved(frame.g.albedo);
    case Aov::Emissive: return interleaved(frame.g.emissive);
    case Aov::Obscurance: return engine::interleave({&frame.transfer.obscurance});
    case Aov::Transfer: return interleaved(frame.transfer.w);
    case Aov::Position: return interleaved(frame.g.position);
    case Aov::Triangle: return engine::interleave({&frame.g.triangle});
    case Aov::Instance: return engine::interleave({&frame.g.instance});
    case Aov::Material: return engine::interleave({&frame.g.material});
  }
  return {};
}

Image displayPicture(const Frame& frame) {
  Image image(frame.width, frame.height, 3, Format::U8);
  for (int y = 0; y < image.height; ++y) {
    const uint32_t* from = frame.display.rgba.row(y);
    uint8_t* to = image.row<uint8_t>(y);
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) *to++ = uint8_t(from[x] >> (8 * c));
  }
  return image;
}

Image picture(const Frame& frame, Aov aov, int bits) {
  switch (aov) {
    case Aov::Color:
      if (bits == 8) return displayPicture(frame);
      return encoded(planeImage(frame, aov), bits);
    case Aov::Albedo:
    case Aov::Emissive: return encoded(planeImage(frame, aov), bits);
    case Aov::Obscurance:
    case Aov::Transfer: return linear(planeImage(frame, aov), bits);
    case Aov::Normal:
      if (bits == 8) return engine::normalPicture(frame.g.normal[0], frame.g.normal[1], frame.g.normal[2]);
      return mapped<uint16_t>(planeImage(frame, aov), Format::U16,
                              [](float n) { return wordOf(clamped(n * 0.5f + 0.5f)); });
    case Aov::Depth: return engine::depthPicture(frame.g.depth);
    case Aov::Position: return positionPicture(frame);
    case Aov::Triangle: return engine::idPicture(frame.g.triangle);
    case Aov::Instance: return engine::idPicture(frame.g.instance);
    case Aov::Material: return engine::idPicture(frame.g.material);
  }
  return {};
}

Image stagesPicture(const Frame& frame) {
  std::vector<engine::Labelled> tiles;
  tiles.push_back({"depth", picture(frame, Aov::Depth, 8)});
  tiles.push_back({"normal", picture(frame, Aov::Normal, 8)});
  tiles.push_back({"albedo", picture(frame, Aov::Albedo, 8)});
  tiles.push_back({"obscurance O", greyToRgb(picture(frame, Aov::Obscurance, 8))});
  tiles.push_back({"ambient transfer W", picture(frame, Aov::Transfer, 8)});
  tiles.push_back({"result", picture(frame, Aov::Color, 8)});
  return engine::contactSheet(tiles, 3);
}

}  // namespace obscura::apps
