// Runs the program under test as a child process.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "temporary_folder.h"

extern char** environ;

// Starts OBSCURA_PROGRAM with its streams on these files; returns its process id, or -1.
inline pid_t startProgram(const std::vector<std::string>& arguments, const std::string& out, const std::string& err) {
  std::vector<std::string> words = {OBSCURA_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY, 0600);
  pid_t pid = -1;
  if (posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ) != 0) pid = -1;
  posix_spawn_file_actions_destroy(&actions);
  return pid;
}

// The exit code as a shell shows it, 128 + n after a signal; -1: it did not run.
inline int exitCodeOf(pid_t pid) {
  int status = 0;
  if (pid < 0 || waitpid(pid, &status, 0) != pid) return -1;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

struct Finished {
  int code = -1;
  std::string out, err;
};

inline Finished runProgram(const std::vector<std::string>& arguments) {
  const TemporaryFolder streams;
  Finished f;
  f.code = exitCodeOf(startProgram(arguments, streams / "out", streams / "err"));
  f.out = contentOf(streams / "out");
  f.err = contentOf(streams / "err");
  return f;
}
