// In:  the visibility of a tile without displaced draws, and that of these alone; materials with a height map.
// Out: the visibility of both, displaced; then, where resolve has stored the triangles' attributes, the displaced surface's
//      depth, position, normal, albedo and emission; and for the transfer where each pixel lies in its height map.
//
// Relief mapping (F. Policarpo, M. M. Oliveira, J. L. D. Comba, "Real-time relief mapping on arbitrary polygonal
// surfaces"): the surface lies below the triangle, by Material::heightScale (1 - h) along the triangle's normal, on the
// side that is seen. h is the height map's value, 0 ... 1, linear between texels. So the pixels that a triangle covers stay
// what they are, and a mesh's outline is that of its triangles.
//
// Along the ray through the pixel's centre tau goes from 0, on the triangle, to 1, where the ray has reached the greatest
// depth; the ray's height above that is 1 - tau, and texture coordinates are linear in tau. Steps of a texel or less look
// for the first tau whose height is not above the map's, kReliefHalvings halve the step before; what lies above the map
// is taken. Rays so flat that they sink by less than 1/64 of their length are followed for as long as one that does not.
// What follows:
//   - displaced surfaces and others hide one another where they are seen. But of displaced triangles it is decided before
//     they sink which of them a pixel can show, and alpha masks are asked and the layers behind the first found before, too.
//     Implicit surfaces come later and meet the displaced surface.
//   - weights of vertices go on beyond the triangle: the map, and textures beside it, go on as if its plane did.
//   - the normal is the interpolated one, tilted by the slope of the map (over two texels); a normal map beside a height
//     map is not read.
#pragma once

#include "obscura/raster/gbuffer.h"
#include "obscura/raster/surface.h"
#include "obscura/raster/target.h"
#include "obscura/raster/tile.h"

namespace obscura::raster {

constexpr int kReliefHalvings = 8;
constexpr float kFewestReliefSteps = 16, kMostReliefSteps = 256;
constexpr float kFlattestRay = 1.0f / 64;
// Of what is displaced, as the view sees it, so that nothing of it overflows.
constexpr double kLeastReliefDepth = 1e-18, kGreatestReliefDepth = 1e18;

// A triangle's plane in view space, seen from either side.
struct ReliefFrame {
  float normal[3];      // unit; 0 where the triangle has no area, which is not displaced
  float gradient[2][3]; // of the weights of its vertices 1 and 2, along the plane
  float depth;          // Material::heightScale as the view sees it; 0: not displaced
};
ReliefFrame reliefFrame(const Draw& draw, const uint32_t vertex[3]);

inline bool isDisplaced(const Draw& draw) { return draw.material->heightMap.texture >= 0; }

// Sinks what `displaced` holds and puts it into `tile` where it is nearer than what is there, on equal keys the smaller id.
// Leaves tau in displaced.key.
void sinkTile(const SurfaceContext& context, const TileBuffers& displaced, const TileBuffers& tile, Target target);

// GBuffer::relief and heightMap, of nothing displaced, in the whole tile.
void clearRelief(const TileBuffers& tile, GBuffer& out);

// The planes that `out` has, in the pixels of the tile that show displaced triangles; displaced: as sinkTile left it.
void storeRelief(const SurfaceContext& context, const TileBuffers& tile, const TileBuffers& displaced, GBuffer& out, Target target);

namespace ref {  // the scalar twins
float heightAt(const HeightView& map, float u, float v);
}  // namespace ref

}  // namespace obscura::raster
