// In:  the visibility of a tile, resolved; materials with a height map.
// Out: the displaced surface in their pixels: keys, depth, position, normal, albedo, emission; and for the transfer where
//      each pixel lies in its height map.
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
//   - which triangle is seen is decided by the triangles themselves, before any is displaced, and so are alpha masks and
//     the layers behind the first: a displaced surface that would sink behind another is still seen before it.
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

// A triangle's plane in view space, seen from either side.
struct ReliefFrame {
  float normal[3];      // unit; 0 where the triangle has no area, which is not displaced
  float gradient[2][3]; // of the weights of its vertices 1 and 2, along the plane
  float depth;          // Material::heightScale as the view sees it
};
ReliefFrame reliefFrame(const Draw& draw, const uint32_t vertex[3]);

// Some draw is displaced.
bool anyRelief(Span<const Draw> draws);

// `covered` false: nothing is seen in the tile. Fills the planes that `out` has, GBuffer::relief and heightMap in the whole
// tile.
void displaceTile(const SurfaceContext& context, const TileBuffers& tile, bool covered, GBuffer& out, Target target);

namespace ref {  // the scalar twins
float heightAt(const HeightView& map, float u, float v);
}  // namespace ref

}  // namespace obscura::raster
