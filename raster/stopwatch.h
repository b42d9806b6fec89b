// How long the stages of a frame take.
#pragma once

#include <chrono>
#include <utility>

namespace obscura::raster {

class Stopwatch {
 public:
  // Milliseconds since the last lap, or since it was made.
  double lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace obscura::raster
