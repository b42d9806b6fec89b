#include "obscura/engine/image_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

#include "obscura/engine/image_codecs.h"

namespace obscura::engine {
namespace codec {

Error badImage(const std::string& file, const std::string& message) {
  return Error{ErrorCode::BadInput, message, file, {}};
}

std::optional<Error> checkSize(uint64_t width, uint64_t height, uint64_t channels, Format format,
                               const std::string& file, const DecodeLimits& limits) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width == 0 || height == 0 || channels == 0) return badImage(file, "empty image: " + size);
  const uint64_t side = std::min<uint64_t>(limits.size, 0x7FFFFFFF);
  if (width > side || height > side) return badImage(file, "image too large: " + size);
  if (channels > 1024) return badImage(file, "too many channels: " + std::to_string(channels));
  // At most 2^62 pixels, 2^10 channels: divide rather than overflow.
  if (width * height > limits.bytes / (channels * bytesOf(format))) return badImage(file, "image too large: " + size);
  return {};
}

}  // namespace codec

namespace {

using codec::Bytes;

Error outOfMemory(ErrorCode code, const std::string& file) { return Error{code, "out of memory", file, {}}; }

Result<std::vector<uint8_t>> readBytes(const std::string& path, uint64_t limit) {
  const auto failed = [&] { return codec::badImage(path, std::string("cannot read: ") + std::strerror(errno)); };
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return failed();
  struct Close {
    int fd;
    ~Close() { close(fd); }
  } closer{fd};
  struct stat info;
  if (fstat(fd, &info) != 0) return failed();
  std::vector<uint8_t> bytes;
  // The size is only a hint (pipes have none, files may grow); one byte more finds the end in one round.
  size_t room = S_ISREG(info.st_mode) && uint64_t(info.st_size) < limit ? size_t(info.st_size) + 1 : 1 << 16;
  for (size_t size = 0;;) {
    if (size == bytes.size()) bytes.resize(size + room);
    const ssize_t n = read(fd, bytes.data() + size, bytes.size() - size);
    if (n < 0 && errno != EINTR) return failed();
    size += n > 0 ? size_t(n) : 0;
    if (n == 0) {
      bytes.resize(size);
      return bytes;
    }
    if (size > limit) return codec::badImage(path, "file too large: more than " + std::to_string(limit) + " bytes");
    room = std::max<size_t>(size, 1 << 16);
  }
}

Image rgba8From(const Image& from) {
  Image to(from.width, from.height, 4, Format::U8);
  const size_t n = size_t(from.channels), pixels = size_t(from.width) * size_t(from.height);
  const auto byteAt = [&](size_t i) -> uint8_t {
    switch (from.format) {
      case Format::U8: return from.bytes[i];
      case Format::U16: return uint8_t((from.row<uint16_t>(0)[i] * 255u + 32895u) >> 16);
      case Format::U32: return uint8_t(from.row<uint32_t>(0)[i] >> 24);
      case Format::F32: break;
    }
    const float v = from.row<float>(0)[i];
    return v >= 1 ? 255 : v > 0 ? uint8_t(v * 255.0f + 0.5f) : 0;  // NaN is 0
  };
  const bool color = n >= 3, alpha = n == 2 || n >= 4;
  for (size_t p = 0; p < pixels; ++p)
    for (size_t c = 0; c < 4; ++c)
      to.bytes[p * 4 + c] = c < 3 ? byteAt(p * n + (color ? c : 0)) : alpha ? byteAt(p * n + (color ? 3 : 1)) : 255;
  return to;
}

// What the engine decodes itself, in its own channels; empty where the module is needed.
std::optional<Result<Image>> decodeNatively(Bytes file, const std::string& name, const DecodeLimits& limits,
                                            bool rgba8) {
  if (codec::isPng(file)) return codec::decodePng(file, name, limits, rgba8);
  if (codec::isJpeg(file)) return codec::decodeJpeg(file, name, limits, rgba8);
  if (codec::isPfm(file)) return codec::decodePfm(file, name, limits);
  if (codec::isNpy(file)) return codec::decodeNpy(file, name, limits);
  if (codec::isRadiance(file)) return codec::decodeRadiance(file, name, limits);
  return {};
}

std::vector<std::string> defaultChannels(int count) {
  std::vector<std::string> names;
  if (count <= 2) names = {"Y", "A"};
  else names = {"R", "G", "B", "A"};
  for (int c = 4; c < count; ++c) names.push_back("channel" + std::to_string(c));
  names.resize(size_t(count));
  return names;
}

Result<std::vector<Layer>> decodeLayers(Bytes file, const std::string& name, const DecodeLimits& limits) {
  auto native = decodeNatively(file, name, limits, false);
  if (!native) return codec::decodeWithModule(file, name, limits);
  if (!*native) return native->error();
  std::vector<Layer> layers(1);
  layers[0] = {"color", defaultChannels((**native).channels), std::move(**native)};
  return layers;
}

Result<Image> mainLayer(Result<std::vector<Layer>> layers, const std::string& name) {
  if (!layers) return layers.error();
  if (layers->empty()) return codec::badImage(name, "the file holds no image");
  for (Layer& layer : *layers)
    if (layer.name == "color") return std::move(layer.image);
  return std::move((*layers)[0].image);
}

// What is wrong with the layers as an argument.
std::optional<Error> checkLayers(FileFormat format, const std::vector<Layer>& layers, const std::string& path) {
  const auto wrong = [&](const std::string& message) { return Error{ErrorCode::Usage, message, path, {}}; };
  if (layers.empty()) return wrong("nothing to write");
  if (layers.size() > 1 && !holdsLayers(format)) return wrong("this format holds one image only");
  for (const Layer& layer : layers) {
    const Image& image = layer.image;
    const std::string who = "layer \"" + layer.name + "\": ";
    if (auto error = codec::checkSize(uint64_t(std::max(image.width, 0)), uint64_t(std::max(image.height, 0)),
                                      uint64_t(std::max(image.channels, 0)), image.format, path,
                                      DecodeLimits{0x7FFFFFFF, 1ull << 62}))
      return wrong(who + error->message);
    const uint64_t pixels = uint64_t(image.width) * uint64_t(image.height);
    if (image.bytes.size() != pixels * uint64_t(image.channels) * bytesOf(image.format))
      return wrong(who + "its bytes are not those of its size");
    if (image.width != layers[0].image.width || image.height != layers[0].image.height)
      return wrong(who + "layers of one file are of one size");
    if (format != FileFormat::Exr) continue;
    if (layer.channels.size() != size_t(image.channels)) return wrong(who + "one name per channel is needed");
    if (image.format != Format::F32 && image.format != Format::U32)
      return wrong(who + "an EXR takes float32 and uint32 only");
  }
  return {};
}

}  // namespace

