// In: bytes of image files, or layers.  Out: images, or image files.
// PNG and JPEG are handled by libpng and libjpeg-turbo directly, Radiance's HDR (read only), PFM and NPY by code of the
// engine's own; everything else goes through OpenImageIO, which is loaded (as a module) at the first use: it brings some
// 260 shared libraries with it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "obscura/engine/image.h"
#include "obscura/engine/result.h"
#include "obscura/raster/span.h"

namespace obscura::engine {

struct DecodeLimits {
  uint32_t size = 16384;         // pixels a side
  uint64_t bytes = 4ull << 30;   // of the decoded image
};

// Decodes to 8-bit RGBA, whatever the file holds (grey is replicated, missing alpha is 255, 16 bits are rounded
// to 8, floats are clamped to [0, 1]). Recognised by content; by the extension of `name` only where the content
// cannot tell (TGA). Colour profiles and gamma chunks are ignored. `name` is the file of the error messages.
Result<Image> decodeImageRgba8(raster::Span<const uint8_t> file, const std::string& name,
                               const DecodeLimits& limits = {});

// The same in its own channels and format, as readImage does it with a file.
Result<Image> decodeImage(raster::Span<const uint8_t> file, const std::string& name, const DecodeLimits& limits = {});

// A whole file, of at most limits.bytes; the names of the errors are the path.
Result<std::vector<uint8_t>> readImageBytes(const std::string& path, const DecodeLimits& limits = {});

// Reads any image file in its own channels and format (8, 16 and 32 bit unsigned integers stay, everything else
// becomes F32). Of a file with several layers the first, or the one named "color".
Result<Image> readImage(const std::string& path, const DecodeLimits& limits = {});

// All layers of a file, as encodeImage writes them; a file without layers has one, named "color". limits.bytes holds
// for all of them together.
Result<std::vector<Layer>> readLayers(const std::string& path, const DecodeLimits& limits = {});

enum class FileFormat { Png, Exr, Pfm, Npy, Other };  // Other: whatever OpenImageIO writes by that name
Result<FileFormat> fileFormatOf(const std::string& path);  // by extension, case-insensitive; an unknown one is an error
bool holdsLayers(FileFormat format);                       // true for EXR: many layers in one file

// Where the layers lie in a larger image; by default they are all of it.
struct Placement {
  int x = 0, y = 0;
  int imageWidth = 0, imageHeight = 0;  // 0: the layers' own
};

// Encodes to memory; layers: exactly one unless holdsLayers(format), all of one size there.
//   PNG: 1-4 channels U8 or U16, anything else is an error.  PFM: 1 or 3 channels F32.
//   NPY: any, as [H,W,C] little-endian ('<f4', '<u4', '<u2', '|u1'), format version 1.0.
//   EXR: channels "layer.channel" (the layer named "color" has bare names R, G, B), float32 or uint32, ZIP; the layers are
//        its data window, the larger image is its display window. The other formats know no place.
//   Other: the extension of `path` decides.
Result<std::vector<uint8_t>> encodeImage(FileFormat format, const std::vector<Layer>& layers,
                                         const std::string& path = {}, const Placement& place = {});

// Writes to a temporary file beside `path`, then renames: a reader never sees half an image, and a failure leaves
// what was there before and no temporary. An existing file keeps its permissions; a link is followed; what exists
// and is no regular file (a pipe, /dev/null) is written to directly. "-" is standard output.
Result<Done> writeFileAtomically(const std::string& path, raster::Span<const uint8_t> bytes);

// Deletes the temporaries that writeFileAtomically has open at this moment, in all threads. For the handler of a
// signal that is about to end the process: async-signal-safe, and the writes concerned will fail.
void removePendingTemporaries() noexcept;

}  // namespace obscura::engine
