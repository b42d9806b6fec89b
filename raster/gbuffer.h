// The G-buffer: what is seen in each pixel, one plane per scalar.
#pragma once

#include <algorithm>
#include <cstdint>

#include "obscura/raster/camera.h"
#include "obscura/raster/draw.h"
#include "obscura/raster/plane.h"

namespace obscura::raster {

// Which planes a frame needs. The others are not allocated, and nothing is computed for them.
struct PlaneSet {
  bool depth = false, normal = false, albedo = false, emissive = false, position = false;
  bool triangle = false, instance = false, material = false;
  bool depth2 = false, depthBack = false;
  float separation = 0;  // of depth2: scene units, positive and finite; not read without it
  bool relief = false;   // for the transfer of displaced surfaces; not without `normal`
  bool metallic = false, roughness = false;
  bool facet = false;

  // Nothing but depths: ids, normals and materials are not even kept per pixel, alpha is tested all the same.
  bool depthsAlone() const {
    return !(normal || albedo || emissive || position || triangle || instance || material || relief || metallic || roughness || facet);
  }
};

// Empty pixels hold: depths infinity; normal, facet, albedo, emissive, position, metallic and roughness 0;
// ids kNoTriangle.
//
// Behind the first layer, which is what `depth` shows, there can be two more. Both are the largest depth key (view.h) up
// to a limit that follows from the first layer's key, so they depend on no order, either:
//   depth2     of what competes for the first layer: single-sided triangles that face the eye, double-sided ones, where
//              alpha covers. The limit is the key of max(zView + separation, zView (1 + 2^-20)), in float: what is seen
//              never counts again, however small the separation. Infinity where the first layer is empty.
//   depthBack  of single-sided triangles that face away from the eye (both tests of setup.h with the sign turned), where
//              alpha covers. The limit is the first layer's key itself: this is where the solid that is seen ends, as far
//              as it is closed. Where the first layer is empty there is no limit: an eye inside a solid sees its wall.
//              Double-sided triangles have no inside and do not count, though they can be the first layer.
// Implicit surfaces take part as triangles would: where a ray enters one it faces the eye, where it leaves one it faces away.
struct GBuffer {
  int width = 0, height = 0;
  Plane<float> depth;        // zView: distance along the view axis, scene units
  Plane<float> normal[3];    // unit, camera space: x right, y up, z towards the eye
  Plane<float> facet[3];     // unit normal of the triangle itself, not interpolated, not mapped, on either side; else as normal
  Plane<float> albedo[3];    // linear, [0, 1]: base colour factor x texture x vertex colour; 0 where unlit
  Plane<float> emissive[3];  // linear, >= 0; the base colour where unlit
  Plane<float> position[3];  // camera space, scene units
  Plane<float> metallic;     // linear, [0, 1]: metallic factor x texture B; -0 where unlit: the sign says so
  Plane<float> roughness;    // linear, [0, 1]: roughness factor x texture G, perceptual as in glTF; 1 where unlit
  Plane<uint32_t> triangle;  // id, see DrawList
  Plane<uint32_t> instance;  // index into DrawList::instances, and beyond them into DrawList::implicits
  Plane<uint32_t> material;  // index into DrawList::materials
  Plane<float> depth2;       // zView of the nearest surface at least `separation` behind the first
  Plane<float> depthBack;    // zView of the nearest surface at or behind the first that is turned away
  // Of displaced surfaces (relief.h), what their height map needs to decide what lies inside. A point at an offset o
  // from the pixel's (view space) is at relief[0 ... 2] + (o . relief[3 ... 5], o . relief[6 ... 8], o . relief[9 ... 11]) in
  // the space of the map: u, v, height.
  Plane<uint32_t> heightMap;  // index into DrawList::heights; kNoTriangle where nothing is displaced
  Plane<float> relief[12];    // 0 there

  GBuffer() = default;
  GBuffer(int width, int height, const PlaneSet& planes);
  bool has(const PlaneSet& planes) const;  // these are there, and no others
};

// The part of `from` that lies in the window (inside of it, counted from its own first pixel); planes that `from` does not
// hold are empty. Memory of the right size is kept.
template <class T>
void cutOut(const Plane<T>& from, const Window& part, Plane<T>& to) {
  to.resize(from.empty() ? 0 : part.width, from.empty() ? 0 : part.height);
  for (int y = 0; y < to.height(); ++y) std::copy_n(from.row(part.y + y) + part.x, part.width, to.row(y));
}
void cutOut(const GBuffer& from, const Window& part, GBuffer& to);

}  // namespace obscura::raster
