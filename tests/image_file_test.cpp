#include <catch2/catch.hpp>

#include <turbojpeg.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "obscura/engine/image_file.h"
#include "temporary_folder.h"

using namespace obscura::engine;
using Bytes = std::vector<uint8_t>;

namespace {

// Elements that no conversion would leave alone; floats get NaN payloads, infinities and denormals among them.
Image pattern(int width, int height, int channels, Format format, uint32_t seed = 1) {
  Image image(width, height, channels, format);
  uint64_t state = seed;
  for (uint8_t& b : image.bytes) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    b = uint8_t(state >> 56);
  }
  if (format == Format::F32) {
    float* f = image.row<float>(0);
    f[0] = std::numeric_limits<float>::infinity();
    if (image.bytes.size() >= 12) f[1] = -0.0f, f[2] = 1e-42f;
  }
  return image;
}

std::vector<Layer> one(const Image& image) { return {{"color", {}, image}}; }

Bytes encoded(FileFormat format, const std::vector<Layer>& layers, const std::string& path = {}) {
  const auto r = encodeImage(format, layers, path);
  INFO((r ? "" : r.error().text()));
  REQUIRE(r.ok());
  return *r;
}

void put(const std::string& path, const Bytes& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

void requireSame(const Image& a, const Image& b) {
  REQUIRE(a.width == b.width);
  REQUIRE(a.height == b.height);
  REQUIRE(a.channels == b.channels);
  REQUIRE(a.format == b.format);
  REQUIRE(a.bytes == b.bytes);
}

Image readBack(const TemporaryFolder& folder, const std::string& name, const Bytes& bytes) {
  put(folder / name, bytes);
  const auto r = readImage(folder / name);
  INFO((r ? "" : r.error().text()));
  REQUIRE(r.ok());
  return *r;
}

Bytes jpegOf(int width, int height, bool grey) {
  Bytes pixels(size_t(width * height) * 3, 200);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  tjhandle tj = tjInitCompress();
  tjCompress2(tj, pixels.data(), width, 0, height, grey ? TJPF_GRAY : TJPF_RGB, &out, &size,
              grey ? TJSAMP_GRAY : TJSAMP_444, 95, 0);
  Bytes bytes(out, out + size);
  tjFree(out);
  tjDestroy(tj);
  return bytes;
}

Bytes text(const std::string& s) { return Bytes(s.begin(), s.end()); }

uint32_t crcOf(const uint8_t* data, size_t size) {
  uint32_t crc = 0xFFFFFFFFu;
  for (size_t i = 0; i < size; ++i) {
    crc ^= data[i];
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
  }
  return ~crc;
}

// A valid PNG with another size in its header, as a hostile file would have.
Bytes withPngSize(Bytes png, uint32_t width, uint32_t height) {
  for (int i = 0; i < 4; ++i) {
    png[16 + i] = uint8_t(width >> (24 - 8 * i));
    png[20 + i] = uint8_t(height >> (24 - 8 * i));
  }
  const uint32_t crc = crcOf(&png[12], 17);
  for (int i = 0; i < 4; ++i) png[29 + i] = uint8_t(crc >> (24 - 8 * i));
  return png;
}

}  // namespace

TEST_CASE("image file: a PNG, and PNG and JPEG decoding, never load OpenImageIO") {
  // First in this file; it looks at the whole process, so it only means something before an EXR was asked for.
  const auto loaded = [] {
    std::ifstream maps("/proc/self/maps");
    const std::string all((std::istreambuf_iterator<char>(maps)), {});
    return all.find("OpenImageIO") != all.npos;
  };
  if (loaded()) return;
  const Bytes png = encoded(FileFormat::Png, one(pattern(5, 4, 3, Format::U8)));
  REQUIRE(decodeImageRgba8(png, "a.png").ok());
  REQUIRE(decodeImageRgba8(jpegOf(16, 16, false), "a.jpg").ok());
  REQUIRE_FALSE(loaded());
}

TEST_CASE("image file: 8 and 16 bit PNGs of 1 to 4 channels come back bit for bit") {
  const TemporaryFolder folder;
  for (const Format format : {Format::U8, Format::U16})
    for (int channels = 1; channels <= 4; ++channels) {
      const Image image = pattern(37, 11, channels, format);
      requireSame(image, readBack(folder, "a.png", encoded(FileFormat::Png, one(image))));
    }
}

