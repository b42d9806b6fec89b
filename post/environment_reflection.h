// In:  depth, normal, roughness; O; an environment's chain and how the camera sees it.
// Out: what a surface reflects of the environment towards the eye, before its own S(v) (brdf.h): the second part of the split
//      sum (Karis 2013) is R_A's, this is the first.
#pragma once

#include "obscura/post/environment_cube.h"
#include "obscura/post/linear_color.h"
#include "obscura/post/projector.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/target.h"

namespace obscura::post {

// Radiance from around r = 2 (n.v) n - v ("Real-Time Rendering", 3rd ed., section 8.4), n the normal-mapped normal, out of the
// level of the roughness: trilinear, times intensity and the specular occlusion. A mirror looks along r; what is rough reflects
// most from nearer its normal, and the levels, made for n = v = r, know nothing of it: they are looked up along
//   n + (r - n) s (sqrt(s) + q^2),    s = 1 - q^2    (Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", listing 22)
// The occlusion is
//   o(O, n.v, q) = O + (sqrt(n.v + O) - 1) (1 - q)^10, kept in [0, 1],    q roughness, n.v as BRDFs take it
// Lagarde and de Rousiers (section 4.10.2) have (n.v + O)^(2^(-16 q - 1)) - 1 + O. This is theirs
// at q = 0 and at q = 1, where it is O, with the powers between replaced by what +, * and sqrt can do: it differs by less than
// 0.05. Where nothing occludes (O = 1) it is 1.
struct ReflectionInput {
  const raster::GBuffer* g = nullptr;                // depth, normal and roughness; instance where there are `instances`
  const raster::Plane<float>* obscurance = nullptr;  // O, or null: nothing occludes
  Projector projector;
  EnvironmentView environment;                       // with all levels
  raster::Span<const glm::vec3> instances;           // as in AmbientLight: these have no environment, but this light from everywhere
};

// Pixels in which nothing is seen are left as they are, or hold anything finite.
void environmentReflection(const ReflectionInput& in, int y0, int y1, LinearColor& out, raster::Target target);
void environmentReflectionRef(const ReflectionInput& in, int y0, int y1, LinearColor& out);  // the scalar twin

}  // namespace obscura::post