Result<Image> decodeImageRgba8(raster::Span<const uint8_t> file, const std::string& name,
                               const DecodeLimits& limits) try {
  auto native = decodeNatively(file, name, limits, true);
  Result<Image> image = native ? std::move(*native) : mainLayer(codec::decodeWithModule(file, name, limits), name);
  if (!image || (image->channels == 4 && image->format == Format::U8)) return image;
  if (auto error = codec::checkSize(uint64_t(image->width), uint64_t(image->height), 4, Format::U8, name, limits))
    return *error;
  return rgba8From(*image);
} catch (const std::bad_alloc&) {
  return outOfMemory(ErrorCode::BadInput, name);
}

Result<Image> decodeImage(Bytes file, const std::string& name, const DecodeLimits& limits) try {
  return mainLayer(decodeLayers(file, name, limits), name);
} catch (const std::bad_alloc&) {
  return outOfMemory(ErrorCode::BadInput, name);
}

Result<std::vector<uint8_t>> readImageBytes(const std::string& path, const DecodeLimits& limits) try {
  return readBytes(path, limits.bytes);
} catch (const std::bad_alloc&) {
  return outOfMemory(ErrorCode::BadInput, path);
}

Result<Image> readImage(const std::string& path, const DecodeLimits& limits) {
  return mainLayer(readLayers(path, limits), path);
}

Result<std::vector<Layer>> readLayers(const std::string& path, const DecodeLimits& limits) try {
  const Result<std::vector<uint8_t>> bytes = readBytes(path, limits.bytes);
  if (!bytes) return bytes.error();
  return decodeLayers(*bytes, path, limits);
} catch (const std::bad_alloc&) {
  return outOfMemory(ErrorCode::BadInput, path);
}

Result<FileFormat> fileFormatOf(const std::string& path) {
  const size_t dot = path.rfind('.'), slash = path.rfind('/');
  std::string extension;
  if (dot != path.npos && (slash == path.npos || dot > slash)) extension = path.substr(dot + 1);
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  if (extension == "png") return FileFormat::Png;
  if (extension == "exr") return FileFormat::Exr;
  if (extension == "pfm") return FileFormat::Pfm;
  if (extension == "npy") return FileFormat::Npy;
  for (const char* other : {"tif", "tiff", "hdr", "jpg", "jpeg", "bmp", "tga", "webp", "jp2", "dpx", "ppm", "pgm"})
    if (extension == other) return FileFormat::Other;
  return Error{ErrorCode::Usage, "no image format by the extension \"" + extension + "\"", path, {}};
}

bool holdsLayers(FileFormat format) { return format == FileFormat::Exr; }

Result<std::vector<uint8_t>> encodeImage(FileFormat format, const std::vector<Layer>& layers,
                                         const std::string& path, const Placement& place) try {
  if (auto error = checkLayers(format, layers, path)) return *error;
  const auto withPath = [&](Result<std::vector<uint8_t>> result) -> Result<std::vector<uint8_t>> {
    if (result) return result;
    Error error = result.error();
    error.file = path;
    return error;
  };
  switch (format) {
    case FileFormat::Png: return withPath(codec::encodePng(layers[0].image));
    case FileFormat::Pfm: return withPath(codec::encodePfm(layers[0].image));
    case FileFormat::Npy: return withPath(codec::encodeNpy(layers[0].image));
    case FileFormat::Exr: return withPath(codec::encodeWithModule("layers.exr", layers, place));
    case FileFormat::Other: break;
  }
  return codec::encodeWithModule(path, layers, {});
} catch (const std::bad_alloc&) {
  return outOfMemory(ErrorCode::CannotWrite, path);
}

}  // namespace obscura::engine
