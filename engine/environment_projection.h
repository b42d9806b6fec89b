// In:  a direction, or a point of an environment map.
// Out: the other one: the projector functions of "Real-Time Rendering", 3rd ed., section 8.4, and their inverses.
//
// Conventions: the world is right-handed with y up, as in glTF; a camera without a rotation looks along -z, and that is the
// middle of a map (of a sphere map: its rim). Row 0 is on top. A map has one or more panels of the same size; in a panel x
// points right and y down, in texels, and texel (i, j) covers [i, i + 1) x [j, j + 1).
//
//   latlong     1 panel, w = 2 h (Blinn and Newell): x = (1/2 + atan2(dx, -dz) / 2 pi) w, y = (1/2 - latitude / pi) h.
//               Left of the middle is -x, right +x, the edges are +z; seen from inside, not mirrored.
//   sphere      1 panel, w = h (the picture of a mirror ball from far away on the +z axis, OpenGL's GL_SPHERE_MAP): with
//               m = 2 sqrt(dx^2 + dy^2 + (dz + 1)^2), x = (1/2 + dx / m) w, y = (1/2 - dy / m) h. The middle is +z, the whole
//               rim is -z; mirrored, as reflections are. All texels have the same solid angle.
//   cube        6 panels, w = h (Greene), in the order +x -x +y -y +z -z; seen from inside, not mirrored. In a file it is a
//               cross, 4 panels wide and 3 high: -x -z +x +z in the middle row, +y above -z and -y below it.
//   paraboloid  2 panels, w = h (Heidrich and Seidel): -z on the left, +z on the right: s = dx / (1 + |dz|), t = dy / (1 +
//               |dz|) inside the unit circle, x = (1/2 + s/2) w, for the right one with -s; seen from inside, not mirrored.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace obscura::engine {

enum class EnvironmentProjection : uint8_t { Latlong, Sphere, Cube, Paraboloid };

struct PanelPoint {
  int panel = 0;
  double x = 0, y = 0;  // texels
};

// One projection at one size. Everything in double, the same bits on every machine.
struct EnvironmentProjector {
  EnvironmentProjection projection = EnvironmentProjection::Latlong;
  int width = 0, height = 0;  // of a panel, texels

  int panels() const;
  // The panel and the point in it, [0, width] x [0, height]. Any length but 0; where a map shows a direction at several
  // places, one of them.
  PanelPoint pointOf(const glm::dvec3& direction) const;
  // Unit. Points beside a panel or outside its circle continue it: over a pole or edge of a cube, into the other paraboloid;
  // of a sphere map they are all the rim, -z.
  glm::dvec3 directionAt(const PanelPoint& point) const;
  // The centre of the texel shows what no other one does: inside the circle of a sphere or paraboloid map.
  bool shows(int x, int y) const;
  // Of the texel, steradians; without what lies outside the circle, where it crosses the texel by 16 x 16 points. They add up
  // to 4 pi: exactly but for roundings (latlong, cube), to 10^-3 at 16 texels a side and 10^-5 at 256 (sphere, paraboloid).
  double solidAngle(int x, int y) const;

  // How the panels lie in an image file.
  int imageWidth() const;
  int imageHeight() const;
  glm::ivec2 originOf(int panel) const;  // of its first texel
};

// The directions of all texels' centres: the bits of directionAt(), which takes long for a latlong map's, whose columns and rows
// share their angles.
class TexelDirections {
 public:
  explicit TexelDirections(const EnvironmentProjector& projector);
  glm::dvec3 at(int panel, int x, int y) const;

 private:
  struct Angle {
    double sine, cosine;
  };
  EnvironmentProjector projector_;
  std::vector<Angle> longitudes_, latitudes_;  // of a latlong map
};

// The projector of an image of this size; empty if no map of that projection has it.
std::optional<EnvironmentProjector> projectorOfImage(EnvironmentProjection projection, int imageWidth, int imageHeight);

// That whose texels are at least as many as `texels`, and no more than its shape needs.
EnvironmentProjector projectorOfTexels(EnvironmentProjection projection, double texels);
double usedTexels(const EnvironmentProjector& p);  // that show something, about

}  // namespace obscura::engine
