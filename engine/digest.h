// In: a plane or image.  Out: its digest, the line that golden tests compare.
#pragma once

#include <string>

#include "obscura/engine/image.h"

namespace obscura::engine {

// XXH3-128 over the rows' decoded values, top row first, little-endian, without padding; 32 lower-case hex digits.
std::string digest(const Image& image);
// "NAME WxHxC TYPE HASH", TYPE one of u8, u16, u32, f32.
std::string digestLine(const std::string& name, const Image& image);

}  // namespace obscura::engine
