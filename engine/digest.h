// In: a plane or image.  Out: its digest, the line that golden tests compare.
#pragma once

#include <functional>
#include <string>

#include "obscura/engine/image.h"

namespace obscura::engine {

// An image that is never whole in memory: row(y), asked for in order, gives the bytes of row y until the next call.
struct RowSource {
  int width = 0, height = 0, channels = 0;
  Format format = Format::U8;
  std::function<const void*(int y)> row;
};

// XXH3-128 over the rows' decoded values, top row first, little-endian, without padding; 32 lower-case hex digits.
std::string digest(const Image& image);
std::string digest(const RowSource& rows);
// "NAME WxHxC TYPE HASH", TYPE one of u8, u16, u32, f32.
std::string digestLine(const std::string& name, const Image& image);
std::string digestLine(const std::string& name, const RowSource& rows);

}  // namespace obscura::engine
