// Threads: the only way in which raster and post run anything in parallel.
#pragma once

#include <cstddef>
#include <functional>

namespace obscura::raster {

// A number of workers: oneTBB's threads, shared with the host's. At most that many work at once, and never more than the
// arena has that the caller is in: as many as the machine has cores, unless the host or withThreads() says otherwise.
// Several may be entered at once.
class Parallel {
 public:
  explicit Parallel(int threads = 0);  // 0: as many as the caller's arena has

  int workers() const { return workers_; }

  // Calls body(begin, end, worker) for disjoint ranges that cover [0, count), each `grain` long but the last; worker
  // is in [0, workers()) and never the same for two calls at a time. Each call runs in the default floating-point
  // environment, whatever the host's is. An exception of a body ends the loop and is thrown here.
  void forRanges(size_t count, size_t grain, const std::function<void(size_t, size_t, int)>& body) const;

 private:
  int workers_ = 1;
};

// Calls body() where `threads` threads can work at once, on however few cores.
void withThreads(int threads, const std::function<void()>& body);

}  // namespace obscura::raster
