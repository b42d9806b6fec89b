// Atomic writing, and the list of temporaries that a signal handler may have to delete.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <new>

#include "obscura/engine/image_file.h"

namespace obscura::engine {
namespace {

// A signal handler may only touch lock-free atomics and memory that is always there: hence a global table. A path is
// written while its slot is Taken and read while it is Pending. Writes beyond its length go unlisted.
enum Slot : int { kFree, kTaken, kPending };
struct Pending {
  std::atomic<int> state{kFree};
  char path[PATH_MAX];
};
std::array<Pending, 16> pending;
static_assert(std::atomic<int>::is_always_lock_free, "needed in a signal handler");

// Lists `path` as long as it lives.
class Listed {
 public:
  explicit Listed(const std::string& path) {
    if (path.size() >= PATH_MAX) return;
    for (Pending& p : pending) {
      int expected = kFree;
      if (!p.state.compare_exchange_strong(expected, kTaken)) continue;
      std::memcpy(p.path, path.c_str(), path.size() + 1);
      p.state = kPending;
      slot_ = &p;
      return;
    }
  }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;
  ~Listed() {
    if (slot_) slot_->state = kFree;
  }

 private:
  Pending* slot_ = nullptr;
};

Error cannotWrite(const std::string& path, int error) {
  return Error{ErrorCode::CannotWrite, std::string("cannot write: ") + std::strerror(error), path, {}};
}

// 0, or the error of write(2).
int writeAll(int fd, raster::Span<const uint8_t> bytes) {
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t n = write(fd, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno != EINTR) return errno;
    if (n > 0) at += size_t(n);
  }
  return 0;
}

// 0, or the first error of writing and closing: a full disk may show up only at the end.
int writeAndClose(int fd, raster::Span<const uint8_t> bytes) {
  const int error = writeAll(fd, bytes);
  if (close(fd) != 0 && error == 0 && errno != EINTR) return errno;
  return error;
}

Result<Done> writeDirectly(const std::string& path, raster::Span<const uint8_t> bytes) {
  const int fd = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (fd < 0) return cannotWrite(path, errno);
  if (const int error = writeAndClose(fd, bytes)) return cannotWrite(path, error);
  return Done{};
}

// A name that nobody else has; that it is new is left to O_EXCL. Not mkstemp, which ignores the umask.
std::string temporaryBeside(const std::string& path, unsigned attempt) {
  timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  const size_t slash = path.rfind('/');
  return (slash == path.npos ? "" : path.substr(0, slash + 1)) + ".obscura-" + std::to_string(getpid()) + "-" +
         std::to_string(now.tv_nsec) + "-" + std::to_string(attempt) + ".tmp";
}

// Writes to a new file and renames it. `existing`: what stat says of `path`, or null.
Result<Done> replace(const std::string& path, raster::Span<const uint8_t> bytes, const struct stat* existing) {
  if (existing && access(path.c_str(), W_OK) != 0) return cannotWrite(path, errno);
  for (unsigned attempt = 0;; ++attempt) {
    const std::string temporary = temporaryBeside(path, attempt);
    const Listed listed(temporary);
    const int fd = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0 && errno == EEXIST && attempt < 100) continue;
    if (fd < 0) return cannotWrite(path, errno);
    int error = existing && fchmod(fd, existing->st_mode & 07777) != 0 ? errno : 0;
    const int written = writeAndClose(fd, bytes);
    if (error == 0) error = written;
    if (error == 0 && rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error == 0) return Done{};
    unlink(temporary.c_str());
    return cannotWrite(path, error);
  }
}

}  // namespace

Result<Done> writeFileAtomically(const std::string& path, raster::Span<const uint8_t> bytes) try {
  if (path == "-") {
    if (const int error = writeAll(STDOUT_FILENO, bytes)) return cannotWrite("standard output", error);
    return Done{};
  }
  struct stat info;
  if (stat(path.c_str(), &info) != 0) return replace(path, bytes, nullptr);
  if (!S_ISREG(info.st_mode)) return writeDirectly(path, bytes);
  char target[PATH_MAX];  // behind links, so that the link stays one
  return replace(realpath(path.c_str(), target) ? target : path, bytes, &info);
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::CannotWrite, "out of memory", path, {}};
}

void removePendingTemporaries() noexcept {
  const int saved = errno;
  for (Pending& p : pending)
    if (p.state == kPending) unlink(p.path);
  errno = saved;
}

}  // namespace obscura::engine
