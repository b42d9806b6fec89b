// Radiance pictures (.hdr): 8 bits of mantissa per channel and a common exponent, run-length encoded. OpenImageIO reads them,
// too, and takes longer to load than they take to decode.
// Source: Ward, "Real Pixels", Graphics Gems II; the format's reference "Radiance File Formats".
#include <algorithm>
#include <cstring>
#include <string_view>

#include "obscura/engine/image_codecs.h"

namespace obscura::engine::codec {
namespace {

struct Header {
  uint64_t width = 0, height = 0;
  size_t size = 0;  // bytes before the pixels
};

// A number of at most nine digits, and what follows it.
bool readNumber(std::string_view& text, uint64_t* value) {
  size_t digits = 0;
  for (*value = 0; digits < text.size() && text[digits] >= '0' && text[digits] <= '9'; ++digits) {
    if (digits == 9) return false;
    *value = *value * 10 + uint64_t(text[digits] - '0');
  }
  text.remove_prefix(digits);
  return digits > 0;
}

bool readLiteral(std::string_view& text, std::string_view expected) {
  if (text.substr(0, expected.size()) != expected) return false;
  text.remove_prefix(expected.size());
  return true;
}

// Lines of text up to an empty one, then the size. Only what is usual: RGB, rows from the top, pixels from the left.
bool readHeader(Bytes file, Header* h) {
  constexpr size_t kMostHeader = 1 << 16;
  const std::string_view all(reinterpret_cast<const char*>(file.data()), std::min(file.size(), kMostHeader));
  if (all.substr(0, 2) != "#?") return false;
  const size_t end = all.find("\n\n");
  if (end == all.npos) return false;
  const std::string_view lines = all.substr(0, end + 1);
  if (lines.find("\nFORMAT=") != lines.npos && lines.find("\nFORMAT=32-bit_rle_rgbe\n") == lines.npos) return false;
  std::string_view size = all.substr(end + 2);
  if (!readLiteral(size, "-Y ") || !readNumber(size, &h->height) || !readLiteral(size, " +X ") || !readNumber(size, &h->width) ||
      !readLiteral(size, "\n"))
    return false;
  h->size = size_t(size.data() - all.data());
  return true;
}

// One row of width pixels of 4 bytes, plane by plane or pixel by pixel: byte k of channel c at [c * width + k] (planar) or
// [4 k + c]. False: the file ends, or a run leaves the row.
class RowReader {
 public:
  RowReader(Bytes file, size_t at, size_t width) : file_(file), at_(at), width_(width), row_(width * 4) {}

  bool next() {
    const uint8_t* p = file_.data() + at_;
    const size_t left = file_.size() - at_;
    planar_ = width_ >= 8 && width_ < 32768 && left >= 4 && p[0] == 2 && p[1] == 2 && (size_t(p[2]) << 8 | p[3]) == width_;
    if (!planar_) return pixels();
    at_ += 4;
    for (size_t c = 0; c < 4; ++c)
      if (!runs(&row_[c * width_])) return false;
    return true;
  }
  uint8_t at(size_t x, size_t channel) const { return planar_ ? row_[channel * width_ + x] : row_[x * 4 + channel]; }

 private:
  // A count above 128: so many less 128 times the next byte; else so many bytes.
  bool runs(uint8_t* to) {
    for (size_t x = 0; x < width_;) {
      if (at_ == file_.size()) return false;
      size_t count = file_[at_++];
      const bool repeats = count > 128;
      if (repeats) count -= 128;
      if (count == 0 || count > width_ - x || file_.size() - at_ < (repeats ? 1 : count)) return false;
      if (repeats) std::memset(to + x, file_[at_++], count);
      else std::memcpy(to + x, file_.data() + at_, count), at_ += count;
      x += count;
    }
    return true;
  }

  // The older way: 1, 1, 1, n repeats the last pixel n times; several of these in a row are digits of 8 bits.
  bool pixels() {
    int shift = 0;
    for (size_t x = 0; x < width_;) {
      if (file_.size() - at_ < 4) return false;
      const uint8_t* p = file_.data() + at_;
      at_ += 4;
      if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
        std::memcpy(&row_[4 * x++], p, 4);
        shift = 0;
        continue;
      }
      const size_t count = size_t(p[3]) << shift;
      if (x == 0 || count > width_ - x) return false;
      for (size_t k = 0; k < count; ++k, ++x) std::memcpy(&row_[4 * x], &row_[4 * (x - 1)], 4);
      shift = shift < 16 ? shift + 8 : shift;
    }
    return true;
  }

  Bytes file_;
  size_t at_, width_;
  std::vector<uint8_t> row_;
  bool planar_ = false;
};

// 2^(exponent - 136), subnormal numbers included; exactly. 0 stands for black.
float scaleOf(uint8_t exponent) {
  const uint32_t bits = exponent == 0 ? 0 : exponent > 9 ? uint32_t(exponent - 9) << 23 : 1u << (13 + exponent);
  float f;
  std::memcpy(&f, &bits, sizeof f);
  return f;
}

}  // namespace

bool isRadiance(Bytes file) {
  Header h;
  return readHeader(file, &h);
}

Result<Image> decodeRadiance(Bytes file, const std::string& name, const DecodeLimits& limits) {
  Header h;
  if (!readHeader(file, &h)) return badImage(name, "broken HDR");
  if (auto error = checkSize(h.width, h.height, 3, Format::F32, name, limits)) return *error;
  // A row has at least 4 bytes, however long its runs.
  if (h.height > (file.size() - h.size) / 4) return badImage(name, "broken HDR: the file is truncated");
  float scales[256];
  for (int e = 0; e < 256; ++e) scales[e] = scaleOf(uint8_t(e));
  Image image(int(h.width), int(h.height), 3, Format::F32);
  RowReader rows(file, h.size, h.width);
  for (int y = 0; y < image.height; ++y) {
    if (!rows.next()) return badImage(name, "broken HDR: row " + std::to_string(y) + " is not whole");
    float* to = image.row<float>(y);
    for (size_t x = 0; x < h.width; ++x) {
      const float scale = scales[rows.at(x, 3)];
      for (size_t c = 0; c < 3; ++c) *to++ = float(rows.at(x, c)) * scale;
    }
  }
  return image;
}

}  // namespace obscura::engine::codec
