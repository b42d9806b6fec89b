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

// Which surroundings W takes for granted.
enum class TransferAlbedo : uint8_t {
  Own,        // equation 4 of the short paper: a(y) = a(x), W(y) = W(x)
  Neighbour,  // equation 6 of the long one: W(y) = W(x), albedo read where the occluder is seen
};

struct AmbientSettings {
  TransferAlbedo albedo = TransferAlbedo::Neighbour;
  Membership membership = Membership::Linear;
  int samples = 8;               // n, 1 ... 64 per pixel
  int steps = 1;                 // m, 1 ... 4 test points per ray
  float radius = 0.5f;           // R, scene units, > 0
  float bias = 0.005f;           // scene units, >= 0: how far behind the depth map a point must be to be inside
  bool silhouetteBound = true;   // what lies R or more behind the depth map is outside: no false silhouettes; false: inside
  bool interleave = true;        // rotate the set from pixel to pixel, in a 4x4 pattern
  bool filter = true;            // 4x4 box over the pixels of nearly the same depth
  float filterThreshold = 0.1f;  // scene units, > 0
};

}  // namespace obscura::post
