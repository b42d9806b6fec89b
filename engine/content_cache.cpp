#include "obscura/engine/content_cache.h"

#include <filesystem>
#include <fstream>
#include <new>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "obscura/engine/image_file.h"

namespace obscura::engine {
namespace {

std::string headerOf(const std::string& title, raster::Span<const uint8_t> bytes) { return title + " " + hashOf(bytes) + "\n"; }

}  // namespace

std::string hashOf(raster::Span<const uint8_t> bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::string hex;
  for (const unsigned char b : canonical.digest) hex += {"0123456789abcdef"[b >> 4], "0123456789abcdef"[b & 15]};
  return hex;
}

std::optional<std::vector<uint8_t>> loadCached(const std::string& file, const std::string& title, uint64_t most) try {
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(file, error), ofHeader = title.size() + 34;
  if (error || size < ofHeader || size - ofHeader > most) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  std::string header(ofHeader, '\0');
  in.read(header.data(), std::streamsize(header.size()));
  if (!in || header.compare(0, title.size(), title) != 0) return std::nullopt;
  std::vector<uint8_t> bytes(size - ofHeader);
  in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  if (!in || header != headerOf(title, bytes)) return std::nullopt;
  return bytes;
} catch (const std::bad_alloc&) {
  return std::nullopt;
}

Result<Done> storeCached(const std::string& file, const std::string& title, raster::Span<const uint8_t> bytes) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::filesystem::create_directories(folder, error);
  if (error) return Error{ErrorCode::CannotWrite, "cannot make the folder: " + error.message(), folder.string(), ""};
  const std::string header = headerOf(title, bytes);
  std::vector<uint8_t> all(header.begin(), header.end());
  all.insert(all.end(), bytes.begin(), bytes.end());
  return writeFileAtomically(file, {all.data(), all.size()});
}

}  // namespace obscura::engine
