#include "obscura/apps/bench_process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

namespace obscura::apps {
namespace {

// "NAME:   1234 kB" in a file of /proc, in MB; `otherwise` where there is no such line.
double megabytesOf(const char* path, const std::string& name, double otherwise) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (line.compare(0, name.size() + 1, name + ":") == 0)
      return std::strtod(line.c_str() + name.size() + 1, nullptr) / 1024;
  return otherwise;
}

}  // namespace

ProcessMemory processMemory() {
  constexpr const char* kStatus = "/proc/self/status";
  return {megabytesOf(kStatus, "VmRSS", 0), megabytesOf(kStatus, "VmHWM", 0)};
}

double availableMemoryMb() {
  return megabytesOf("/proc/meminfo", "MemAvailable", std::numeric_limits<double>::infinity());
}

ChildEnd runInChild(const std::function<int()>& body, void* result, size_t size, unsigned mostSeconds) {
  int ends[2];
  if (pipe(ends) != 0) return {3, false};
  std::fflush(nullptr);  // or the child would print it once more
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    std::signal(SIGALRM, SIG_DFL);
    alarm(mostSeconds);
    const int code = body();
    const bool written = write(ends[1], result, size) == ssize_t(size);  // little enough for one write
    _exit(code == 0 && !written ? 3 : code);
  }
  close(ends[1]);
  size_t at = 0;
  for (ssize_t n = 1; child > 0 && at < size && n > 0; at += n > 0 ? size_t(n) : 0)
    n = read(ends[0], static_cast<char*>(result) + at, size - at);
  close(ends[0]);
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return {3, false};
  if (WIFEXITED(status)) return {WEXITSTATUS(status), false};
  return {128 + WTERMSIG(status), WTERMSIG(status) == SIGALRM};
}

}  // namespace obscura::apps
