#include "obscura/apps/signals.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "obscura/engine/image_file.h"

namespace obscura::apps {
namespace {

std::atomic<bool> clearLine{false};
static_assert(std::atomic<bool>::is_always_lock_free, "needed in a signal handler");

void end(int signal) {
  engine::removePendingTemporaries();
  if (clearLine) {
    constexpr char kClear[] = "\r\033[K";
    [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kClear, sizeof kClear - 1);
  }
  _exit(128 + signal);
}

}  // namespace

void endCleanlyOnSignals() {
  struct sigaction action = {};
  action.sa_handler = end;
  sigfillset(&action.sa_mask);
  for (int s : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGXCPU}) {
    struct sigaction old = {};
    if (sigaction(s, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) sigaction(s, &action, nullptr);
  }
  signal(SIGXFSZ, SIG_IGN);
}

void clearLineOnSignal(bool clear) noexcept { clearLine = clear; }

}  // namespace obscura::apps
