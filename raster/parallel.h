// Threads: the only way in which raster and post run anything in parallel.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace obscura::raster {

// A pool of a fixed number of workers (oneTBB's, shared with the host's; nothing is created before the first use).
// Not to be entered from two threads at once; several pools may be.
class Parallel {
 public:
  explicit Parallel(int threads = 0);  // 0: as many as the machine has
  ~Parallel();
  Parallel(Parallel&&) noexcept;
  Parallel& operator=(Parallel&&) noexcept;

  int workers() const { return workers_; }

  // Calls body(begin, end, worker) for disjoint ranges that cover [0, count), each `grain` long but the last; worker
  // is in [0, workers()) and never the same for two calls at a time. Each call runs in the default floating-point
  // environment, whatever the host's is. An exception of a body ends the loop and is thrown here.
  void forRanges(size_t count, size_t grain, const std::function<void(size_t, size_t, int)>& body);

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
  int workers_ = 1;
};

}  // namespace obscura::raster
