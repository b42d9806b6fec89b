// The instruction sets every kernel is compiled for. They differ in speed, never in one bit of the result.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace obscura::raster {

enum class Target : uint8_t {
  Auto,    // the best that this CPU has
  Scalar,  // the SIMD source compiled for one lane (or emulated 128 bits, as the compiler allows)
  Ssse3,
  Sse4,
  Avx2,
  Avx3,  // AVX-512 F, CD, DQ, BW, VL
  Neon,
};

const char* targetName(Target target);                         // "auto", "scalar", "ssse3", ...
std::optional<Target> targetFromName(std::string_view name);  // empty: no such name

// What was compiled and runs on this CPU, best first; never empty, never contains Auto.
std::vector<Target> supportedTargets();

// Resolves Auto. A target that this CPU lacks becomes the best one: asking is never undefined behaviour
// (whoever must know checks supportedTargets()).
Target chooseTarget(Target wanted);

}  // namespace obscura::raster
