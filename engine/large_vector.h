// Vectors for what is large and written once: environment maps and what is made of them.
#pragma once

#include <cstdlib>
#include <new>
#include <vector>

#include "obscura/raster/large_memory.h"

namespace obscura::engine {

// As planes have it, see raster/large_memory.h.
template <class T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}

  T* allocate(size_t count) {
    if (count > size_t(-1) / sizeof(T)) throw std::bad_alloc();
    return static_cast<T*>(raster::allocateLarge(count * sizeof(T)));
  }
  void deallocate(T* memory, size_t) { std::free(memory); }

  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
  friend bool operator!=(const LargeAllocator&, const LargeAllocator&) { return false; }
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace obscura::engine
