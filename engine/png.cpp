// PNG through libpng. libpng reports errors by longjmp: everything that may do so runs inside guarded(), in lambdas
// whose locals are all trivial; what owns memory lives outside.
#include <csetjmp>
#include <cstring>
#include <memory>
#include <new>

#include <png.h>

#include "obscura/engine/image_codecs.h"

namespace obscura::engine::codec {
namespace {

// Deflate packs at most 1032 bytes into one; a header that promises more than that lies.
constexpr uint64_t kMaxRatio = 1032;
// Measured on a rendered 800 x 600 RGB frame: level 3 with the "up" filter 8 ms and 69 KB, all five filters 15 ms
// and 70 KB, level 6 with all filters 17 ms and 58 KB.
constexpr int kLevel = 3, kFilter = PNG_FILTER_UP;

struct Message {
  char text[160] = {};
};

void onError(png_structp png, png_const_charp text) {
  auto* message = static_cast<Message*>(png_get_error_ptr(png));
  std::strncpy(message->text, text, sizeof(message->text) - 1);
  png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

template <class F>
bool guarded(png_structp png, const F& body) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  body();
  return true;
}

struct Input {
  const uint8_t* data;
  size_t size;
};

void readSome(png_structp png, png_bytep to, size_t count) {
  auto* in = static_cast<Input*>(png_get_io_ptr(png));
  if (count > in->size) png_error(png, "the file is truncated");
  std::memcpy(to, in->data, count);
  in->data += count;
  in->size -= count;
}

bool append(std::vector<uint8_t>& out, const uint8_t* data, size_t count) noexcept try {
  out.insert(out.end(), data, data + count);
  return true;
} catch (const std::bad_alloc&) {
  return false;
}

void writeSome(png_structp png, png_bytep data, size_t count) {
  if (!append(*static_cast<std::vector<uint8_t>*>(png_get_io_ptr(png)), data, count)) png_error(png, "out of memory");
}

void flushNothing(png_structp) {}

struct Reader {
  Message message;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, onError, onWarning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Reader() {
    if (!info) throw std::bad_alloc();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
  Message message;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, onError, onWarning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Writer() {
    if (!info) throw std::bad_alloc();
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

// Everything becomes 8 or 16 bit grey, grey + alpha, RGB or RGBA in native byte order.
void requestFormat(png_structp png, png_infop info, bool rgba8) {
  png_set_expand(png);
  if (rgba8) {
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
  } else {
    const uint16_t one = 1;
    if (reinterpret_cast<const uint8_t&>(one) == 1) png_set_swap(png);
  }
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

}  // namespace

bool isPng(Bytes file) { return file.size() >= 8 && png_sig_cmp(file.data(), 0, 8) == 0; }

Result<Image> decodePng(Bytes file, const std::string& name, const DecodeLimits& limits, bool rgba8) {
  Reader r;
  Input input{file.data(), file.size()};
  const auto failed = [&] { return badImage(name, std::string("broken PNG: ") + r.message.text); };
  const bool header = guarded(r.png, [&] {
    png_set_read_fn(r.png, &input, readSome);
    png_set_user_limits(r.png, 0x7FFFFFFF, 0x7FFFFFFF);  // checkSize decides
    // Colour is not managed: a damaged profile or text is no reason to refuse the pixels.
    png_set_keep_unknown_chunks(r.png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
    png_set_crc_action(r.png, PNG_CRC_ERROR_QUIT, PNG_CRC_WARN_DISCARD);
    png_read_info(r.png, r.info);
  });
  if (!header) return failed();
  const uint64_t width = png_get_image_width(r.png, r.info), height = png_get_image_height(r.png, r.info);
  const uint64_t storedBits = width * height * png_get_channels(r.png, r.info) * png_get_bit_depth(r.png, r.info);
  if (auto error = checkSize(width, height, 4, rgba8 ? Format::U8 : Format::U16, name, limits)) return *error;
  if (storedBits / 8 / kMaxRatio > file.size()) return badImage(name, "broken PNG: the file is truncated");
  if (!guarded(r.png, [&] { requestFormat(r.png, r.info, rgba8); })) return failed();
  const int channels = png_get_channels(r.png, r.info);
  const Format format = png_get_bit_depth(r.png, r.info) == 16 ? Format::U16 : Format::U8;
  Image image(int(width), int(height), channels, format);
  std::vector<png_bytep> rows(height);
  for (size_t y = 0; y < height; ++y) rows[y] = image.bytes.data() + y * (image.bytes.size() / height);
  const bool done = guarded(r.png, [&] {
    png_read_image(r.png, rows.data());
    png_read_end(r.png, nullptr);
  });
  if (!done) return failed();
  return image;
}

Result<std::vector<uint8_t>> encodePng(const Image& image) {
  if (image.format != Format::U8 && image.format != Format::U16)
    return Error{ErrorCode::Usage, "a PNG holds 8 or 16 bit integers only", {}, {}};
  if (image.channels < 1 || image.channels > 4)
    return Error{ErrorCode::Usage, "a PNG holds 1 to 4 channels, not " + std::to_string(image.channels), {}, {}};
  static constexpr int kColorTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                        PNG_COLOR_TYPE_RGB_ALPHA};
  std::vector<uint8_t> out;
  Writer w;
  const bool done = guarded(w.png, [&] {
    png_set_write_fn(w.png, &out, writeSome, flushNothing);
    png_set_user_limits(w.png, 0x7FFFFFFF, 0x7FFFFFFF);
    png_set_IHDR(w.png, w.info, png_uint_32(image.width), png_uint_32(image.height), int(bytesOf(image.format)) * 8,
                 kColorTypes[image.channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(w.png, kLevel);
    png_set_compression_buffer_size(w.png, 1 << 16);
    png_set_filter(w.png, PNG_FILTER_TYPE_BASE, kFilter);
    png_write_info(w.png, w.info);
    const uint16_t one = 1;
    if (image.format == Format::U16 && reinterpret_cast<const uint8_t&>(one) == 1) png_set_swap(w.png);
    const size_t rowBytes = image.bytes.size() / size_t(image.height);
    for (size_t y = 0; y < size_t(image.height); ++y) png_write_row(w.png, image.bytes.data() + y * rowBytes);
    png_write_end(w.png, nullptr);
  });
  if (!done) return Error{ErrorCode::CannotWrite, std::string("cannot encode PNG: ") + w.message.text, {}, {}};
  return out;
}

}  // namespace obscura::engine::codec
