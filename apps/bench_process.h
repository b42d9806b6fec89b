// Measurements in processes of their own: each one's memory is nobody else's, and one that takes too long is ended.
#pragma once

#include <cstddef>
#include <functional>

namespace obscura::apps {

struct ProcessMemory {
  double residentMb = 0, peakMb = 0;  // of this process: now (VmRSS) and at most so far (VmHWM); 0 where unknown
};
ProcessMemory processMemory();

// What new processes can have without swapping, MB; infinite where the system does not say.
double availableMemoryMb();

struct ChildEnd {
  int exitCode = 0;      // what `body` returned; 128 + n after signal n; 3: there was no process
  bool timedOut = false;
};

// Runs `body` in a child process and copies back what it has left in the `size` bytes at `result`. The caller has not
// started a thread so far. The child is ended after mostSeconds.
ChildEnd runInChild(const std::function<int()>& body, void* result, size_t size, unsigned mostSeconds);

}  // namespace obscura::apps
