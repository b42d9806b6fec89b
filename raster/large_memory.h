// Memory for what is large and written once: planes of a frame, environment maps.
#pragma once

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace obscura::raster {

// Uninitialised, from a 64-byte boundary on; to be given back by std::free. From 2 MB on in huge pages where the system has them:
// touching new memory page by page takes as long as filling it. Throws std::bad_alloc.
inline void* allocateLarge(size_t bytes) {
  constexpr size_t kHuge = size_t(2) << 20;
  const size_t unit = bytes >= kHuge ? kHuge : 64;
  if (bytes > size_t(-1) - unit) throw std::bad_alloc();
  void* memory = std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit);
  if (!memory) throw std::bad_alloc();
#if defined(__linux__)
  if (unit == kHuge) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  return memory;
}

}  // namespace obscura::raster