TEST_CASE("image file: PFM and NPY come back bit for bit in every format they have") {
  const TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    const Image image = pattern(7, 5, channels, Format::F32);
    requireSame(image, readBack(folder, "a.pfm", encoded(FileFormat::Pfm, one(image))));
  }
  for (const Format format : {Format::U8, Format::U16, Format::U32, Format::F32})
    for (const int channels : {1, 2, 5}) {
      const Image image = pattern(7, 5, channels, format);
      requireSame(image, readBack(folder, "a.npy", encoded(FileFormat::Npy, one(image))));
    }
}

TEST_CASE("image file: a PFM is bottom-up, little-endian when written, either when read") {
  Image image(1, 2, 1, Format::F32);
  image.row<float>(0)[0] = 1.0f;  // 00 00 80 3f
  image.row<float>(1)[0] = 2.0f;  // 00 00 00 40
  Bytes expected = text("Pf\n1 2\n-1.0\n");
  expected.insert(expected.end(), {0, 0, 0, 0x40, 0, 0, 0x80, 0x3F});
  REQUIRE(encoded(FileFormat::Pfm, one(image)) == expected);

  Bytes big = text("Pf 1\n2\n1.0\n");
  big.insert(big.end(), {0x40, 0, 0, 0, 0x3F, 0x80, 0, 0});
  const TemporaryFolder folder;
  requireSame(image, readBack(folder, "b.pfm", big));
}

