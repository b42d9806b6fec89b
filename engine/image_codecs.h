// The formats behind image_file.h. Every decoder checks the declared size before it allocates.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "obscura/engine/image_file.h"

namespace obscura::engine::codec {

using Bytes = raster::Span<const uint8_t>;

// What is wrong with this size, if anything; `file` is the offender's name.
std::optional<Error> checkSize(uint64_t width, uint64_t height, uint64_t channels, Format format,
                               const std::string& file, const DecodeLimits& limits);
Error badImage(const std::string& file, const std::string& message);

bool isPng(Bytes file);
// rgba8: convert to 4 channels of 8 bits; else palettes and 1, 2, 4 bit grey are expanded, and the rest stays.
Result<Image> decodePng(Bytes file, const std::string& name, const DecodeLimits& limits, bool rgba8);
Result<std::vector<uint8_t>> encodePng(const Image& image);

bool isJpeg(Bytes file);
// rgba8: as above; else 1 or 3 channels.
Result<Image> decodeJpeg(Bytes file, const std::string& name, const DecodeLimits& limits, bool rgba8);

bool isPfm(Bytes file);
// The scale's sign is the byte order; its magnitude is ignored, as everybody does.
Result<Image> decodePfm(Bytes file, const std::string& name, const DecodeLimits& limits);
Result<std::vector<uint8_t>> encodePfm(const Image& image);

bool isNpy(Bytes file);
// Arrays [H,W,C] or [H,W] of u1, u2, u4, f4 in either byte order, C order.
Result<Image> decodeNpy(Bytes file, const std::string& name, const DecodeLimits& limits);
Result<std::vector<uint8_t>> encodeNpy(const Image& image);

bool isRadiance(Bytes file);  // of the usual kind: RGB, rows from the top; others are left to the module
Result<Image> decodeRadiance(Bytes file, const std::string& name, const DecodeLimits& limits);

// Through the OpenImageIO module, loaded at the first call of either and kept until the process ends.
Result<std::vector<Layer>> decodeWithModule(Bytes file, const std::string& name, const DecodeLimits& limits);
Result<std::vector<uint8_t>> encodeWithModule(const std::string& name, const std::vector<Layer>& layers,
                                              const Placement& place);

}  // namespace obscura::engine::codec
