// What a program says about a frame: digests, statistics, timings; as text or as one JSON object. And how it ends.
#pragma once

#include <string>
#include <vector>

#include "obscura/engine/aov.h"
#include "obscura/engine/frame.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

// Exit codes of all programs; 128 + n: ended by signal n.
enum ExitCode { kDone = 0, kDiffers = 1, kUsage = 2, kBadInput = 3, kCannotWrite = 4 };

void printWarning(const std::string& message);  // "obscura: warning: ..." on standard error, one line
int fail(const engine::Error& error);           // "obscura: error: ..."; returns the exit code

struct RunTimings {  // milliseconds; the frame's own are in Frame::timings
  double load = 0, environment = 0, encode = 0, write = 0, digest = 0;
};

// One line per AOV in the order given, see engine::digestLine; after "color" also "display", the picture's sRGB bytes.
std::vector<std::string> digestLines(const engine::Frame& frame, const std::vector<engine::Aov>& aovs, int threads = 1);

struct Report {
  std::vector<std::string> digests;  // as from digestLines; empty: not asked for
  const raster::Statistics* statistics = nullptr;
  const post::TransferStatistics* transfer = nullptr;  // goes with `statistics`
  const engine::LightStatistics* lights = nullptr;     // likewise
  const engine::FrameTimings* frame = nullptr;  // both or neither
  const RunTimings* run = nullptr;
};

// Text: the digest lines, then lines "NAME NUMBER".
std::string textOf(const Report& report);
// {"digests": [{"name", "size", "type", "hash"}...], "statistics": {NAME: NUMBER...}, "timings": {NAME:
// MILLISECONDS...}}
std::string jsonOf(const Report& report);

}  // namespace obscura::apps
