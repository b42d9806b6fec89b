// JPEG through TurboJPEG.
#include <memory>
#include <new>

#include <turbojpeg.h>

#include "obscura/engine/image_codecs.h"

namespace obscura::engine::codec {
namespace {

struct Destroy {
  void operator()(void* handle) const { tjDestroy(handle); }
};

// CMYK as Adobe stores it, inverted: 255 is no ink. RGB = (C, M, Y) K / 255, rounded.
void rgbaFromCmyk(Image& image) {
  for (size_t i = 0; i < image.bytes.size(); i += 4) {
    uint8_t* p = &image.bytes[i];
    for (int c = 0; c < 3; ++c) p[c] = uint8_t((p[c] * p[3] + 127) / 255);
    p[3] = 255;
  }
}

}  // namespace

bool isJpeg(Bytes file) { return file.size() >= 3 && file[0] == 0xFF && file[1] == 0xD8 && file[2] == 0xFF; }

Result<Image> decodeJpeg(Bytes file, const std::string& name, const DecodeLimits& limits, bool rgba8) {
  const std::unique_ptr<void, Destroy> tj(tjInitDecompress());
  if (!tj) throw std::bad_alloc();
  const auto failed = [&] { return badImage(name, std::string("broken JPEG: ") + tjGetErrorStr2(tj.get())); };
  int width = 0, height = 0, sampling = 0, colors = 0;
  if (tjDecompressHeader3(tj.get(), file.data(), file.size(), &width, &height, &sampling, &colors) != 0)
    return failed();
  const bool cmyk = colors == TJCS_CMYK || colors == TJCS_YCCK;
  const int channels = rgba8 || cmyk ? 4 : colors == TJCS_GRAY ? 1 : 3;
  if (auto error = checkSize(uint64_t(width), uint64_t(height), uint64_t(channels), Format::U8, name, limits))
    return *error;
  // A block of 8 x 8 samples takes one bit at least.
  if (uint64_t(width) * uint64_t(height) / 512 > file.size())
    return badImage(name, "broken JPEG: the file is truncated");
  Image image(width, height, channels, Format::U8);
  const int layout = cmyk ? TJPF_CMYK : channels == 4 ? TJPF_RGBA : channels == 3 ? TJPF_RGB : TJPF_GRAY;
  // The accurate DCT gives the same bits with and without SIMD; the scan limit stops progressive bombs.
  constexpr int kFlags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING;
  if (tjDecompress2(tj.get(), file.data(), file.size(), image.bytes.data(), width, width * channels, height, layout,
                    kFlags) != 0)
    return failed();
  if (cmyk) rgbaFromCmyk(image);
  return image;
}

}  // namespace obscura::engine::codec
