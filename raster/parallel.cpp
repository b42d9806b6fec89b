#include "obscura/raster/parallel.h"

#include <algorithm>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "obscura/raster/float_environment.h"

namespace obscura::raster {

struct Parallel::Arena {
  explicit Arena(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Parallel::Parallel(int threads) : workers_(threads > 0 ? threads : tbb::this_task_arena::max_concurrency()) {}
Parallel::~Parallel() = default;
Parallel::Parallel(Parallel&&) noexcept = default;
Parallel& Parallel::operator=(Parallel&&) noexcept = default;

void Parallel::forRanges(size_t count, size_t grain, const std::function<void(size_t, size_t, int)>& body) {
  if (count == 0) return;
  grain = std::max<size_t>(grain, 1);
  const size_t ranges = (count + grain - 1) / grain;
  auto run = [&](size_t range, int worker) {
    const FloatEnvironment environment;
    body(range * grain, std::min(count, (range + 1) * grain), worker);
  };
  if (workers_ == 1 || ranges == 1) {
    for (size_t r = 0; r < ranges; ++r) run(r, 0);
    return;
  }
  auto loop = [&] {
    tbb::parallel_for(
        size_t(0), ranges, [&](size_t r) { run(r, tbb::this_task_arena::current_thread_index()); },
        tbb::simple_partitioner());
  };
  // The caller's own arena serves if it has the right size. One more arena would be one between which oneTBB moves its
  // workers so slowly that loops of a millisecond run on one thread.
  if (!arena_ && tbb::this_task_arena::max_concurrency() == workers_) return loop();
  if (!arena_) arena_ = std::make_unique<Arena>(workers_);
  arena_->arena.execute(loop);
}

}  // namespace obscura::raster
