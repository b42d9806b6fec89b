// Loops over ranges: each once, by workers that do not meet.
#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "obscura/raster/parallel.h"

using obscura::raster::Parallel;
using obscura::raster::withThreads;

TEST_CASE("parallel: every element is in one range, and no worker has two at a time") {
  withThreads(8, [] {
    for (const int threads : {1, 2, 3, 8, 40})
      for (const size_t count : {0, 1, 7, 64, 1000})
        for (const size_t grain : {0, 1, 3, 100}) {
          std::vector<std::atomic<int>> seen(count), busy(static_cast<size_t>(threads));
          std::atomic<int> wrong{0};
          Parallel(threads).forRanges(count, grain, [&](size_t begin, size_t end, int worker) {
            wrong += worker < 0 || worker >= threads || begin >= end || end > count || end - begin > std::max<size_t>(grain, 1);
            wrong += busy[size_t(worker)]++ != 0;
            for (size_t i = begin; i < end; ++i) ++seen[i];
            --busy[size_t(worker)];
          });
          INFO(threads << " threads, " << count << " by " << grain);
          CHECK(wrong == 0);
          CHECK(std::all_of(seen.begin(), seen.end(), [](const std::atomic<int>& n) { return n == 1; }));
        }
  });
}

TEST_CASE("parallel: as many work at once as there may be, and what one leaves the others take") {
  for (const int threads : {2, 3, 8})
    withThreads(threads, [threads] {
      std::atomic<int> working{0};
      std::vector<int> calls(size_t(threads), 0);
      const auto start = std::chrono::steady_clock::now();
      const auto tooLate = [&] { return std::chrono::steady_clock::now() - start > std::chrono::seconds(60); };
      // The first range of each waits for all the others: in fewer threads it would wait for ever.
      Parallel(threads).forRanges(size_t(threads) * 20, 1, [&](size_t, size_t, int worker) {
        if (calls[size_t(worker)]++ > 0) return;
        ++working;
        while (working < threads && !tooLate()) std::this_thread::yield();
      });
      CHECK(working == threads);
      // The worker that begins at 0 stays there until the rest is done.
      std::atomic<size_t> done{0};
      Parallel(threads).forRanges(1000, 1, [&](size_t begin, size_t, int) {
        while (begin == 0 && done < 999 && !tooLate()) std::this_thread::yield();
        ++done;
      });
      CHECK(done == 1000);
      CHECK_FALSE(tooLate());
    });
}

TEST_CASE("parallel: an exception ends the loop and is thrown to the caller, who can go on") {
  withThreads(3, [] {
    for (const int threads : {1, 3}) {
      const Parallel parallel(threads);
      std::atomic<int> calls{0};
      const auto fails = [&](size_t begin, size_t, int) {
        ++calls;
        if (begin == 0) throw std::runtime_error("as the test wants it");
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      };
      CHECK_THROWS_AS(parallel.forRanges(100000, 1, fails), std::runtime_error);
      CHECK(calls < 50000);
      calls = 0;
      parallel.forRanges(100, 1, [&](size_t, size_t, int) { ++calls; });
      CHECK(calls == 100);
    }
  });
}
