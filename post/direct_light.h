// In:  depth, normals, albedo, metallic and roughness; lights and their shadow maps.
// Out: linear colour: the light of these lights that is reflected once towards the eye, sum_k f E_k max(0, n . l_k).
//
// Units and falloff are those of KHR_lights_punctual. E of a light at the distance d is its colour times the falloff; f is
// that of brdf.h. A white Lambertian surface that a directional light of pi lux meets squarely has radiance 1.
//
// Shadows: the light's part that arrives is the part of a square of 2 x 2 texels about the point in the light's map in which
// nothing nearer is stored (percentage-closer filtering, Reeves et al. 1987): 3 x 3 texels, by how much of each lies in the
// square, in steps of 1/16 a side, so that the sum of nine is exact. What is nearer is decided at each texel's own centre, against
// the plane of the receiver's triangle, so that contact shadows reach their casters.
//
// The map's key k (1 / w, or -w orthographic; nearer is larger) of a plane n . x = c is affine in the map. With V = (x, y, w) of
// the receiver, or (0, 0, 1) orthographic, and D = n . V it grows by g = n.xy / (scale D) a texel. A texel is in shadow if its
// key exceeds k + g . (its centre - the point) + bias, and the bias is what may be wrong with that plane:
//   (|g.x| + |g.y|) / 256    vertices are snapped to 1/256 texel, which moves the stored plane by at most half of that
//   r t (|D| + |V|) / (|D| (|D| - t |V|))   the surface within the filter, whose farthest centre is 1.5 texels away along each
//       axis, r = 1.5 |1 / scale| in light space, may turn by the angle asin t, as curved meshes do from triangle to triangle:
//       n' = n + t e, |e| = 1, changes the key there by at most r ((1 + t) / (|D| - t |V|) - 1 / |D|), as |n.xy| <= 1
//   s / |D| (times k, perspective)   the point itself lies off the plane by s: its camera snapped the triangle to 1/256 pixel,
//       which moves a plane by at most that part of a pixel's width there, and positions are rounded: 2^-20 of their size
// t = 1/16. What a light grazes at less than 7 degrees has the second term of 7 degrees, |D| = 2 t |V|, as no angle would be
// enough; and |D| is never below |V| / 1024.
#pragma once

#include "obscura/post/brdf.h"
#include "obscura/post/linear_color.h"
#include "obscura/post/punctual_light.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/span.h"
#include "obscura/raster/target.h"

namespace obscura::post {

struct DirectLightInput {
  // Depth, normal, albedo; facet where there are shadow maps; metallic and roughness where isGlossy(brdf).
  const raster::GBuffer* g = nullptr;
  Projector projector;                 // of the camera
  raster::Span<const PunctualLight> lights;
  Brdf brdf = Brdf::Lambert;
  bool skip = true;                    // leave out lights whose range or cone reaches nothing of a block; changes no bit
  bool add = false;                    // to what `out` holds, else from 0
};

// Every pixel of the rows y0 ... y1 - 1 is written; 0 where nothing is seen.
void directLight(const DirectLightInput& in, int y0, int y1, LinearColor& out, raster::Target target);
void directLightRef(const DirectLightInput& in, int y0, int y1, LinearColor& out);  // the scalar twin

// The part of a light's colour that arrives at one point of camera space, falloff, cosine and shadow; n: the unit normal of its
// triangle, which lights it, too. Scalar code, for points that are no pixels.
float arrivingAt(const PunctualLight& light, const glm::vec3& p, const glm::vec3& n);

// Which maps of a light the pixels of these rows need, one bit each; 1 of one without any. 0: it reaches none.
uint32_t mapsReached(const DirectLightInput& in, const PunctualLight& light, int y0, int y1, raster::Target target);
uint32_t mapsReachedRef(const DirectLightInput& in, const PunctualLight& light, int y0, int y1);  // the scalar twin

// A box around what is seen in these rows, in light space (of one map); empty: min > max.
struct LightBounds {
  glm::vec3 min{1e30f}, max{-1e30f};
  void add(const LightBounds& b);
};
LightBounds boundsInLight(const raster::Plane<float>& depth, const Projector& projector, const PunctualLight& light, int y0, int y1,
                          raster::Target target);
LightBounds boundsInLightRef(const raster::Plane<float>& depth, const Projector& projector, const PunctualLight& light, int y0, int y1);

}  // namespace obscura::post
