// What every failure of the program must look like.
#pragma once

#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "run_program.h"

namespace obscura::tests {

// The documented exit code, nothing on standard output, one line on standard error.
inline void checkFailure(const Finished& f, int code, const std::string& says) {
  INFO(f.err);
  CHECK(f.code == code);
  CHECK(f.out.empty());
  CHECK(f.err.rfind("obscura: error: ", 0) == 0);
  CHECK(std::count(f.err.begin(), f.err.end(), '\n') == 1);
  CHECK(f.err.find(says) != std::string::npos);
}

}  // namespace obscura::tests
