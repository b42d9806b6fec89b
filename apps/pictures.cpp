#include "obscura/apps/pictures.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>
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
        if (seen(x, y) && range > 0)
          image.row<uint8_t>(y)[x * 3 + c] = byteOf(float((double(p.at(x, y)) - double(least)) / range));
  }
  return image;
}

Image greyToRgb(const Image& grey) {
  Image rgb(grey.width, grey.height, 3, Format::U8);
  for (size_t i = 0; i < grey.bytes.size(); ++i) std::fill_n(&rgb.bytes[i * 3], 3, grey.bytes[i]);
  return rgb;
}

// The AOV's planes: float or uint32_t alike, as 32 bits per element.
struct Planes {
  std::vector<const void*> first;  // row 0 of each
  size_t stride = 0;               // bytes from one row to the next
  Format format = Format::F32;
};

template <class T>
void add(Planes& planes, const raster::Plane<T>& plane) {
  planes.first.push_back(plane.data());
  planes.stride = plane.stride() * sizeof(T);
  planes.format = std::is_same_v<T, float> ? Format::F32 : Format::U32;
}

Planes planesOf(const Frame& frame, Aov aov) {
  Planes p;
  const auto three = [&](const Plane (&planes)[3]) {
    for (const Plane& plane : planes) add(p, plane);
  };
  switch (aov) {
    case Aov::Color: three(frame.color.rgb); break;
    case Aov::Depth: add(p, frame.g.depth); break;
    case Aov::Normal: three(frame.g.normal); break;
    case Aov::Albedo: three(frame.g.albedo); break;
    case Aov::Emissive: three(frame.g.emissive); break;
    case Aov::Obscurance: add(p, frame.transfer.obscurance); break;
    case Aov::Transfer: three(frame.transfer.w); break;
    case Aov::Position: three(frame.g.position); break;
    case Aov::Triangle: add(p, frame.g.triangle); break;
    case Aov::Instance: add(p, frame.g.instance); break;
    case Aov::Material: add(p, frame.g.material); break;
    case Aov::Depth2: add(p, frame.g.depth2); break;
    case Aov::DepthBack: add(p, frame.g.depthBack); break;
    case Aov::Metallic: add(p, frame.g.metallic); break;
    case Aov::Roughness: add(p, frame.g.roughness); break;
  }
  return p;
}

Image imageOf(const engine::RowSource& rows) {
  Image image(rows.width, rows.height, rows.channels, rows.format);
  const size_t rowBytes = size_t(rows.width) * size_t(rows.channels) * bytesOf(rows.format);
  for (int y = 0; y < rows.height; ++y)
    std::memcpy(image.row<uint8_t>(0) + size_t(y) * rowBytes, rows.row(y), rowBytes);
  return image;
}

}  // namespace

Image srgbPicture(const Image& planes, int bits) {
  if (bits == 16)
    return mapped<uint16_t>(planes, Format::U16, [](float v) { return wordOf(raster::srgbFromLinear(v)); });
  const post::DisplayTable table;  // so that a colour has the same byte here as in the displayed picture
  const float* first = table.threshold + 1;
  return mapped<uint8_t>(planes, Format::U8, [&](float v) {
    return v >= 0 ? uint8_t(std::upper_bound(first, first + 255, v) - first) : uint8_t(0);
  });
}

engine::RowSource planeRows(const Frame& frame, Aov aov) {
  const Planes planes = planesOf(frame, aov);
  const size_t width = size_t(frame.width), channels = planes.first.size();
  // Copied as integers: a float that is copied as a float might lose the payload of a NaN.
  const auto row = [planes, width, channels,
                    buffer = std::vector<uint32_t>(width * channels)](int y) mutable -> const void* {
    for (size_t c = 0; c < channels; ++c) {
      const uint8_t* from = static_cast<const uint8_t*>(planes.first[c]) + size_t(y) * planes.stride;
      for (size_t x = 0; x < width; ++x) std::memcpy(&buffer[x * channels + c], from + x * 4, 4);
    }
    return buffer.data();
  };
  return {frame.width, frame.height, int(channels), planes.format, row};
}

engine::RowSource displayRows(const Frame& frame) {
  const auto row = [&frame, buffer = std::vector<uint8_t>(size_t(frame.width) * 3)](int y) mutable -> const void* {
    const uint32_t* from = frame.display.rgba.row(y);
    uint8_t* to = buffer.data();
    for (int x = 0; x < frame.width; ++x)
      for (int c = 0; c < 3; ++c) *to++ = uint8_t(from[x] >> (8 * c));
    return buffer.data();
  };
  return {frame.width, frame.height, 3, Format::U8, row};
}

Image planeImage(const Frame& frame, Aov aov) { return imageOf(planeRows(frame, aov)); }

Image displayPicture(const Frame& frame) { return imageOf(displayRows(frame)); }

Image picture(const Frame& frame, Aov aov, int bits) {
  switch (aov) {
    case Aov::Color:
      if (bits == 8) return displayPicture(frame);
      if (!frame.shown.rgb[0].empty()) return srgbPicture(engine::interleave({&frame.shown.rgb[0], &frame.shown.rgb[1], &frame.shown.rgb[2]}), bits);
      return srgbPicture(planeImage(frame, aov), bits);
    case Aov::Albedo:
    case Aov::Emissive: return srgbPicture(planeImage(frame, aov), bits);
    case Aov::Obscurance:
    case Aov::Metallic:
    case Aov::Roughness:
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
    case Aov::Depth2: return engine::depthPicture(frame.g.depth2);
    case Aov::DepthBack: return engine::depthPicture(frame.g.depthBack);
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
