// Images on their way to and from files: interleaved rows, named channels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace obscura::engine {

enum class Format : uint8_t { U8, U16, U32, F32 };
inline size_t bytesOf(Format f) { return f == Format::U8 ? 1 : f == Format::U16 ? 2 : 4; }

// height x width x channels elements, row 0 on top, channels interleaved, native byte order, no padding.
struct Image {
  int width = 0, height = 0, channels = 0;
  Format format = Format::U8;
  std::vector<uint8_t> bytes;

  Image() = default;
  Image(int w, int h, int c, Format f)
      : width(w), height(h), channels(c), format(f), bytes(size_t(w) * size_t(h) * size_t(c) * bytesOf(f)) {}
  template <class T>
  T* row(int y) { return reinterpret_cast<T*>(bytes.data()) + size_t(y) * size_t(width) * size_t(channels); }
  template <class T>
  const T* row(int y) const { return reinterpret_cast<const T*>(bytes.data()) + size_t(y) * size_t(width) * size_t(channels); }
};

// One layer of an image file: "depth" with channel "Z", "normal" with channels "X", "Y", "Z", ...
struct Layer {
  std::string name;                   // the AOV's name
  std::vector<std::string> channels;  // one name per channel of the image
  Image image;
};

}  // namespace obscura::engine
