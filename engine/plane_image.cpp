#include "obscura/engine/plane_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace obscura::engine {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool isFinite(float v) { return v - v == 0; }

template <class T>
Image interleaved(std::initializer_list<const raster::Plane<T>*> planes, Format format) {
  const raster::Plane<T>& first = **planes.begin();
  for (const auto* p : planes)
    if (p->width() != first.width() || p->height() != first.height()) return {};
  Image image(first.width(), first.height(), int(planes.size()), format);
  for (int y = 0; y < image.height; ++y) {
    size_t channel = 0;
    for (const auto* p : planes) {
      const T* from = p->row(y);
      T* to = image.row<T>(y) + channel++;
      // As bytes: a float that is copied as a float might lose the payload of a NaN.
      for (size_t x = 0; x < size_t(image.width); ++x) std::memcpy(to + x * planes.size(), from + x, sizeof(T));
    }
  }
  return image;
}

// One pixel of an RGB image at a time; color(x, y, rgb) fills three bytes.
template <class F>
Image picture(int width, int height, const F& color) {
  Image image(width, height, 3, Format::U8);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) color(x, y, image.row<uint8_t>(y) + size_t(x) * 3);
  return image;
}

// Mixes all bits of an id (a bijection: two odd multiplications and shifts), so that distinct ids stay distinct.
uint32_t scatter(uint32_t id) {
  id = (id ^ id >> 16) * 0x7FEB352Du;
  id = (id ^ id >> 15) * 0x846CA68Bu;
  return id ^ id >> 16;
}

uint8_t byteOf(float v) { return v >= 1 ? 255 : v > 0 ? uint8_t(v * 255.0f + 0.5f) : 0; }

}  // namespace

Image interleave(std::initializer_list<const raster::Plane<float>*> planes) {
  return interleaved(planes, Format::F32);
}

Image interleave(std::initializer_list<const raster::Plane<uint32_t>*> planes) {
  return interleaved(planes, Format::U32);
}

Image idPicture(const raster::Plane<uint32_t>& ids) {
  return picture(ids.width(), ids.height(), [&](int x, int y, uint8_t* rgb) {
    const uint32_t id = ids.at(x, y);
    if (id == 0xFFFFFFFFu) return;  // the image starts black
    const uint32_t mixed = scatter(id);
    uint32_t c[3];
    for (int k = 0; k < 3; ++k) c[k] = 48 + (mixed >> (8 * k) & 0xFF) * 207 / 255;
    const uint32_t most = std::max({c[0], c[1], c[2]});
    for (int k = 0; k < 3; ++k) rgb[k] = uint8_t(c[k] * 255 / most);  // the brightest channel is full
  });
}

Image depthPicture(const raster::Plane<float>& zView) {
  float nearest = kInfinity, farthest = -kInfinity;
  for (int y = 0; y < zView.height(); ++y)
    for (int x = 0; x < zView.width(); ++x) {
      const float z = zView.at(x, y);
      if (!isFinite(z)) continue;
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
    }
  const double range = double(farthest) - double(nearest);
  return picture(zView.width(), zView.height(), [&](int x, int y, uint8_t* rgb) {
    const float z = zView.at(x, y);
    if (!isFinite(z)) return;
    const double t = range > 0 ? (double(z) - double(nearest)) / range : 0;
    rgb[0] = rgb[1] = rgb[2] = uint8_t(32.5 + 223 * (1 - std::sqrt(t)));
  });
}

Image normalPicture(const raster::Plane<float>& nx, const raster::Plane<float>& ny, const raster::Plane<float>& nz) {
  const raster::Plane<float>* n[] = {&nx, &ny, &nz};
  for (const auto* p : n)
    if (p->width() != nx.width() || p->height() != nx.height()) return {};
  return picture(nx.width(), nx.height(), [&](int x, int y, uint8_t* rgb) {
    for (int k = 0; k < 3; ++k) rgb[k] = byteOf(n[k]->at(x, y) * 0.5f + 0.5f);
  });
}

}  // namespace obscura::engine
