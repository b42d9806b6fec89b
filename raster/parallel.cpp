#include "obscura/raster/parallel.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "obscura/raster/float_environment.h"

namespace obscura::raster {

Parallel::Parallel(int threads) : workers_(threads > 0 ? threads : tbb::this_task_arena::max_concurrency()) {}

namespace {

// The ranges that are left of a worker's share, on a cache line of its own.
struct alignas(64) Share {
  std::atomic<size_t> next{0};
  size_t end = 0;
};

}  // namespace

// One task a worker. It takes the ranges of its own share one by one, so that a core meets in each loop the rows that it had
// in the one before, and then what others have left. No arena of its own limits the threads: between two arenas oneTBB
// moves its workers so slowly that loops of a millisecond run on one thread, and programs that make and use thousands of
// arenas can hang in it (oneTBB's issue 1281).
void Parallel::forRanges(size_t count, size_t grain, const std::function<void(size_t, size_t, int)>& body) const {
  if (count == 0) return;
  grain = std::max<size_t>(grain, 1);
  const size_t ranges = (count + grain - 1) / grain, tasks = std::min(ranges, size_t(workers_));
  std::vector<Share> shares(tasks);
  for (size_t t = 0; t < tasks; ++t) shares[t].next = ranges * t / tasks, shares[t].end = ranges * (t + 1) / tasks;
  std::atomic<bool> failed{false};
  const auto work = [&](size_t worker) {
    const FloatEnvironment environment;
    try {
      for (size_t k = 0; k < tasks; ++k) {
        Share& share = shares[(worker + k) % tasks];
        for (size_t r; !failed.load(std::memory_order_relaxed) && (r = share.next.fetch_add(1, std::memory_order_relaxed)) < share.end;)
          body(r * grain, std::min(count, (r + 1) * grain), int(worker));
      }
    } catch (...) {
      failed = true;
      throw;
    }
  };
  if (tasks == 1) work(0);
  else tbb::parallel_for(size_t(0), tasks, work, tbb::simple_partitioner());
}

void withThreads(int threads, const std::function<void()>& body) {
  if (threads <= tbb::this_task_arena::max_concurrency()) return body();
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, size_t(threads));
  tbb::task_arena arena(threads);
  arena.execute(body);
}

}  // namespace obscura::raster
