#include <catch2/catch.hpp>

#include <fcntl.h>
#include <grp.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <thread>

#include "obscura/engine/image_file.h"
#include "temporary_folder.h"

using namespace obscura::engine;
using Bytes = std::vector<uint8_t>;

namespace {

Bytes text(const std::string& s) { return Bytes(s.begin(), s.end()); }

mode_t modeOf(const std::string& path) {
  struct stat info = {};
  stat(path.c_str(), &info);
  return info.st_mode & 07777;
}

}  // namespace

TEST_CASE("write file: a file appears whole, with the umask's permissions, and nothing beside it") {
  const TemporaryFolder folder;
  const mode_t old = umask(027);
  const bool ok = writeFileAtomically(folder / "a", text("hello")).ok();
  umask(old);
  REQUIRE(ok);
  REQUIRE(contentOf(folder / "a") == "hello");
  REQUIRE(modeOf(folder / "a") == 0640);
  REQUIRE(folder.files() == 1);
}

TEST_CASE("write file: replacing keeps permissions and links") {
  const TemporaryFolder folder;
  REQUIRE(writeFileAtomically(folder / "a", text("old")).ok());
  chmod((folder / "a").c_str(), 0604);
  REQUIRE(symlink("a", (folder / "link").c_str()) == 0);
  REQUIRE(writeFileAtomically(folder / "link", text("new")).ok());
  REQUIRE(contentOf(folder / "a") == "new");
  REQUIRE(modeOf(folder / "a") == 0604);
  REQUIRE(std::filesystem::is_symlink(folder / "link"));
  REQUIRE(folder.files() == 2);
}

TEST_CASE("write file: a write that fails half-way leaves the old file and no temporary") {
  const TemporaryFolder folder;
  REQUIRE(writeFileAtomically(folder / "a", text("old")).ok());
  // A limit on the size of files stands for the full disk; in a child, for it holds for the whole process.
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto r = writeFileAtomically(folder / "a", Bytes(5000));
    _exit(!r.ok() && r.error().code == ErrorCode::CannotWrite && r.error().file == folder / "a" ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  REQUIRE(status == 0);
  REQUIRE(contentOf(folder / "a") == "old");
  REQUIRE(folder.files() == 1);
}

TEST_CASE("write file: what is no regular file is written to directly, and a full disk is an error with its reason") {
  const TemporaryFolder folder;
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  // The reader stops at a file, too: an implementation that replaces the pipe must not leave it waiting.
  const int reader = open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  const bool ok = writeFileAtomically(folder / "pipe", text("through the pipe")).ok();
  char received[100] = {};
  const ssize_t count = read(reader, received, sizeof received);
  close(reader);
  REQUIRE(ok);
  REQUIRE(std::filesystem::is_fifo(folder / "pipe"));
  REQUIRE(count == 16);
  REQUIRE(std::string(received) == "through the pipe");

  // The devices are tried without any right to replace them: what fails here must not break the machine it runs on.
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && (setgroups(0, nullptr) != 0 || setgid(65534) != 0 || setuid(65534) != 0)) _exit(3);
    if (access("/dev", W_OK) == 0) _exit(3);
    const bool null = writeFileAtomically("/dev/null", text("hello")).ok();
    const auto full = writeFileAtomically("/dev/full", text("hello"));
    if (!null || full.ok() || full.error().code != ErrorCode::CannotWrite) _exit(1);
    _exit(full.error().text() == "/dev/full: cannot write: No space left on device" ? 0 : 2);
  }
  int status = -1;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 3) WARN("the devices were not tried: this process could replace them");
  else REQUIRE(WEXITSTATUS(status) == 0);
}

TEST_CASE("write file: a missing folder, a folder as target and an empty name are errors") {
  const TemporaryFolder folder;
  REQUIRE(writeFileAtomically(folder / "no/a", text("x")).error().message == "cannot write: No such file or directory");
  REQUIRE(writeFileAtomically(folder.path, text("x")).error().message == "cannot write: Is a directory");
  REQUIRE_FALSE(writeFileAtomically("", text("x")).ok());
  REQUIRE(folder.files() == 0);
}

TEST_CASE("write file: a handler can delete what is half written, and only that") {
  const TemporaryFolder folder;
  REQUIRE(writeFileAtomically(folder / "kept", text("old")).ok());
  const pid_t child = fork();
  if (child == 0) {
    // The size limit's signal arrives in the middle of a write, as an interrupt would.
    signal(SIGXFSZ, [](int) {
      removePendingTemporaries();
      _exit(42);
    });
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    (void)writeFileAtomically(folder / "kept", Bytes(5000));
    _exit(1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  REQUIRE(WEXITSTATUS(status) == 42);
  REQUIRE(contentOf(folder / "kept") == "old");
  REQUIRE(folder.files() == 1);
  removePendingTemporaries();
  REQUIRE(contentOf(folder / "kept") == "old");
}

TEST_CASE("write file: many threads write at once and each gets its file") {
  const TemporaryFolder folder;
  std::vector<std::thread> threads;
  std::atomic<int> failures{0};
  for (int t = 0; t < 24; ++t)
    threads.emplace_back([&, t] {
      const Bytes bytes = text(std::string(3000, char('a' + t % 12)));
      for (int i = 0; i < 5; ++i) failures += !writeFileAtomically(folder / std::to_string(t % 12), bytes).ok();
    });
  for (std::thread& t : threads) t.join();
  REQUIRE(failures == 0);
  REQUIRE(folder.files() == 12);
  for (int t = 0; t < 12; ++t) REQUIRE(contentOf(folder / std::to_string(t)) == std::string(3000, char('a' + t)));
}
