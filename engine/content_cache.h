// In:  what took long to make, under a name for all that it follows from.
// Out: the same again, from a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "obscura/engine/large_vector.h"
#include "obscura/engine/result.h"
#include "obscura/raster/span.h"

namespace obscura::engine {

// 32 hex digits, XXH3-128.
std::string hashOf(raster::Span<const uint8_t> bytes);

// `title` says what is in the file: the kind and version of it and a hash of all that it follows from; at most 4096 bytes.
// Empty if there is no such file, or it is not whole: its title, length (above `most` bytes) or checksum is wrong.
// What is read counts as used now.
std::optional<LargeVector<uint8_t>> loadCached(const std::string& file, const std::string& title, uint64_t most);

// Makes the folder if need be. Written beside and renamed: a reader never sees half a file. Where the folder's kept files, those
// named KIND-HASH....bin with 32 hex digits, are more than `most` bytes together, those go that were used the longest ago, but not
// this one. Other processes may read, write and delete there at the same time: what is gone is made again.
constexpr uint64_t kMostInFolder = uint64_t(1) << 30;
Result<Done> storeCached(const std::string& file, const std::string& title, raster::Span<const uint8_t> bytes, uint64_t most = kMostInFolder);

}  // namespace obscura::engine
