// What the ambient transfer can be asked for; names and symbols as in the papers (Szirmay-Kalos, Toth, Umenhoffer,
// "Efficient methods for ambient lighting").
#pragma once

#include <cstdint>

namespace obscura::post {

// Fuzzy measure mu(d) of how open a direction is that is blocked at distance d; 1 from the radius R on.
enum class Membership : uint8_t {
  Classic,      // 0: plain ambient occlusion
  Linear,       // d / R
  Sqrt,         // sqrt(d / R)
  Exponential,  // (1 - e^(-tau d)) / (1 - e^(-tau R)), tau = 5 / R
};

// What the surroundings are taken to send back, which makes the W.
enum class TransferAlbedo : uint8_t {
  Own,        // equation 4 of the short paper: a(y) = a(x), W(y) = W(x)
  Neighbour,  // equation 6 of the long one: W(y) = W(x), albedo read where the occluder is seen
  Radiance,   // section 4.1 of the long one: the radiance that the frame holds where the occluder is seen
};

// Where the pixel's rays come from.
enum class Estimator : uint8_t {
  Paper,  // one set of n points, turned by another angle in each pixel of a 4x4 pattern (long paper, section 5)
  Sobol,  // one scrambled Sobol net of 16 n points, dealt to the 16 pixels of the pattern (dealt_samples.h)
  Box,    // the same with the scramble that errs least over the 4x4 box
  Lines,  // rays through the eye instead, each tested all along (line_samples.h); dealt alike; linear membership only
  March,  // the rays of Box, followed through the depth map from test point to test point (ray_march.h)
};

// What a pixel of the filter's window must have in common with the pixel itself to count.
enum class FilterGuide : uint8_t {
  Depth,  // |z - z'| < the threshold, as in the papers
  Plane,  // it lies in the pixel's tangent plane, and its normal is much the same (depth_filter.h)
};

constexpr int kMaxSteps = 16;

struct AmbientSettings {
  TransferAlbedo albedo = TransferAlbedo::Neighbour;
  Membership membership = Membership::Linear;
  Estimator estimator = Estimator::Paper;
  int samples = 8;               // n, 1 ... 64 per pixel
  int steps = 1;                 // m, 1 ... kMaxSteps test points per ray
  float radius = 0.5f;           // R, scene units, > 0
  float bias = 0.005f;           // scene units, >= 0: how far behind the depth map a point must be to be inside
  bool silhouetteBound = true;   // what lies R or more behind the depth map is outside: no false silhouettes; false: inside
  int layers = 1;                // of depth that the containment test knows, 1 or 2; 2: GBuffer::depth2, best R apart
  bool interleave = true;        // other rays in each pixel of a 4x4 pattern
  bool filter = true;            // 4x4 box over pixels that have much in common
  FilterGuide filterGuide = FilterGuide::Depth;
  float filterThreshold = 0.1f;  // of FilterGuide::Depth: scene units, > 0
};

}  // namespace obscura::post
