#include "obscura/engine/content_cache.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <new>
#include <tuple>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "obscura/engine/image_file.h"

namespace obscura::engine {
namespace {

namespace fs = std::filesystem;

// KIND-HASH....bin.
bool isKept(const std::string& name) {
  const size_t dash = name.find('-');
  if (dash == 0 || dash == name.npos || name.size() < dash + 37 || name.compare(name.size() - 4, 4, ".bin") != 0) return false;
  return name.find_first_not_of("0123456789abcdef", dash + 1) >= dash + 33;
}

struct Kept {
  fs::file_time_type used;
  std::string file;
  uint64_t size;
};

// Deletes what was used the longest ago, but `newest`, until no more than `most` bytes are left.
void makeRoom(const fs::path& folder, const fs::path& newest, uint64_t most) {
  std::vector<Kept> all;
  uint64_t bytes = 0;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    std::error_code gone;
    if (!isKept(i->path().filename().string()) || !i->is_regular_file(gone)) continue;
    const Kept kept{i->last_write_time(gone), i->path().string(), i->file_size(gone)};
    if (gone) continue;
    bytes += kept.size;
    if (i->path().filename() != newest.filename()) all.push_back(kept);
  }
  std::sort(all.begin(), all.end(), [](const Kept& a, const Kept& b) { return std::tie(a.used, a.file) < std::tie(b.used, b.file); });
  for (const Kept& kept : all) {
    if (bytes <= most) return;
    if (fs::last_write_time(kept.file, error) == kept.used && !error) fs::remove(kept.file, error);  // unless just used or made anew
    bytes -= kept.size;
  }
}

std::string headerOf(const std::string& title, raster::Span<const uint8_t> bytes) { return title + " " + hashOf(bytes) + "\n"; }

}  // namespace

std::string hashOf(raster::Span<const uint8_t> bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::string hex;
  for (const unsigned char b : canonical.digest) hex += {"0123456789abcdef"[b >> 4], "0123456789abcdef"[b & 15]};
  return hex;
}

std::optional<LargeVector<uint8_t>> loadCached(const std::string& file, const std::string& title, uint64_t most) try {
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(file, error), ofHeader = title.size() + 34;
  if (error || size < ofHeader || size - ofHeader > most) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  std::string header(ofHeader, '\0');
  in.read(header.data(), std::streamsize(header.size()));
  if (!in || header.compare(0, title.size(), title) != 0) return std::nullopt;
  LargeVector<uint8_t> bytes(size - ofHeader);
  in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  if (!in || header != headerOf(title, {bytes.data(), bytes.size()})) return std::nullopt;
  std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), error);  // where that may not be, it is old
  return bytes;
} catch (const std::bad_alloc&) {
  return std::nullopt;
}

Result<Done> storeCached(const std::string& file, const std::string& title, raster::Span<const uint8_t> bytes, uint64_t most) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::filesystem::create_directories(folder, error);
  if (error) return Error{ErrorCode::CannotWrite, "cannot make the folder: " + error.message(), folder.string(), ""};
  const std::string header = headerOf(title, bytes);
  LargeVector<uint8_t> all;
  all.reserve(header.size() + bytes.size());
  all.insert(all.end(), header.begin(), header.end());
  all.insert(all.end(), bytes.begin(), bytes.end());
  const Result<Done> written = writeFileAtomically(file, {all.data(), all.size()});
  if (written) makeRoom(folder, file, most);
  return written;
}

}  // namespace obscura::engine
