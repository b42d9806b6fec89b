#include "obscura/engine/gltf_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace obscura::engine::gltf {
namespace {

uint32_t u32At(Bytes b, size_t at) {
  return uint32_t(b[at]) | uint32_t(b[at + 1]) << 8 | uint32_t(b[at + 2]) << 16 | uint32_t(b[at + 3]) << 24;
}

constexpr uint8_t kNoDigit = 64;

constexpr std::array<uint8_t, 256> makeBase64Digits() {
  constexpr const char* kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<uint8_t, 256> digits{};
  for (uint8_t& d : digits) d = kNoDigit;
  for (uint8_t k = 0; k < 64; ++k) digits[uint8_t(kAlphabet[k])] = k;
  return digits;
}
constexpr std::array<uint8_t, 256> kBase64Digits = makeBase64Digits();

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percentDecoded(const std::string& uri, const std::string& gltfPath) {
  std::string s;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      s += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hexDigit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hexDigit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) fail(gltfPath, "a % without two hexadecimal digits in the uri");
    s += char(high * 16 + low);
    i += 2;
  }
  return s;
}

}  // namespace

void fail(const std::string& gltfPath, const std::string& message, const std::string& file) {
  constexpr size_t kLongest = 400;
  Failure failure{{ErrorCode::BadInput, message.substr(0, kLongest), file, gltfPath}};
  for (std::string* s : {&failure.error.message, &failure.error.gltfPath})
    for (char& c : *s)
      if (uint8_t(c) < 0x20 || c == 0x7F) c = '?';
  throw failure;
}

Blob readFile(const std::string& path, uint64_t limit, const std::string& gltfPath) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) fail(gltfPath, "no such file", path);
  if (!fs::is_regular_file(status)) fail(gltfPath, "not a regular file", path);
  const uintmax_t size = fs::file_size(path, error);
  if (error) fail(gltfPath, "cannot read: " + error.message(), path);
  if (size > limit) {
    fail(gltfPath, std::to_string(size) + " bytes, more than the limit of " + std::to_string(limit), path);
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) fail(gltfPath, std::string("cannot open: ") + std::strerror(errno), path);
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  Blob blob{size_t(size)};
  if (size > 0 && std::fread(blob.data.get(), 1, blob.size, file.get()) != blob.size)
    fail(gltfPath, "cannot read all of its " + std::to_string(size) + " bytes", path);
  return blob;
}

Parts splitContainer(Bytes file) {
  constexpr size_t kHeader = 12, kChunkHeader = 8;
  constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;  // "glTF", "JSON", "BIN\0"
  Parts parts;
  if (file.size() < 4 || u32At(file, 0) != kMagic) {
    parts.json = file;
    return parts;
  }
  if (file.size() < kHeader + kChunkHeader) fail("", "a truncated .glb of " + std::to_string(file.size()) + " bytes");
  const uint32_t version = u32At(file, 4), length = u32At(file, 8);
  if (version != 2) fail("", "a .glb of version " + std::to_string(version) + ", not 2");
  if (length > file.size()) {
    fail("", "a truncated .glb: " + std::to_string(file.size()) + " of " + std::to_string(length) + " bytes");
  }
  size_t at = kHeader;
  for (int chunk = 0; chunk < 2 && size_t(length) >= at + kChunkHeader; ++chunk) {
    const size_t size = u32At(file, at);
    const uint32_t type = u32At(file, at + 4);
    at += kChunkHeader;
    if (size > length - at) {
      fail("", "chunk " + std::to_string(chunk) + " of the .glb has " + std::to_string(size) + " bytes, " +
                   std::to_string(length - at) + " are left");
    }
    const Bytes content{file.data() + at, size};
    if (chunk == 0) {
      if (type != kJson) fail("", "the first chunk of the .glb is not JSON");
      parts.json = content;
    } else if (type == kBinary) {
      parts.binary = content;
      parts.hasBinary = true;
    }
    at += size;
  }
  return parts;
}

bool isDataUri(const std::string& uri) { return uri.compare(0, 5, "data:") == 0; }

Blob decodeDataUri(const std::string& uri, const std::string& gltfPath) {
  const size_t comma = uri.find(',');
  constexpr char kMarker[] = ";base64";
  constexpr size_t kMarkerLength = sizeof kMarker - 1;
  if (comma == std::string::npos || comma < kMarkerLength ||
      uri.compare(comma - kMarkerLength, kMarkerLength, kMarker) != 0) {
    fail(gltfPath, "a data uri that is not base64");
  }
  const uint8_t* in = reinterpret_cast<const uint8_t*>(uri.data()) + comma + 1;
  size_t digits = uri.size() - comma - 1;
  for (int padding = 0; padding < 2 && digits > 0 && in[digits - 1] == '='; ++padding) --digits;
  if (digits % 4 == 1) fail(gltfPath, "base64 of " + std::to_string(digits) + " digits is incomplete");

  Blob blob{digits / 4 * 3 + (digits % 4 == 0 ? 0 : digits % 4 - 1)};
  uint8_t* out = blob.data.get();
  uint8_t seen = 0;  // of all digits; kNoDigit has a bit of its own
  const uint8_t* const wholeEnd = in + digits / 4 * 4;
  for (; in != wholeEnd; in += 4, out += 3) {
    const uint8_t a = kBase64Digits[in[0]], b = kBase64Digits[in[1]], c = kBase64Digits[in[2]],
                  d = kBase64Digits[in[3]];
    seen |= uint8_t(a | b | c | d);
    out[0] = uint8_t(a << 2 | b >> 4);
    out[1] = uint8_t(b << 4 | c >> 2);
    out[2] = uint8_t(c << 6 | d);
  }
  uint8_t rest[3] = {0, 0, 0};
  for (size_t k = 0; k < digits % 4; ++k) seen |= rest[k] = kBase64Digits[in[k]];
  if (digits % 4 >= 2) *out++ = uint8_t(rest[0] << 2 | rest[1] >> 4);
  if (digits % 4 == 3) *out++ = uint8_t(rest[1] << 4 | rest[2] >> 2);
  if (seen & kNoDigit) fail(gltfPath, "a character that is not base64 in the data uri");
  return blob;
}

std::string pathOfUri(const std::string& folder, const std::string& uri, const std::string& gltfPath) {
  const std::string path = percentDecoded(uri, gltfPath);
  if (path.empty() || path.find('\0') != std::string::npos) fail(gltfPath, "the uri names no file");
  if (path.substr(0, path.find('/')).find(':') != std::string::npos) {
    fail(gltfPath, "only data uris and relative paths are read, not " + path);
  }
  int depth = 0;  // of the folder reached; lexical, so that links inside the folder keep working
  bool leaves = path[0] == '/';
  for (const std::filesystem::path& part : std::filesystem::path(path)) {
    depth += part == ".." ? -1 : part == "." || part.empty() ? 0 : 1;
    leaves |= depth < 0;
  }
  if (leaves) fail(gltfPath, "a path that leaves the folder of the file: " + path);
  return folder.empty() ? path : folder + "/" + path;
}

}  // namespace obscura::engine::gltf
