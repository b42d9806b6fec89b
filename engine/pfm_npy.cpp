// PFM (portable float map) and NPY (numpy's array file): a short header, then the elements as they are.
#include <algorithm>
#include <cstring>
#include <string_view>

#include "obscura/engine/image_codecs.h"

namespace obscura::engine::codec {
namespace {

bool nativeIsLittle() {
  const uint16_t one = 1;
  return reinterpret_cast<const uint8_t&>(one) == 1;
}

void reverseElements(uint8_t* data, size_t bytes, size_t elementBytes) {
  if (elementBytes > 1)
    for (size_t i = 0; i + elementBytes <= bytes; i += elementBytes) std::reverse(data + i, data + i + elementBytes);
}

// A cursor over the text of a header; every function fails (returns false) instead of passing the end.
struct Scanner {
  std::string_view text;

  bool literal(std::string_view s) {
    if (text.substr(0, s.size()) != s) return false;
    text.remove_prefix(s.size());
    return true;
  }
  void skip(std::string_view set) { text.remove_prefix(std::min(text.find_first_not_of(set), text.size())); }
  std::string_view token(std::string_view end) {
    const std::string_view t = text.substr(0, text.find_first_of(end));
    text.remove_prefix(t.size());
    return t;
  }
  bool number(uint64_t* value) {
    size_t digits = 0;
    *value = 0;
    for (; digits < text.size() && text[digits] >= '0' && text[digits] <= '9'; ++digits) {
      if (digits == 10) return false;
      *value = *value * 10 + uint64_t(text[digits] - '0');
    }
    text.remove_prefix(digits);
    return digits > 0;
  }
};

Scanner scan(Bytes file, size_t from, size_t count) {
  from = std::min(from, file.size());
  return {std::string_view(reinterpret_cast<const char*>(file.data()) + from, std::min(count, file.size() - from))};
}

struct NpyHeader {
  Format format = Format::U8;
  bool swap = false;
  uint64_t shape[3] = {0, 0, 1};
};

bool parseType(Scanner& s, NpyHeader* h) {
  if (!s.literal("'") && !s.literal("\"")) return false;
  const std::string_view type = s.token("'\"");
  if (type.size() != 3 || !(s.literal("'") || s.literal("\""))) return false;
  const std::string_view kind = type.substr(1);
  if (kind == "f4") h->format = Format::F32;
  else if (kind == "u4") h->format = Format::U32;
  else if (kind == "u2") h->format = Format::U16;
  else if (kind == "u1") h->format = Format::U8;
  else return false;
  if (type[0] != '<' && type[0] != '>' && type[0] != '|' && type[0] != '=') return false;
  if (type[0] == '|' && kind != "u1") return false;
  h->swap = type[0] == (nativeIsLittle() ? '>' : '<');
  return true;
}

bool parseShape(Scanner& s, NpyHeader* h) {
  if (!s.literal("(")) return false;
  int n = 0;
  for (; n < 4; ++n) {
    s.skip(" ,");
    if (s.literal(")")) break;
    if (n == 3 || !s.number(&h->shape[n])) return false;
  }
  return n == 2 || n == 3;
}

// {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 1), } with the keys in any order.
bool parseNpyHeader(Scanner s, NpyHeader* h) {
  bool type = false, order = false, shape = false;
  s.skip(" ");
  if (!s.literal("{")) return false;
  for (;;) {
    s.skip(" ,");
    if (s.literal("}")) return type && order && shape;
    if (!s.literal("'") && !s.literal("\"")) return false;
    const std::string_view key = s.token("'\"");
    s.skip("'\"");
    s.skip(" :");
    if (key == "descr") type = parseType(s, h);
    else if (key == "fortran_order") order = s.literal("False");
    else if (key == "shape") shape = parseShape(s, h);
    else return false;
    if (!(key == "descr" ? type : key == "shape" ? shape : order)) return false;
  }
}

}  // namespace

bool isPfm(Bytes file) {
  return file.size() >= 3 && file[0] == 'P' && (file[1] == 'F' || file[1] == 'f') &&
         (file[2] == '\n' || file[2] == ' ');
}

Result<Image> decodePfm(Bytes file, const std::string& name, const DecodeLimits& limits) {
  constexpr std::string_view kSpace = " \t\r\n";
  const int channels = file[1] == 'F' ? 3 : 1;
  Scanner s = scan(file, 2, 256);
  const size_t start = s.text.size();
  uint64_t width = 0, height = 0;
  s.skip(kSpace);
  bool good = s.number(&width);
  s.skip(kSpace);
  good = good && s.number(&height);
  s.skip(kSpace);
  const std::string_view scale = s.token(kSpace);
  good = good && !scale.empty() && !s.text.empty() && scale.find_first_not_of("+-.0123456789eE") == scale.npos;
  if (!good) return badImage(name, "broken PFM: bad header");
  if (auto error = checkSize(width, height, uint64_t(channels), Format::F32, name, limits)) return *error;
  const size_t offset = 2 + (start - s.text.size()) + 1;  // one white space ends the header
  const uint64_t rowBytes = width * uint64_t(channels) * 4;
  if (rowBytes * height > file.size() - offset) return badImage(name, "broken PFM: the file is truncated");
  Image image(int(width), int(height), channels, Format::F32);
  for (size_t y = 0; y < height; ++y)
    std::memcpy(image.bytes.data() + y * rowBytes, file.data() + offset + (height - 1 - y) * rowBytes, rowBytes);
  if ((scale[0] == '-') != nativeIsLittle()) reverseElements(image.bytes.data(), image.bytes.size(), 4);
  return image;
}

Result<std::vector<uint8_t>> encodePfm(const Image& image) {
  if (image.format != Format::F32) return Error{ErrorCode::Usage, "a PFM holds float32 only", {}, {}};
  if (image.channels != 1 && image.channels != 3)
    return Error{ErrorCode::Usage, "a PFM holds 1 or 3 channels, not " + std::to_string(image.channels), {}, {}};
  const std::string header = std::string(image.channels == 3 ? "PF" : "Pf") + "\n" + std::to_string(image.width) + " " +
                             std::to_string(image.height) + "\n-1.0\n";
  std::vector<uint8_t> out(header.size() + image.bytes.size());
  std::memcpy(out.data(), header.data(), header.size());
  const size_t rowBytes = image.bytes.size() / size_t(image.height);
  for (size_t y = 0; y < size_t(image.height); ++y)
    std::memcpy(out.data() + header.size() + y * rowBytes,
                image.bytes.data() + (size_t(image.height) - 1 - y) * rowBytes, rowBytes);
  if (!nativeIsLittle()) reverseElements(out.data() + header.size(), image.bytes.size(), 4);
  return out;
}

bool isNpy(Bytes file) { return file.size() >= 10 && std::memcmp(file.data(), "\x93NUMPY", 6) == 0; }

Result<Image> decodeNpy(Bytes file, const std::string& name, const DecodeLimits& limits) {
  // Version 1 has 2 bytes of header length, later ones 4.
  const size_t lengthBytes = file[6] == 1 ? 2 : 4, headerAt = 8 + lengthBytes;
  if (file[6] < 1 || file[6] > 3 || file.size() < headerAt) return badImage(name, "broken NPY: unknown version");
  size_t length = 0;
  for (size_t i = 0; i < lengthBytes; ++i) length |= size_t(file[8 + i]) << (8 * i);
  if (length > file.size() - headerAt) return badImage(name, "broken NPY: the file is truncated");
  NpyHeader h;
  if (!parseNpyHeader(scan(file, headerAt, length), &h))
    return badImage(name, "NPY that is not an array [H,W] or [H,W,C] of u1, u2, u4 or f4 in C order");
  const uint64_t height = h.shape[0], width = h.shape[1], channels = h.shape[2];
  if (auto error = checkSize(width, height, channels, h.format, name, limits)) return *error;
  const uint64_t bytes = width * height * channels * bytesOf(h.format);
  if (bytes > file.size() - headerAt - length) return badImage(name, "broken NPY: the file is truncated");
  Image image(int(width), int(height), int(channels), h.format);
  std::memcpy(image.bytes.data(), file.data() + headerAt + length, bytes);
  if (h.swap) reverseElements(image.bytes.data(), bytes, bytesOf(h.format));
  return image;
}

Result<std::vector<uint8_t>> encodeNpy(const Image& image) {
  const char* type = image.format == Format::F32   ? "<f4"
                     : image.format == Format::U32 ? "<u4"
                     : image.format == Format::U16 ? "<u2"
                                                   : "|u1";
  std::string header = std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (" +
                       std::to_string(image.height) + ", " + std::to_string(image.width) + ", " +
                       std::to_string(image.channels) + "), }";
  // The elements start at a multiple of 64 bytes; the header ends with a line feed.
  const size_t total = (10 + header.size() + 1 + 63) / 64 * 64;
  header.resize(total - 11, ' ');
  header += '\n';
  std::vector<uint8_t> out(total + image.bytes.size());
  std::memcpy(out.data(), "\x93NUMPY\x01\x00", 8);
  out[8] = uint8_t(header.size());
  out[9] = uint8_t(header.size() >> 8);
  std::memcpy(out.data() + 10, header.data(), header.size());
  if (!image.bytes.empty()) std::memcpy(out.data() + total, image.bytes.data(), image.bytes.size());
  if (!nativeIsLittle()) reverseElements(out.data() + total, image.bytes.size(), bytesOf(image.format));
  return out;
}

}  // namespace obscura::engine::codec
