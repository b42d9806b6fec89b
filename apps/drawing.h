// Lines, dots and curves in pictures: U8 RGB, smooth edges.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "obscura/engine/image.h"

namespace obscura::apps {

struct Point {
  double x = 0, y = 0;  // pixels from the upper left corner
};
using Ink = std::array<uint8_t, 3>;

engine::Image blankPicture(int width, int height, const Ink& paper);
void drawSegment(engine::Image& image, Point a, Point b, double width, const Ink& ink);  // with round ends
void drawDot(engine::Image& image, Point at, double diameter, const Ink& ink);
void fillRectangle(engine::Image& image, Point from, Point to, const Ink& ink);  // whole pixels

// A curve between two axes: x from 0 to 1.25, y from 0 to 1.1, with grid lines at quarters and names at x = 1 and y = 1.
struct CurveAxes {
  std::string atX, atY, x, y;  // ASCII
};
engine::Image curvePicture(const std::vector<std::pair<double, double>>& points, const CurveAxes& axes, int width, int height);

}  // namespace obscura::apps
