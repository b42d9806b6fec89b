// In:  all surfaces of a scene: normals, areas, reflectances, what they emit; directions, one for each class.
// Out: the light that arrives from the scene at a surface of each class (Castro, Neumann, Sbert: Extended Ambient Term).
#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/engine/ambient_directions.h"
#include "obscura/engine/bounced_light.h"
#include "obscura/engine/environment.h"
#include "obscura/engine/result.h"
#include "obscura/engine/scene.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {

// What the surfaces around the direction f_k add up to; scene units squared, and colours as radiance (radiosity / pi), as
// everywhere here. Sums over i: triangles with weights mu_ik = max(0, n_i . f_k), which are divided by their sum over k.
struct AmbientClass {
  glm::dvec3 direction{0, 0, 1};  // f_k, unit, world space
  double area = 0;                // A_k   = sum mu_ik A_i
  glm::dvec3 reflected{0};        // sum mu_ik A_i rho_i: A_k times the mean reflectance
  glm::dvec3 emitted{0};          // U_k   = sum mu_ik A_i E_i, the unshot power: emission, and what is reflected of direct lights
};

// A triangle's reflectance is its base colour, with the mean of the texture instead of what the triangle shows of it, and
// with the mean of its vertex colours; what is unlit reflects nothing and emits that. Double-sided triangles are two.
// Triangles without area count nothing, nor do those that face away from all directions; implicit surfaces have no
// triangles. Direct light, if there is any, is that of a triangle's centre. The sums do not depend on the number of threads.
std::vector<AmbientClass> ambientClasses(const Scene& scene, const std::vector<glm::dvec3>& directions, raster::Parallel& parallel,
                                         const BouncedLight* direct = nullptr);

// The incoming light per class, equations 1 and 2:  B_k = U_k / A_k + rho_k In_k,  In_k = sum_j F_kj B_j, with F_kk = 0 and
// F_kj = 1 / (C - 1). `light`: what arrives everywhere besides, such as a constant ambient term; its first reflection is
// unshot power, rho_k light, and it is in the result. Classes without area send nothing. rho_k is clamped to 0.99: in a
// closed room whose walls absorb nothing light would have no end. In_k of one class alone is `light`.
std::vector<glm::vec3> incomingLight(const std::vector<AmbientClass>& classes, const glm::dvec3& light);

// Both, for as many classes as spreadDirections() takes: FrameSettings::ambientDirections, to be used with an ambient light of 1.
// More of them make it less: a class gets nothing of itself alone, and what that is becomes ever less. Without a light
// there is that of the scene's emitters and of `direct` lights alone; where nothing emits, white light from everywhere, such that its mean over
// classes and channels is 1 with all reflections: as bright as the constant term, as in an open scene reflections would
// only add to a light that is not there. Factors by direction, on that light: those along the classes' own directions; without a
// light the mean is theirs. BadInput: a light beyond what floats hold.
Result<std::vector<post::AmbientDirection>> extendedAmbient(const Scene& scene, const std::optional<glm::dvec3>& light, raster::Parallel& parallel,
                                                            const BouncedLight* direct = nullptr, int classes = 6,
                                                            const std::vector<post::AmbientDirection>& factors = {});

struct EnvironmentLight {
  const Environment& environment;
  double rotation = 0, intensity = 1;  // as in FrameSettings
};

// The same where an environment is the light from outside: FrameSettings::ambientDirections besides FrameSettings::environment.
// What stands in its way is known here (outside_light.h): with the parts p_k of its light and o_k of a class's view that are open
//   In_k = p_k E(f_k) / pi + Q_k,   Q_k = (1 - o_k) mean of B_j over the other classes that have an area
// The result's colours are p_k (times the factors along f_k) and it adds Q_k, so that La(n) = p(n) E(n) / pi + Q(n), see docs/lighting.md.
// rho_k (1 - o_k) is clamped to 0.99.
Result<std::vector<post::AmbientDirection>> extendedEnvironment(const Scene& scene, const EnvironmentLight& light, const raster::Settings& settings,
                                                                const BouncedLight* direct = nullptr, int classes = 6,
                                                                const std::vector<post::AmbientDirection>& factors = {});

}  // namespace obscura::engine
