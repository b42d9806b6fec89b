// What the benchmarks of errors share when they write their results.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "obscura/engine/image.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

std::string formatted(const char* format, ...);     // as printf, up to 511 bytes
std::string quoted(const std::string& text);        // a field of a CSV file
engine::Result<engine::Done> writeText(const std::string& path, const std::string& text);

// Error that a map shows in full colour, see ErrorMeter::map().
constexpr double kMapScale = 0.25;
constexpr char kMapHelp[] =
    "PNG of a row's error, of the first scene: white where it is right, red where too bright, blue where too dark, full at 0.25";

// From 0 on, of text that counts from 1. Usage: it names none of so many.
engine::Result<size_t> mapRow(const std::string& text, size_t rows);
engine::Result<engine::Done> writeErrorMap(const std::string& path, engine::Image map);

// All rows of all scenes: csvOf() them to one file, plotted to another, where these are named; tableOf() each, or jsonOf() all,
// to standard output.
template <class Scene, class Plot>
engine::Result<engine::Done> writeScenes(const std::vector<Scene>& scenes, const std::string& csv, const std::string& plot, bool json,
                                         const Plot& writePlot) {
  if (!csv.empty())
    if (const auto done = writeText(csv, csvOf(scenes)); !done) return done.error();
  if (!plot.empty())
    if (const auto done = writePlot(plot, scenes); !done) return done.error();
  std::string text = json ? jsonOf(scenes) : "";
  for (size_t k = 0; k < scenes.size() && !json; ++k) text += (k ? "\n" : "") + tableOf(scenes[k]);
  std::fputs(text.c_str(), stdout);
  return engine::Done{};
}

}  // namespace obscura::apps
