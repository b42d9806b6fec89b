// The scalar twins of the rasterizer's stages, put together.
#pragma once

#include <functional>

#include "obscura/raster/gbuffer.h"
#include "obscura/raster/implicit.h"
#include "obscura/raster/plane.h"
#include "obscura/raster/surface_ref.h"

namespace obscura::raster::ref {

struct Visibility {
  int width = 0, height = 0;
  Plane<float> key;          // depth key, -infinity where empty
  Plane<uint32_t> triangle;  // kNoTriangle where empty
};

// Of the draws that have no height map, or of those that have one.
Visibility visibility(const SurfaceContext& context, bool displaced);
// The layers behind it: all triangles and implicit surfaces once more for each that `out` has a plane for.
void layersBehind(const SurfaceContext& context, Span<const ImplicitDraw> implicits, const Visibility& first, float separation,
                  GBuffer& out);
void resolvePixel(const SurfaceContext& context, uint32_t id, float key, int x, int y, GBuffer& out);

// What resolve stores of a surface, not yet cut to its range.
struct Shaded {
  glm::vec3 normal, base, emitted;
  float metallic, roughness;
};
// Of a lit material, by what its texture says.
glm::vec2 metallicRoughness(const SurfaceContext& context, const SurfacePoint& p);
void resolveShaded(const SurfaceContext& context, uint32_t id, float key, const Shaded& shaded, int x, int y, GBuffer& out);
// What relief.h does.
void sinkInto(const SurfaceContext& context, const Visibility& displaced, Visibility& seen);
void storeRelief(const SurfaceContext& context, const Visibility& seen, GBuffer& out);

// What is seen of implicit surfaces, before triangles that are resolved already.
void drawImplicits(const View& view, Span<const ImplicitDraw> surfaces, Visibility& seen, GBuffer& out);
using LimitOf = std::function<float(int x, int y)>;
void drawImplicitsBehind(const View& view, Span<const ImplicitDraw> surfaces, bool back, const LimitOf& limitOf, Plane<float>& best);
void resolveImplicit(const View& view, const ImplicitDraw& surface, const glm::vec3& normal, float key, int x, int y, GBuffer& out);

}  // namespace obscura::raster::ref
