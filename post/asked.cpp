#include "obscura/post/asked.h"

#include <algorithm>
#include <vector>

namespace obscura::post {
namespace {

constexpr int kSegment = 16;
// The filter's window of pixel p is p - 2 ... p + 1 on both axes (depth_filter.h), so that q lies in those of q - 1 ... q + 2.
constexpr int kBefore = 1, kAfter = 2;

bool isBlack(const glm::vec3& c) { return !(c.x > 0 || c.y > 0 || c.z > 0); }

// 1 for each pixel of the row that asks; `row` has g.width elements, 0 outside of the part.
void askingPixels(const AskedInput& in, int y, std::vector<uint8_t>& row) {
  const raster::GBuffer& g = *in.g;
  const int x0 = in.part.x, x1 = in.part.x + in.part.width;
  if (!in.onlyLit) {
    std::fill(row.begin() + x0, row.begin() + x1, uint8_t(1));
    return;
  }
  const float *r = g.albedo[0].row(y), *gr = g.albedo[1].row(y), *b = g.albedo[2].row(y);
  for (int x = x0; x < x1; ++x) row[size_t(x)] = uint8_t((r[x] > 0) | (gr[x] > 0) | (b[x] > 0));
  if (in.ambient.empty()) return;
  const uint32_t* id = g.instance.row(y);
  for (int x = x0; x < x1; ++x)
    if (row[size_t(x)] && id[x] < in.ambient.size() && isBlack(in.ambient[id[x]])) row[size_t(x)] = 0;
}

// Sets the segments of `segments` whose pixels lie in the windows of pixels that ask.
void markSegments(const std::vector<uint8_t>& row, bool filter, uint8_t* segments) {
  const int width = int(row.size()), before = filter ? kBefore : 0, after = filter ? kAfter : 0;
  for (int x = 0; x < width; x += kSegment) {
    const auto first = row.begin() + std::max(x - before, 0), end = row.begin() + std::min(x + kSegment + after, width);
    uint8_t any = 0;
    for (auto p = first; p < end; ++p) any |= *p;
    segments[x / kSegment] |= any;
  }
}

}  // namespace

void askedPixels(const AskedInput& in, int y0, int y1, raster::Plane<uint8_t>& asked) {
  const int before = in.filter ? kBefore : 0, after = in.filter ? kAfter : 0;
  for (int y = y0; y < y1; ++y) std::fill_n(asked.row(y), asked.width(), uint8_t(0));
  std::vector<uint8_t> row(size_t(in.g->width)), segments(size_t(asked.width()));
  const int first = std::max(y0 - before, in.part.y), end = std::min(y1 + after, in.part.y + in.part.height);
  for (int y = first; y < end; ++y) {
    askingPixels(in, y, row);
    std::fill(segments.begin(), segments.end(), uint8_t(0));
    markSegments(row, in.filter, segments.data());
    for (int k = std::max(y - after, y0); k <= std::min(y + before, y1 - 1); ++k)
      for (size_t s = 0; s < segments.size(); ++s) asked.row(k)[s] |= segments[s];
  }
}

}  // namespace obscura::post
