// The ambient light La(x): the same everywhere, of the group of things that x belongs to, by the direction of its normal, or
// from an environment (both papers: it "may slowly change", as from room to room).
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/raster/plane.h"
#include "obscura/raster/span.h"

namespace obscura::post {

// Light of what faces a direction f, as the classes of Castro, Neumann and Sbert's "Extended Ambient Term".
struct AmbientDirection {
  glm::vec3 direction{0, 0, 1};  // unit; in the space of the G-buffer's normals: x right, y up, z towards the eye
  glm::vec3 color{1};            // a factor on the light from everywhere; linear, >= 0 and finite
  glm::vec3 added{0};            // light besides that; alike
};

// La of a surface by its unit normal n as a quadratic form, which is what the nine spherical harmonics up to the second
// order make of an environment's irradiance (Ramamoorthi and Hanrahan 2001, equation 12: n^t M n). Per channel
//   (xx nx + xy ny + xz nz + x) nx + (yy ny + yz nz + y) ny + (zz nz + z) nz + constant, kept in [0, most]
// whatever the normal holds; 0 where that is no number. All coefficients are finite.
struct NormalQuadric {
  glm::vec3 constant{0}, x{0}, y{0}, z{0}, xx{0}, xy{0}, xz{0}, yy{0}, yz{0}, zz{0};
  glm::vec3 most{0};  // of any unit normal, >= 0
};

inline bool addsLight(const std::vector<AmbientDirection>& directions) {
  return std::any_of(directions.begin(), directions.end(), [](const AmbientDirection& k) { return k.added != glm::vec3(0); });
}

constexpr glm::vec3 kNoOwnLight(-1);  // in a table of instances' lights; its first component decides

// La(instance, n) = L(instance, n) D(n) + A(n), per channel:
//   L  instances[id] for the ids that it has and that are not kNoOwnLight, else that of the environment if there is one, else
//      color
//   D  sum_k w_k color_k / sum_k w_k with w_k = max(0, n . f_k); 1 without directions. Where the sum of the weights is not
//      in (0, 1e8), as of a normal that is zero or no number, the mean of the colours.
//   A  alike of what directions add; 0 if none of them does.
// Whatever the normals hold, D and A are not above the largest of their colours but for roundings.
struct AmbientLight {
  glm::vec3 color{1};                       // linear, >= 0 and finite
  raster::Span<const glm::vec3> instances;  // by the G-buffer's instance ids, alike; at most 2^29
  std::vector<AmbientDirection> directions;
  std::optional<NormalQuadric> environment;  // in the space of the G-buffer's normals

  AmbientLight(const glm::vec3& everywhere = glm::vec3(1)) : color(everywhere) {}

  // Planes of the G-buffer that La is read from.
  bool needsInstance() const { return !instances.empty(); }
  bool needsNormal() const { return !directions.empty() || environment; }
  bool adds() const { return addsLight(directions); }
};

// Scalar twin of orOfInstance() in instance_light-inl.h: whether the pixel shows an instance with a light of its own.
inline bool hasOwnLight(raster::Span<const glm::vec3> lights, const raster::Plane<uint32_t>& instance, int x, int y) {
  return !lights.empty() && instance.at(x, y) < lights.size() && lights[instance.at(x, y)].x >= 0;
}

}  // namespace obscura::post
