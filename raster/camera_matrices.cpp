#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <stdexcept>
#include <string>

#include "obscura/raster/camera.h"
#include "obscura/raster/float_environment.h"

namespace obscura::raster {
namespace {

constexpr double kMost = 1e30;   // of every number; camera parameters are floats whose squares must not matter
constexpr double kLeast = 1e-30;

[[noreturn]] void fail(const std::string& what) { throw std::invalid_argument("obscura raster: " + what); }

std::string shown(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", v);
  return text;
}

std::string element(const char* matrix, const glm::dmat4& m, int column, int row) {
  return std::string(matrix) + " matrix, column " + std::to_string(column) + ", row " + std::to_string(row) + ": " +
         shown(m[column][row]);
}

void checkNumbers(const char* name, const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!(std::fabs(m[c][r]) <= kMost)) fail(element(name, m, c, r) + " is not a number up to 1e30");
}

struct Element {
  int column, row;
};
void checkZero(const char* name, const glm::dmat4& m, std::initializer_list<Element> elements, const char* why) {
  for (const Element& e : elements)
    if (m[e.column][e.row] != 0) fail(element(name, m, e.column, e.row) + ", not 0: " + why);
}

void checkView(const glm::dmat4& m) {
  checkNumbers("view", m);
  const char* affine = "the view is not affine, as its last row is not 0 0 0 1";
  checkZero("view", m, {{0, 3}, {1, 3}, {2, 3}}, affine);
  if (m[3][3] != 1) fail(element("view", m, 3, 3) + ", not 1: " + affine);
  // Each column by its own length: what is left is 0 only where they lie in a plane, whatever the scale.
  double axis[3][3];
  for (int c = 0; c < 3; ++c) {
    const double largest = std::fmax(std::fmax(std::fabs(m[c][0]), std::fabs(m[c][1])), std::fabs(m[c][2]));
    for (int r = 0; r < 3; ++r) axis[c][r] = largest > 0 ? m[c][r] / largest : 0;
  }
  const double volume = axis[0][0] * (axis[1][1] * axis[2][2] - axis[1][2] * axis[2][1]) -
                        axis[1][0] * (axis[0][1] * axis[2][2] - axis[0][2] * axis[2][1]) +
                        axis[2][0] * (axis[0][1] * axis[1][2] - axis[0][2] * axis[1][1]);
  if (!(std::fabs(volume) > 1e-12)) fail("view matrix without an inverse: its axes lie in a plane");
}

// The interval of distances in front of the eye between two planes, one of them possibly beyond all.
void setDepths(double zNear, double zFar, bool hasFar, Camera& c) {
  const bool perspective = c.projection == Projection::Perspective;
  if (!(perspective ? zNear >= kLeast : zNear >= 0) || !(zNear <= kMost))
    fail("projection with its near plane at the distance " + shown(zNear) + ", not in front of the eye");
  c.zNear = float(zNear);
  c.zFar = hasFar && zFar <= kMost ? float(zFar) : 0;
  if (hasFar && zFar <= kMost && !(c.zFar > c.zNear))
    fail("projection with its far plane at " + shown(zFar) + ", not behind the near plane at " + shown(zNear));
}

}  // namespace

Camera cameraFromMatrices(const glm::dmat4& view, const glm::dmat4& projection) {
  const FloatEnvironment environment;
  checkView(view);
  const glm::dmat4& p = projection;
  const char* name = "projection";
  checkNumbers(name, p);
  checkZero(name, p, {{0, 3}, {1, 3}}, "the projection tilts the image plane");
  checkZero(name, p, {{1, 0}, {0, 1}}, "the projection shears or turns the image; turn the view instead");
  checkZero(name, p, {{0, 2}, {1, 2}}, "an oblique near plane");

  Camera c;
  c.viewFromWorld = view;
  const bool perspective = p[2][3] != 0;
  c.projection = perspective ? Projection::Perspective : Projection::Orthographic;
  const double k = perspective ? -p[2][3] : p[3][3];  // w = k zView or k
  if (!(k > 0))
    fail(perspective ? element(name, p, 2, 3) + ", not below 0: the projection looks along +z, not -z"
                     : element(name, p, 3, 3) + ", not above 0: nothing lies in front of the eye");
  if (perspective) checkZero(name, p, {{3, 0}, {3, 1}, {3, 3}}, "the projection moves the eye; move the view instead");
  else checkZero(name, p, {{2, 0}, {2, 1}}, "the projection is oblique");
  const double xScale = p[0][0] / k, yScale = p[1][1] / k;
  const double xShift = perspective ? -p[2][0] / k : p[3][0] / k, yShift = perspective ? -p[2][1] / k : p[3][1] / k;
  for (int axis = 0; axis < 2; ++axis) {
    const double scale = axis == 0 ? xScale : yScale, shift = axis == 0 ? xShift : yShift;
    if (!(scale >= kLeast && scale <= kMost))
      fail(element(name, p, axis, axis) + ": a scale of " + shown(scale) + ", not positive (the image would be mirrored or flat)");
    if (!(std::fabs(shift) <= kMost)) fail(element(name, p, perspective ? 2 : 3, axis) + " shifts the image out of all bounds");
  }
  c.xScale = float(xScale);
  c.yScale = float(yScale);
  c.xShift = float(xShift);
  c.yShift = float(yShift);

  const double a = p[2][2] / k, b = p[3][2] / k;
  if (perspective) {
    // zNdc = b / zView - a. It rises from the near plane at -1 (b < 0) or falls from +1 (reversed), and tends to -a: the
    // far plane is where it meets the other end of [-1, 1], if it does.
    const double end = b < 0 ? 1 : -1;  // at the far plane
    if (b == 0 || !(b < 0 ? a < 1 : a > -1)) fail(element(name, p, 2, 2) + " and " + element(name, p, 3, 2) + ": an empty depth range");
    setDepths(b / (a - end), b / (a + end), b < 0 ? a < -1 : a > 1, c);
  } else {
    // zNdc = b - a zView: the planes are where it is -1 and +1.
    if (a == 0) fail(element(name, p, 2, 2) + ": an empty depth range");
    const double z0 = (b + 1) / a, z1 = (b - 1) / a;
    if (!(std::fmax(z0, z1) <= kMost)) fail(element(name, p, 2, 2) + ": a far plane beyond 1e30");
    setDepths(std::fmin(z0, z1), std::fmax(z0, z1), true, c);
  }
  return c;
}

}  // namespace obscura::raster
