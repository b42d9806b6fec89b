// Runs obscura-bench as a child process. What run_program.h runs: a file that includes this cannot share a test program with those
// that run another one.
#pragma once

#undef OBSCURA_PROGRAM
#define OBSCURA_PROGRAM OBSCURA_BIN_DIR "/obscura-bench"
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "cli_scene.h"
#include "run_program.h"

namespace obscura::tests {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

inline Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// What it prints with --json; it ends well.
inline Json printedBy(const Words& words) {
  const Finished f = runProgram(words + Words{"--json"});
  INFO(f.err);
  REQUIRE(f.code == 0);
  Json out = Json::parse(f.out, nullptr, false);
  REQUIRE(out.is_object());
  return out;
}

// Another one, and nothing on standard output.
inline void checkFails(const Words& words, int code) {
  const Finished f = runProgram(words);
  std::string all;
  for (const std::string& word : words) all += word + " ";
  INFO(all << f.err);
  CHECK(f.code == code);
  CHECK(f.out.empty());
  CHECK(!f.err.empty());
}

}  // namespace obscura::tests
