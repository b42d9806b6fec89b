#include "obscura/engine/digest.h"

// Inlined: one library less to load, and the hash of small planes is faster.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace obscura::engine {

static_assert(sizeof(float) == 4, "f32 is four bytes");
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "digests are of little-endian values"
#endif

std::string digest(const Image& image) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const size_t rowBytes = size_t(image.width) * size_t(image.channels) * bytesOf(image.format);
  for (size_t y = 0; y < size_t(image.height); ++y)
    XXH3_128bits_update(&state, image.bytes.data() + y * rowBytes, rowBytes);
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  std::string text;
  for (const XXH64_hash_t half : {hash.high64, hash.low64})
    for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[half >> shift & 15];
  return text;
}

std::string digestLine(const std::string& name, const Image& image) {
  static constexpr const char* kTypes[] = {"u8", "u16", "u32", "f32"};
  return name + " " + std::to_string(image.width) + "x" + std::to_string(image.height) + "x" +
         std::to_string(image.channels) + " " + kTypes[size_t(image.format)] + " " + digest(image);
}

}  // namespace obscura::engine
