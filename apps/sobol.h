// Points for quasi-Monte Carlo: the first two dimensions of Sobol's sequence, Owen-scrambled.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace obscura::apps {

inline uint32_t hashed(uint32_t x) {  // a mixer of 32 bits
  x ^= x >> 16, x *= 0x7FEB352Du;
  x ^= x >> 15, x *= 0x846CA68Bu;
  return x ^ x >> 16;
}
inline uint32_t hashed(uint32_t a, uint32_t b) { return hashed(a ^ (hashed(b) + 0x9E3779B9u + (a << 6) + (a >> 2))); }

inline uint32_t reversedBits(uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00FF00FFu) << 8 | (x & 0xFF00FF00u) >> 8;
  x = (x & 0x0F0F0F0Fu) << 4 | (x & 0xF0F0F0F0u) >> 4;
  x = (x & 0x33333333u) << 2 | (x & 0xCCCCCCCCu) >> 2;
  return (x & 0x55555555u) << 1 | (x & 0xAAAAAAAAu) >> 1;
}

// Nested uniform scrambling by a hash, after Laine and Karras; constants of Burley, "Practical hash-based Owen scrambling"
// (JCGT 9(4), 2020). Permutes the bits' values from the highest down, each by those above it.
inline uint32_t owenScrambled(uint32_t x, uint32_t seed) {
  x = reversedBits(x);
  x += seed;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return reversedBits(x);
}

// Point `index` of the scramble `seed`, in [0, 1)^2. Any 2^k points from a multiple of 2^k on have one in each of the 2^k
// boxes of any shape 2^-i x 2^-(k-i); scrambles of different seeds are independent, and so is the order of their points:
// several of them, padded, make a point of more dimensions (Burley, section 3.3).
inline glm::dvec2 sobolPoint(uint32_t index, uint32_t seed) {
  index = owenScrambled(index, hashed(seed));
  // The second dimension's generator matrix is Pascal's triangle modulo 2: bit i of the result is the sum of the index's
  // bits j whose number contains that of i (Lucas), five steps of pairs.
  uint32_t y = index;
  y ^= y >> 16 & 0x0000FFFFu;
  y ^= y >> 8 & 0x00FF00FFu;
  y ^= y >> 4 & 0x0F0F0F0Fu;
  y ^= y >> 2 & 0x33333333u;
  y ^= y >> 1 & 0x55555555u;
  return {owenScrambled(reversedBits(index), hashed(seed, 1)) * 0x1p-32,
          owenScrambled(reversedBits(y), hashed(seed, 2)) * 0x1p-32};
}

}  // namespace obscura::apps
