// Chance and noise for the demo scene: integers and + - * only, so that the scene has the same bytes everywhere.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/vec3.hpp>

namespace obscura::apps {

inline double dot(glm::dvec3 a, glm::dvec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline glm::dvec3 cross(glm::dvec3 a, glm::dvec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline glm::dvec3 unit(glm::dvec3 v) { return v / std::sqrt(dot(v, v)); }  // v != 0
inline double mix(double a, double b, double t) { return a + (b - a) * t; }
inline glm::dvec3 mix(glm::dvec3 a, glm::dvec3 b, double t) { return a + (b - a) * t; }
inline double clamp01(double t) { return t < 0 ? 0 : t > 1 ? 1 : t; }
inline double smoothstep(double lo, double hi, double x) {
  const double t = clamp01((x - lo) / (hi - lo));
  return t * t * (3 - 2 * t);
}

inline uint64_t scramble(uint64_t z) {  // the finaliser of SplitMix64
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  double in(double lo, double hi) {
    state_ += 0x9E3779B97F4A7C15ull;
    return lo + (hi - lo) * (double(scramble(state_) >> 11) * 0x1p-53);
  }
  int below(int n) { return int(in(0, n)); }
  glm::dvec3 direction() {  // uniform on the sphere
    for (;;) {
      glm::dvec3 v;
      v.x = in(-1, 1);
      v.y = in(-1, 1);
      v.z = in(-1, 1);
      const double d = dot(v, v);
      if (d <= 1 && d > 0.01) return unit(v);
    }
  }

 private:
  uint64_t state_;
};

// Smooth value noise in [-1, 1], one feature per unit; its first two derivatives are continuous.
inline double noise(glm::dvec3 p, uint64_t seed) {
  const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const double tx = fade(p.x - fx), ty = fade(p.y - fy), tz = fade(p.z - fz);
  const auto corner = [&](int dx, int dy, int dz) {
    const uint64_t x = uint64_t(int64_t(fx) + dx), y = uint64_t(int64_t(fy) + dy), z = uint64_t(int64_t(fz) + dz);
    return double(scramble(seed + x * 0x8DA6B343ull + y * 0xD8163841ull + z * 0xCB1AB31Full) >> 11) * 0x1p-52 - 1;
  };
  const auto edge = [&](int dy, int dz) { return mix(corner(0, dy, dz), corner(1, dy, dz), tx); };
  return mix(mix(edge(0, 0), edge(1, 0), ty), mix(edge(0, 1), edge(1, 1), ty), tz);
}

// Octaves of noise, each half as high and twice as fine as the one before; below 2 in magnitude.
inline double fractalNoise(glm::dvec3 p, int octaves, uint64_t seed) {
  double sum = 0, weight = 1;
  for (int i = 0; i < octaves; ++i, weight *= 0.5, p *= 2.0) sum += weight * noise(p, seed + uint64_t(i));
  return sum;
}

}  // namespace obscura::apps
