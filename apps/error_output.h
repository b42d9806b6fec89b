// What the benchmarks of errors share when they write their results.
#pragma once

#include <string>

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

}  // namespace obscura::apps
