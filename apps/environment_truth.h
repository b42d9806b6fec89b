// In:  a scene, the G-buffer of a frame of it, an environment map.
// Out: per pixel the light that arrives from it, by tracing rays.
#pragma once

#include "obscura/apps/environment_sampler.h"
#include "obscura/apps/truth.h"

namespace obscura::apps {

// kEnvironmentQuantities planes, irradiance / pi per channel: what a white, matt surface would send out.
//   Open      (1 / pi) int L(w) cos dw: nothing occludes. What nine coefficients aim at
//   Shadowed  the same of the directions in which no triangle lies, however far: real shadows, and no light from what casts them
//   Obscured  (1 / pi) int mu(d) L(w) cos dw, mu and R as of O: what E x O aims at
//   Lit       I(x) = (1 / pi) int [mu(d) L(w) + (1 - mu(d)) a(y) I(y)] cos dw: what E x W aims at, as the recursive W with L for La
// At each point of a path one direction asks for the environment: half of them by the cosine, half by the map's importance, each
// weighted by what both together make of it (the balance heuristic, Veach 1997, section 9.2). Another one, by the cosine, goes on
// from where it hits. What is left after kTruthHits is dropped.
Truth traceEnvironment(const RaySurface& surface, const RayScene& rays, const TruthStarts& starts, const EnvironmentSampler& environment,
                       int width, int height, const TruthSettings& settings, const std::function<void(int)>& done);

// `truth` with the planes of `environment` behind its own.
void append(Truth& truth, Truth environment);

}  // namespace obscura::apps
