#include "obscura/apps/drawing.h"

#include <algorithm>
#include <cmath>

#include "obscura/engine/stages.h"

namespace obscura::apps {
namespace {

double distanceTo(Point a, Point b, Point p) {  // of p from the segment
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0;
  const double x = a.x + t * dx - p.x, y = a.y + t * dy - p.y;
  return std::sqrt(x * x + y * y);
}

}  // namespace

engine::Image blankPicture(int width, int height, const Ink& paper) {
  engine::Image image(width, height, 3, engine::Format::U8);
  fillRectangle(image, {0, 0}, {double(width), double(height)}, paper);
  return image;
}

void drawSegment(engine::Image& image, Point a, Point b, double width, const Ink& ink) {
  const auto limit = [](double v, int most) { return int(std::clamp(v, 0.0, double(most))); };
  const int x0 = limit(std::min(a.x, b.x) - width, image.width), x1 = limit(std::max(a.x, b.x) + width + 1, image.width);
  const int y0 = limit(std::min(a.y, b.y) - width, image.height), y1 = limit(std::max(a.y, b.y) + width + 1, image.height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const double cover = std::clamp(width / 2 + 0.5 - distanceTo(a, b, {x + 0.5, y + 0.5}), 0.0, 1.0);
      uint8_t* to = image.row<uint8_t>(y) + 3 * x;
      for (size_t c = 0; c < 3; ++c) to[c] = uint8_t(to[c] + (ink[c] - to[c]) * cover + 0.5);
    }
}

void drawDot(engine::Image& image, Point at, double diameter, const Ink& ink) { drawSegment(image, at, at, diameter, ink); }

void fillRectangle(engine::Image& image, Point from, Point to, const Ink& ink) {
  for (int y = std::max(0, int(from.y)); y < std::min(image.height, int(to.y)); ++y)
    for (int x = std::max(0, int(from.x)); x < std::min(image.width, int(to.x)); ++x) std::copy(ink.begin(), ink.end(), image.row<uint8_t>(y) + 3 * x);
}

engine::Image curvePicture(const std::vector<std::pair<double, double>>& points, const CurveAxes& axes, int width, int height) {
  constexpr Ink kGrid = {225, 225, 225}, kAxis = {60, 60, 60}, kCurve = {0, 114, 178};
  constexpr double kMostX = 1.25, kMostY = 1.1;
  engine::Image image = blankPicture(width, height, {255, 255, 255});
  const int scale = std::max(1, width / 200), letter = 6 * scale;
  const double left = 3 * letter, bottom = height - 13.0 * scale, right = 0.97 * width, top = 0.04 * height;
  const auto at = [&](double x, double y) { return Point{left + (right - left) * x / kMostX, bottom + (top - bottom) * y / kMostY}; };
  for (double x = 0.25; x <= kMostX; x += 0.25) drawSegment(image, at(x, 0), at(x, kMostY), 1, kGrid);
  for (double y = 0.25; y <= kMostY; y += 0.25) drawSegment(image, at(0, y), at(kMostX, y), 1, kGrid);
  const double thick = std::max(1.0, height / 150.0);
  drawSegment(image, at(1, -0.02), at(1, 0.02), thick, kAxis);
  drawSegment(image, at(-0.02, 1), at(0.02, 1), thick, kAxis);
  drawSegment(image, at(0, 0), at(kMostX, 0), thick, kAxis);
  drawSegment(image, at(0, 0), at(0, kMostY), thick, kAxis);
  for (size_t i = 1; i < points.size(); ++i)
    drawSegment(image, at(points[i - 1].first, points[i - 1].second), at(points[i].first, points[i].second), 2 * thick, kCurve);
  const auto write = [&](const std::string& text, Point p) { engine::drawText(image, text, int(p.x), int(p.y), scale, kAxis[0]); };
  const double half = letter / 2.0, below = bottom + 4 * scale;
  write("0", {left - half, below});
  write(axes.atX, {at(1, 0).x - half, below});
  write(axes.atY, {left - 2 * letter, at(0, 1).y - 4 * scale});
  write(axes.x, {at(0.5, 0).x - half, below});
  write(axes.y, {left - 3 * letter + half, at(0, 0.5).y - 4 * scale});
  return image;
}

}  // namespace obscura::apps
