#include "obscura/engine/digest.h"

// Inlined: one library less to load, and the hash of small planes is faster.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace obscura::engine {

static_assert(sizeof(float) == 4, "f32 is four bytes");
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "digests are of little-endian values"
#endif

namespace {

RowSource rowsOf(const Image& image) {
  const size_t rowBytes = size_t(image.width) * size_t(image.channels) * bytesOf(image.format);
  return {image.width, image.height, image.channels, image.format,
          [&image, rowBytes](int y) { return image.bytes.data() + size_t(y) * rowBytes; }};
}

}  // namespace

std::string digest(const RowSource& rows) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const size_t rowBytes = size_t(rows.width) * size_t(rows.channels) * bytesOf(rows.format);
  for (int y = 0; y < rows.height; ++y) XXH3_128bits_update(&state, rows.row(y), rowBytes);
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  std::string text;
  for (const XXH64_hash_t half : {hash.high64, hash.low64})
    for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[half >> shift & 15];
  return text;
}

std::string digest(const Image& image) { return digest(rowsOf(image)); }

std::string digestLine(const std::string& name, const RowSource& rows) {
  static constexpr const char* kTypes[] = {"u8", "u16", "u32", "f32"};
  return name + " " + std::to_string(rows.width) + "x" + std::to_string(rows.height) + "x" +
         std::to_string(rows.channels) + " " + kTypes[size_t(rows.format)] + " " + digest(rows);
}

std::string digestLine(const std::string& name, const Image& image) { return digestLine(name, rowsOf(image)); }

}  // namespace obscura::engine
