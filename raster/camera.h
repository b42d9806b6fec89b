// Camera: from world space to view space to pixels.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace obscura::raster {

enum class Projection { Perspective, Orthographic };

// View space is right-handed: x right, y up, the camera looks along -z. Distances along the view axis are
// written zView = -z, positive in front of the eye.
//   Perspective:  xNdc = xScale x / zView + xShift,   Orthographic:  xNdc = xScale x + xShift   (y alike)
// with ndc -1 at the left (bottom) and +1 at the right (top) edge of the image.
struct Camera {
  glm::dmat4 viewFromWorld{1.0};  // affine; double, so that far-away worlds keep their detail
  Projection projection = Projection::Perspective;
  float xScale = 1, yScale = 1;   // perspective: cot(fovX / 2), cot(fovY / 2); orthographic: 1 / half extent
  float xShift = 0, yShift = 0;   // off-centre projections, in ndc
  float zNear = 0.1f;             // > 0 (perspective), >= 0 (orthographic)
  float zFar = 0;                 // > zNear, or 0: none (perspective only)
};

// A rectangle in pixels of a camera's image: what is drawn of it. It may reach beyond the image (x, y negative too): that
// is a border. Its pixels are, bit for bit, those that any other window shows in their place.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

// yFov in radians (0, pi), aspect = width / height of the image.
Camera perspective(double yFov, double aspect, double zNear, double zFar = 0);
// The whole image shows [-xMag, xMag] x [-yMag, yMag].
Camera orthographic(double xMag, double yMag, double zNear, double zFar);
// viewFromWorld of an eye that looks at target; where up is parallel to the view axis another up is taken.
glm::dmat4 lookAt(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up);

// From matrices as OpenGL has them, for column vectors and indexed [column][row]: clip = projection view (x, y, z, 1), seen
// where |x|, |y|, |z| <= w. The view looks along -z and is affine: its last row is 0 0 0 1. The projection is
//   perspective   last row 0 0 -k 0, k > 0; off-centre or not, the far plane at a distance or infinitely far away
//   orthographic  last row 0 0 0 k, k > 0; off-centre or not
// and either may have its depth reversed (near at z = w). A far plane beyond 1e30 counts as none. Throws
// std::invalid_argument, naming what cannot be: numbers that are not finite or beyond 1e30, a view that is not affine or
// has no inverse, a projection that shears, tilts, mirrors, looks along +z, moves the eye or has an oblique near plane,
// a near plane that is not in front of the eye, an empty depth range.
Camera cameraFromMatrices(const glm::dmat4& view, const glm::dmat4& projection);

}  // namespace obscura::raster