TEST_CASE("image file: an NPY has numpy's header, its data at a multiple of 64 bytes") {
  const Bytes npy = encoded(FileFormat::Npy, one(pattern(3, 2, 4, Format::U32)));
  REQUIRE(npy.size() == 128 + 3 * 2 * 4 * 4);
  const std::string header(npy.begin(), npy.begin() + 128);
  REQUIRE(header.substr(0, 10) == std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  REQUIRE(header.substr(10, 62) == "{'descr': '<u4', 'fortran_order': False, 'shape': (2, 3, 4), }");
  REQUIRE(header.back() == '\n');
  REQUIRE(header.find_first_not_of(' ', 72) == 127);

  const TemporaryFolder folder;
  Bytes big = text("\x93NUMPY\x02");
  const std::string dict = "{\"shape\": (1, 2), 'fortran_order':False, 'descr':'>u2'}\n";
  big.insert(big.end(), {0, uint8_t(dict.size()), 0, 0, 0});
  for (const char c : dict) big.push_back(uint8_t(c));
  big.insert(big.end(), {1, 2, 3, 4});
  const Image image = readBack(folder, "b.npy", big);
  REQUIRE(image.format == Format::U16);
  REQUIRE(image.row<uint16_t>(0)[0] == 0x0102);
  REQUIRE(image.row<uint16_t>(0)[1] == 0x0304);
}

TEST_CASE("image file: an EXR mixes float32 and uint32 layers and gives every bit back") {
  const TemporaryFolder folder;
  const std::vector<Layer> layers = {{"color", {"R", "G", "B"}, pattern(70, 130, 3, Format::F32, 1)},
                                     {"depth", {"Z"}, pattern(70, 130, 1, Format::F32, 2)},
                                     {"normal", {"X", "Y", "Z"}, pattern(70, 130, 3, Format::F32, 3)},
                                     {"triangle", {"id"}, pattern(70, 130, 1, Format::U32, 4)}};
  put(folder / "a.exr", encoded(FileFormat::Exr, layers));
  const auto back = readLayers(folder / "a.exr");
  INFO((back ? "" : back.error().text()));
  REQUIRE(back.ok());
  REQUIRE(back->size() == layers.size());
  for (size_t i = 0; i < layers.size(); ++i) {
    INFO(layers[i].name);
    REQUIRE((*back)[i].name == layers[i].name);
    REQUIRE((*back)[i].channels == layers[i].channels);
    requireSame(layers[i].image, (*back)[i].image);
  }
  const auto main = readImage(folder / "a.exr");
  REQUIRE(main.ok());
  requireSame(layers[0].image, *main);
}

TEST_CASE("image file: other formats go through OpenImageIO, in memory") {
  const TemporaryFolder folder;
  const Image image = pattern(20, 10, 3, Format::U8);
  requireSame(image, readBack(folder, "a.tif", encoded(FileFormat::Other, one(image), "a.tif")));
  requireSame(image, readBack(folder, "a.tga", encoded(FileFormat::Other, one(image), "a.tga")));
  const auto rgba = decodeImageRgba8(encoded(FileFormat::Other, one(image), "a.bmp"), "texture");
  REQUIRE(rgba.ok());
  REQUIRE(rgba->channels == 4);
  REQUIRE(rgba->bytes[5] == image.bytes[4]);
  REQUIRE_FALSE(encodeImage(FileFormat::Other, one(image), "a.nonsense").ok());
}

TEST_CASE("image file: decoding to RGBA replicates grey, adds alpha and rounds 16 bits") {
  Image grey(2, 1, 1, Format::U16);
  grey.row<uint16_t>(0)[0] = 128;    // 0.498 of 255: 0
  grey.row<uint16_t>(0)[1] = 0x81FF; // 129.49..: 129
  auto r = decodeImageRgba8(encoded(FileFormat::Png, one(grey)), "grey");
  REQUIRE(r.ok());
  REQUIRE(r->bytes == Bytes{0, 0, 0, 255, 129, 129, 129, 255});

  Image greyAlpha(1, 1, 2, Format::U8);
  greyAlpha.bytes = {7, 9};
  r = decodeImageRgba8(encoded(FileFormat::Png, one(greyAlpha)), "grey and alpha");
  REQUIRE(r.ok());
  REQUIRE(r->bytes == Bytes{7, 7, 7, 9});

  Image floats(1, 2, 3, Format::F32);
  const float values[] = {-1, 0.5f, 2, std::numeric_limits<float>::quiet_NaN(), 1, 0.25f};
  std::memcpy(floats.bytes.data(), values, sizeof values);
  r = decodeImageRgba8(encoded(FileFormat::Pfm, one(floats)), "floats");
  REQUIRE(r.ok());
  REQUIRE(r->bytes == Bytes{0, 128, 255, 255, 0, 255, 64, 255});

  for (const bool isGrey : {false, true}) {
    r = decodeImageRgba8(jpegOf(9, 7, isGrey), "jpeg");
    REQUIRE(r.ok());
    REQUIRE(r->bytes.size() == 9 * 7 * 4);
    for (size_t i = 0; i < r->bytes.size(); ++i) REQUIRE(std::abs(r->bytes[i] - (i % 4 == 3 ? 255 : 200)) <= 1);
  }
}

TEST_CASE("image file: a truncated file of any format is an error, at every length") {
  const Image image = pattern(9, 6, 3, Format::U8), floats = pattern(9, 6, 3, Format::F32);
  std::vector<Layer> exr = {{"color", {"R", "G", "B"}, floats}};
  const std::vector<Bytes> files = {encoded(FileFormat::Png, one(image)), encoded(FileFormat::Pfm, one(floats)),
                                    encoded(FileFormat::Npy, one(floats)), encoded(FileFormat::Exr, exr),
                                    jpegOf(40, 30, false)};
  for (size_t f = 0; f < files.size(); ++f)
    for (size_t size = 0; size < files[f].size(); size += f == 3 ? 37 : 1) {
      INFO("file " << f << " cut to " << size << " of " << files[f].size());
      const Bytes cut(files[f].begin(), files[f].begin() + long(size));
      const auto r = decodeImageRgba8(cut, "cut");
      // All that may be missing is what follows the pixels: PNG's and JPEG's end marks.
      if (r) REQUIRE((f == 4 && size + 2 >= files[f].size()));
      else REQUIRE(r.error().code == ErrorCode::BadInput);
    }
}

TEST_CASE("image file: flipped bits give an image or an error, never anything else") {
  const Image image = pattern(9, 6, 3, Format::U8);
  const std::vector<Bytes> files = {encoded(FileFormat::Png, one(image)), jpegOf(24, 24, false),
                                    encoded(FileFormat::Npy, one(image)),
                                    encoded(FileFormat::Pfm, one(pattern(3, 3, 1, Format::F32)))};
  const DecodeLimits limits{256, 1 << 20};
  int refused = 0;
  for (const Bytes& file : files)
    for (size_t bit = 0; bit < file.size() * 8; bit += 3) {
      Bytes bad = file;
      bad[bit / 8] = uint8_t(bad[bit / 8] ^ (1 << bit % 8));
      const auto r = decodeImageRgba8(bad, "flipped", limits);
      if (r) REQUIRE(r->bytes.size() == size_t(r->width) * size_t(r->height) * 4);
      else ++refused;
    }
  REQUIRE(refused > 300);
}

TEST_CASE("image file: a giant declared size is refused before memory is taken") {
  const Bytes png = encoded(FileFormat::Png, one(pattern(4, 4, 3, Format::U8)));
  const std::pair<uint32_t, uint32_t> sizes[] = {{20000, 4}, {4, 0x7FFFFFFF}, {16000, 16000}, {0x7FFFFFFF, 0x7FFFFFFF}};
  for (const auto& size : sizes) {
    INFO(size.first << " x " << size.second);
    const auto r = decodeImageRgba8(withPngSize(png, size.first, size.second), "giant.png");
    REQUIRE_FALSE(r.ok());
    REQUIRE(r.error().file == "giant.png");
  }
  Bytes jpeg = jpegOf(16, 16, false);
  for (size_t i = 0; i + 8 < jpeg.size(); ++i)
    if (jpeg[i] == 0xFF && jpeg[i + 1] == 0xC0) jpeg[i + 5] = jpeg[i + 6] = jpeg[i + 7] = jpeg[i + 8] = 0x3F;
  REQUIRE(decodeImageRgba8(jpeg, "giant.jpg").error().message.find("truncated") != std::string::npos);
  REQUIRE_FALSE(decodeImageRgba8(text("PF\n16000 16000\n-1\n1234"), "giant.pfm").ok());
  REQUIRE_FALSE(decodeImageRgba8(text("PF\n99999999999 99999999999\n-1\n1234"), "giant.pfm").ok());

  const TemporaryFolder folder;
  const Image large = pattern(40, 30, 4, Format::U8);
  put(folder / "a.png", encoded(FileFormat::Png, one(large)));
  DecodeLimits limits;
  limits.size = 39;
  REQUIRE(readImage(folder / "a.png", limits).error().message == "image too large: 40 x 30 pixels");
  limits.size = 40;
  REQUIRE(readImage(folder / "a.png", limits).ok());
}

TEST_CASE("image file: what cannot be read says which file and why") {
  const TemporaryFolder folder;
  const auto missing = readImage(folder / "missing.png");
  REQUIRE(missing.error().code == ErrorCode::BadInput);
  REQUIRE(missing.error().text() == (folder / "missing.png") + ": cannot read: No such file or directory");
  REQUIRE(readImage(folder.path).error().message == "cannot read: Is a directory");
  put(folder / "empty.png", {});
  REQUIRE_FALSE(readImage(folder / "empty.png").ok());
  REQUIRE_FALSE(decodeImageRgba8(text("hello"), "movie.mp4").ok());
}

TEST_CASE("image file: what a format does not hold is a usage error") {
  const auto code = [](FileFormat f, const std::vector<Layer>& layers) {
    return encodeImage(f, layers, "x").error().code;
  };
  const Image u8 = pattern(2, 2, 3, Format::U8), f32 = pattern(2, 2, 3, Format::F32);
  REQUIRE(code(FileFormat::Png, one(f32)) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Png, one(pattern(2, 2, 5, Format::U8))) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Pfm, one(u8)) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Pfm, one(pattern(2, 2, 2, Format::F32))) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Png, {}) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Png, {one(u8)[0], one(u8)[0]}) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Exr, {{"color", {"R", "G", "B"}, u8}}) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Exr, {{"color", {"R"}, f32}}) == ErrorCode::Usage);
  Image lying = f32;
  lying.height = 3;
  REQUIRE(code(FileFormat::Npy, one(lying)) == ErrorCode::Usage);
  REQUIRE(code(FileFormat::Npy, one(Image())) == ErrorCode::Usage);
}

TEST_CASE("image file: the extension decides the format, whatever its case") {
  REQUIRE(*fileFormatOf("a/b.PNG") == FileFormat::Png);
  REQUIRE(*fileFormatOf("b.exr") == FileFormat::Exr);
  REQUIRE(*fileFormatOf("b.c.Npy") == FileFormat::Npy);
  REQUIRE(*fileFormatOf("b.pfm") == FileFormat::Pfm);
  REQUIRE(*fileFormatOf("b.tiff") == FileFormat::Other);
  REQUIRE(fileFormatOf("b.docx").error().code == ErrorCode::Usage);
  REQUIRE_FALSE(fileFormatOf("folder.png/b").ok());
  REQUIRE_FALSE(fileFormatOf("").ok());
}
