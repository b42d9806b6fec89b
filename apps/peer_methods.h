// In:  depth and normals of the G-buffer.
// Out: the occlusion that other people's screen-space methods find: the peers that obscura's estimators are measured
//      against, written from the publications and given the care that the estimators have: rows of pixels in vectors, points
//      dealt to the 4x4 pattern, the project's filter after them, the same bytes on every machine.
//
// In all of them x is the point seen, N its normal, V the direction to the eye, R the radius, z* the depth map at a point's
// texel. What lies between z* and z* + R is inside: none needs a bias, and all are worse with one. Each fills TransferSums as the ambient transfer does: n times its
// openness, so that depthFilter() divides by n and the pixels that count; clampPeers() then, as these can leave [0, 1].
//
// Ssao   Mittring, "Finding next gen: CryEngine 2" (2007), 8.5.4.3: n points of the ball of radius R about x; twice the part
//        that is outside, so that a plane is open. Normals are not used. Points behind what is R or more nearer than x are
//        undecided, and count half. Points come as pairs about x, so that a plane is open; where n is odd they do
//        not, and it is open only in the mean.
// Hbao   Bavoil, Sainz, Dimitrov, "Image-space horizon-based ambient occlusion" (2008): n directions in the image, m steps
//        in each; sum of W(d) (sin h - sin h') over the horizon as it rises from the tangent plane, W = 1 - (d / R)^2, over n.
//        Differs: the elevation is measured from the plane across V, since that is what the eye's rays and the image's
//        directions span; no angle bias, which is there to hide coarse meshes; steps grow with the square.
// Vao    Szirmay-Kalos, Umenhoffer, Toth, Szecsi, Sbert, "Volumetric ambient occlusion for real-time rendering and games"
//        (2010): n lines along V through the sphere of radius R / 2 that touches the surface at x; the part of their length
//        that is outside. Differs: along V and not along the view axis, which makes it right off the image's centre, too.
// Gtao   Jimenez, Wu, Pesce, Jarabo, "Practical real-time strategies for accurate indirect occlusion" (2016): n slices, m
//        steps to both sides, with a cosine's weight in closed form. A horizon sinks to the tangent plane towards R:
//        from kGtaoFalloff R on. acos c - c sqrt(1 - c^2), which the closed form needs, is a polynomial that errs by less
//        than 6e-6; steps grow with the square. Differs: the thickness heuristic is left out.
//
// Both horizon methods take the point at the centre of a texel, which lies beside the slice by up to half a pixel. Differs:
// it is turned into the slice about N with its height over the tangent plane kept, so that a plane is open, however steep.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "obscura/apps/setting_names.h"
#include "obscura/post/ambient_transfer.h"
#include "obscura/post/depth_filter.h"

namespace obscura::apps {

enum class PeerMethod : uint8_t { Ssao, Hbao, Vao, Gtao };
inline const Names<PeerMethod> kPeerMethodNames = {
    {"ssao", PeerMethod::Ssao}, {"hbao", PeerMethod::Hbao}, {"vao", PeerMethod::Vao}, {"gtao", PeerMethod::Gtao}};

// What the falloff is chosen for: what its publication says, or to be as near as it can to O of the linear membership:
// Ssao: points evenly distributed by their distance; Hbao: W = 1 - d / R; Gtao: from kGtaoFalloffToO R on; Vao has none.
enum class PeerAim : uint8_t { Own, Obscurance };

// 0.6 to 0.99 and 0.3 to 0.9 were tried on two scenes: the later, the nearer to the truth. A hard end is none of the method.
constexpr float kGtaoFalloff = 0.9f, kGtaoFalloffToO = 0.8f;

struct PeerSettings {
  PeerMethod method = PeerMethod::Ssao;
  PeerAim aim = PeerAim::Own;
  int steps = 4;  // m, 1 ... 16; of Hbao and Gtao
};

// 16 n points for TransferInput::offsets, n = settings.samples, those of a pixel of the pattern together:
//   Ssao        the point, scene units, camera space
//   Vao         in the disc across V, scene units; and the half of the line's length
//   Hbao, Gtao  cosine and sine of the direction in the image, and where in its steps the points lie, in [0, 1)
std::vector<glm::vec3> peerPoints(const PeerSettings& peer, const post::AmbientSettings& settings);

// Rows y0 ... y1 - 1. Where the G-buffer makes no number of it, nothing is open. Of the settings samples, radius and silhouetteBound count; the G-buffer is all that is known, also around a crop.
void peerOcclusion(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out,
                   raster::Target target);
void peerOcclusionRef(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out);  // the twin

// To [0, 1], after the filter.
void clampPeers(int y0, int y1, post::Transfer& out);

}  // namespace obscura::apps
