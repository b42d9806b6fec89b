#include "obscura/post/dealt_samples.h"

#include "obscura/post/sample_sets.h"

namespace obscura::post {
namespace {

constexpr int kBits = 16;  // of a coordinate: 16 n <= 2^10 points differ in the first ten

// Direction numbers v_k, k = 0, 1, ..., as fractions of 2^16: coordinate = xor of those of the index's bits. Dimension 0
// mirrors the bits; 1 has the primitive polynomial x + 1; 2 has x^2 + x + 1 and starts with 1/2, 3/4.
struct Directions {
  uint32_t v[3][kBits];
  constexpr Directions() : v() {
    for (int k = 0; k < kBits; ++k) v[0][k] = 1u << (kBits - 1 - k);
    v[1][0] = v[2][0] = 1u << (kBits - 1);
    v[2][1] = 3u << (kBits - 2);
    for (int k = 1; k < kBits; ++k) v[1][k] = v[1][k - 1] ^ v[1][k - 1] >> 1;
    for (int k = 2; k < kBits; ++k) v[2][k] = v[2][k - 1] ^ v[2][k - 2] ^ v[2][k - 2] >> 2;
  }
};

uint32_t sobol(const Directions& directions, int dimension, uint32_t index) {
  uint32_t x = 0;
  for (int k = 0; index >> k != 0; ++k)
    if (index >> k & 1) x ^= directions.v[dimension][k];
  return x;
}

uint64_t mixed(uint64_t z) {  // the finalizer of SplitMix64
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

// The bits above a bit, with a 1 before them, are its node in the binary tree of all prefixes.
uint32_t scrambled(uint32_t x, int dimension, uint32_t seed) {
  uint32_t flips = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    const uint64_t node = (1u << kBits | x) >> (bit + 1);
    flips |= uint32_t(mixed(uint64_t(seed) << 32 | uint64_t(dimension) << 24 | node) & 1) << bit;
  }
  return x ^ flips;
}

// Where in Z order the pixel p = x + 4 y of the pattern comes.
constexpr uint32_t zOrder(uint32_t p) { return (p & 1) | (p >> 1 & 2) | (p << 1 & 4) | (p & 8); }

}  // namespace

std::vector<glm::vec3> dealtSamples(int n, uint32_t seed) {
  if (n < 1 || n > kMaxSamples) return {};
  constexpr Directions directions;
  constexpr int kDimension[3] = {2, 0, 1};  // of xi_x, xi_y, xi_z
  std::vector<glm::vec3> points(size_t(16 * n));
  for (uint32_t p = 0; p < 16; ++p)
    for (int i = 0; i < n; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const uint32_t x = sobol(directions, kDimension[axis], zOrder(p) * uint32_t(n) + uint32_t(i));
        points[p * size_t(n) + size_t(i)][axis] = (float(scrambled(x, axis, seed)) + 0.5f) * 0x1p-16f;
      }
  return points;
}

}  // namespace obscura::post
