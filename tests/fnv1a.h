// FNV-1a, 64 bits: the digest of tests that pin bytes without the engine.
#pragma once

#include <cstddef>
#include <cstdint>

namespace obscura::tests {

constexpr uint64_t kFnvStart = 0xcbf29ce484222325ull;

inline uint64_t fnv1a(const void* data, size_t size, uint64_t h = kFnvStart) {
  for (size_t i = 0; i < size; ++i) h = (h ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ull;
  return h;
}

}  // namespace obscura::tests
