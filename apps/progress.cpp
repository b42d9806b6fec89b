#include "obscura/apps/progress.h"

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

#include "obscura/apps/signals.h"

namespace obscura::apps {
namespace {

using namespace std::chrono_literals;
constexpr auto kQuietStart = 1s;
constexpr auto kInterval = 200ms;
constexpr int kWidth = 24;  // characters of the bar

}  // namespace

Progress::Progress(int steps, bool quiet) : steps_(steps) {
  if (quiet || !isatty(STDERR_FILENO)) return;
  // Signals stay with the thread that writes files: the handler must not run beside it.
  sigset_t all, old;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &old);
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {  // no thread, no bar
  }
  pthread_sigmask(SIG_SETMASK, &old, nullptr);
}

Progress::~Progress() { finish(); }

void Progress::step(const char* what) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++current_;
  what_ = what;
  fraction_ = -1;
}

void Progress::at(double fraction) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fraction_ = fraction;
}

void Progress::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::finish() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ = true;
  }
  changed_.notify_one();
  thread_.join();
  if (drawn_) std::fputs("\r\033[K", stderr);
  clearLineOnSignal(false);
}

void Progress::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  auto next = start_ + kQuietStart;
  while (!changed_.wait_until(lock, next, [this] { return done_; })) {
    draw();
    next += kInterval;
  }
}

void Progress::draw() {
  clearLineOnSignal(true);
  drawn_ = true;
  // Where it is not known how long a step will take, its cell fills from one end to the other in two seconds, again and
  // again.
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const int cell = kWidth / steps_, filled = (current_ - 1) * cell, moving = fraction_ < 0 ? int(seconds * cell / 2) % cell : int(fraction_ * cell);
  std::string bar(kWidth, ' ');
  for (int i = 0; i < kWidth && i < filled + moving; ++i) bar[size_t(i)] = '=';
  if (filled + moving < kWidth && filled + moving >= 0) bar[size_t(filled + moving)] = '>';
  std::fprintf(stderr, "\r[%s] %d/%d %s  %.1f s\033[K", bar.c_str(), current_, steps_, what_.c_str(), seconds);
}

}  // namespace obscura::apps
