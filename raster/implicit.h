// In:  implicit surfaces, and the visibility of a tile whose triangles are drawn and resolved.
// Out: the same with what is seen of the surfaces: keys, ids, planes of the G-buffer.
//
// Sphere tracing (J. C. Hart, "Sphere tracing: a geometric method for the antialiased ray tracing of implicit surfaces"):
// f is scaled to be nowhere steeper than 1, so the ray through a pixel's centre can go on by |f| without meeting the
// surface. Differs: it goes on by at least 1/1024 of its way through the surface's bound, so that it ends; what it
// crosses within such a step is found where the sign of f changes, and halved down to a part in 2^40 of that way. So only
// what is thinner along the ray than 1/1024 of the way can be missed. Rays are followed in double and along zView.
//
// A crossing is seen as a triangle would be: from outside to inside, if the material is double-sided from inside to
// outside, too. An eye inside a single-sided surface sees through it.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>

#include "obscura/raster/cull.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/implicit_surface.h"
#include "obscura/raster/target.h"
#include "obscura/raster/tile.h"

namespace obscura::raster {

constexpr int kLeastSteps = 1024;  // a step is at least this part of the way through the bound
constexpr int kHalvings = 30;      // of a step that crosses the surface
constexpr double kGradientStep = 1.0 / 16384;  // of the central differences that give the normal, in radii of the bound
constexpr double kBallReach = 2;   // of a metaball, in its radii
constexpr double kBallLevel = 0.421875;  // (1 - 1 / kBallReach^2)^3: the field of a lone ball at its radius

// A surface as this frame sees it.
struct ImplicitDraw {
  const ImplicitSurface* surface = nullptr;
  double objectFromView[3][4];        // rows
  ImplicitBound bound;
  double perSteepness = 1;            // makes the field of metaballs and functions no steeper than 1
  double perPeriod = 1, perSlope = 1; // Gyroid: 1 / period, and what makes it no steeper than 1
  ViewSphere sphere;                  // around the bound, with room for every rounding
  glm::vec3 albedo, emissive;         // as the planes show them
  float metallic = 0, roughness = 0;  // alike
  bool doubleSided = false;
  uint32_t id = 0, instance = 0, materialIndex = 0;
};

// Those that can be seen at all: not flattened, and opaque as far as alphaMode MASK says.
std::vector<ImplicitDraw> makeImplicitDraws(const DrawList& list, const Camera& camera);

// Some pixel of the tile may show a surface. skip false: as soon as there are surfaces.
bool touchesImplicits(const View& view, Span<const ImplicitDraw> surfaces, const TileBuffers& tile, bool skip);

// tile.id may be null (Keep::Key: no planes but depth, which is for storeTileDepth). skip: rays outside the surfaces'
// screen bounds are not looked at. That changes no bit: screenBound has room for all roundings, and what lies outside of
// it is no ray that meets the ball of the bound.
void drawImplicits(const View& view, Span<const ImplicitDraw> surfaces, const TileBuffers& tile, bool skip, GBuffer& out,
                   Target target);

// The same for a layer behind the first (Keep::KeyWithinLimit). back: GBuffer::depthBack, where single-sided surfaces
// are left; otherwise what competes for the first layer.
void drawImplicitsBehind(const View& view, Span<const ImplicitDraw> surfaces, const TileBuffers& tile, bool back, bool skip,
                         Target target);

namespace ref {  // the scalar twins
double implicitValue(const ImplicitDraw& surface, const glm::dvec3& p);  // f at a point of object space
float implicitValue(const ImplicitDraw& surface, const glm::vec3& p);    // the same in float, as the post process asks
}  // namespace ref

}  // namespace obscura::raster
