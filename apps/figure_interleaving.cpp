// Interleaved sampling: which of 16 turned sample sets each pixel takes, and what a 4 x 4 window has together.
#include <algorithm>
#include <cmath>

#include "obscura/apps/drawing.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/post/sample_sets.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using engine::Image;
constexpr double kTau = 6.283185307179586;

int turnOf(int x, int y) { return post::rotationOrder()[size_t(x % 4 + 4 * (y % 4))]; }

Ink hue(int turn) {  // around the colour circle
  const auto channel = [&](int third) {
    const double wave = 0.5 + 0.5 * raster::exactCos(kTau * (turn / 16.0 - third / 3.0));
    return uint8_t(70 + 170 * wave);
  };
  return {channel(0), channel(1), channel(2)};
}

// The pixels of the image's upper left corner by their turn; a window in it is framed.
Image patternPicture(int width, int height) {
  constexpr int kColumns = 12, kRows = 9;
  constexpr Ink kFrame = {0, 0, 0};
  const int cell = std::min(width / kColumns, height / kRows);
  Image image = blankPicture(width, height, {255, 255, 255});
  const double left = (width - kColumns * cell) / 2, top = (height - kRows * cell) / 2;
  const auto at = [&](int x, int y) { return Point{left + x * cell, top + y * cell}; };
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const Point corner = at(x, y);
      fillRectangle(image, {corner.x + 1, corner.y + 1}, at(x + 1, y + 1), hue(turnOf(x, y)));
      const std::string text = std::to_string(turnOf(x, y));
      const int scale = std::max(1, cell / 20);
      engine::drawText(image, text, int(corner.x + cell / 2.0 - 3.0 * scale * double(text.size())), int(corner.y + cell / 2.0 - 4.0 * scale), scale, 0);
    }
  const Point corners[] = {at(5, 2), at(9, 2), at(9, 6), at(5, 6)};
  for (size_t k = 0; k < 4; ++k) drawSegment(image, corners[k], corners[(k + 1) % 4], std::max(2.0, cell / 10.0), kFrame);
  return image;
}

// The test points of n = 8 seen along the normal, within R; of one pixel, or of the 16 of a window in their colours.
Image pointsPicture(int width, int height, bool all) {
  Image image = blankPicture(width, height, {255, 255, 255});
  const double radius = 0.46 * std::min(width, height), dot = std::max(3.0, radius / 22);
  const Point middle{width / 2.0, height / 2.0};
  const auto at = [&](double r, double angle) { return Point{middle.x + radius * r * raster::exactCos(angle), middle.y - radius * r * raster::exactSin(angle)}; };
  for (int k = 0; k < 96; ++k) drawSegment(image, at(1, kTau * k / 96), at(1, kTau * (k + 1) / 96), 1.5, {120, 120, 120});
  for (int j = 0; j < (all ? 16 : 1); ++j)
    for (const glm::vec3& p : post::sampleSet(8)) {  // linear membership: the distance is xi_z
      const double r = std::sqrt(double(p.y)) * double(p.z);
      drawDot(image, at(r, kTau * (double(p.x) + j / 16.0)), dot, hue(j));
    }
  return image;
}

}  // namespace

FigureContent makeInterleavingFigure(const FigureSettings& figure) {
  FigureContent out;
  out.columns = 3;
  out.panels = {{"the set that each pixel takes", patternPicture(figure.width, figure.height)},
                {"n = 8 in one pixel", pointsPicture(figure.width, figure.height, false)},
                {"in a 4 x 4 window: 128", pointsPicture(figure.width, figure.height, true)}};
  out.numbers.columns = {"row of the pattern", "x = 0", "x = 1", "x = 2", "x = 3"};
  for (int y = 0; y < 4; ++y) {
    std::vector<std::string> row = {"y = " + std::to_string(y)};
    for (int x = 0; x < 4; ++x) row.push_back(std::to_string(turnOf(x, y)));
    out.numbers.rows.push_back(row);
  }
  bool each = true;
  int nearest = 16;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      unsigned found = 0;
      for (int k = 0; k < 16; ++k) found |= 1u << turnOf(x + k % 4, y + k / 4);
      each &= found == 0xFFFF;
      for (const int other : {turnOf(x + 1, y), turnOf(x, y + 1)}) {
        const int apart = std::abs(other - turnOf(x, y));
        nearest = std::min({nearest, apart, 16 - apart});
      }
    }
  out.claims = {{"any 4 x 4 window has each of the 16 turned sets once", each},
                {"pixels that share an edge differ by at least " + number(nearest * 22.5) + " degrees", nearest >= 4}};
  return out;
}

}  // namespace obscura::apps
