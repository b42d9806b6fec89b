#include "obscura/apps/envmap_command.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "obscura/apps/option_text.h"
#include "obscura/apps/outputs.h"
#include "obscura/apps/pictures.h"
#include "obscura/apps/report.h"
#include "obscura/apps/setting_names.h"
#include "obscura/apps/signals.h"
#include "obscura/engine/environment_map.h"
#include "obscura/engine/image_file.h"
#include "obscura/raster/view.h"

namespace obscura::apps {
namespace {

using engine::EnvironmentMap;
using engine::EnvironmentProjection;
using engine::EnvironmentProjector;
using engine::Error;
using engine::ErrorCode;
using engine::FileFormat;
using engine::Result;

constexpr const char* kEnvmapExamples = R"(Examples:
  obscura envmap sky.hdr -o cube.exr --to cube
  obscura envmap ball.png -o sky.exr --from sphere --to latlong --size 1024x512
  obscura envmap sky.exr -o look.png --to paraboloid

A cube map is a cross of 4 x 3 squares, a paraboloid map two squares side by side. Integers are taken to be sRGB, and a
PNG gets sRGB bytes.

Exit codes: 0 done, 2 usage, 3 bad input, 4 cannot write, 128+n ended by signal n.
)";

CLI::Validator projectionName() {
  return CLI::Validator(
      [](std::string& text) {
        for (const auto& [name, value] : kProjectionNames)
          if (name == text) return std::string();
        return "\"" + text + "\" is none of latlong, sphere, cube, paraboloid";
      },
      "");
}

EnvironmentProjection projectionOf(const std::string& text) {
  for (const auto& [name, value] : kProjectionNames)
    if (name == text) return value;
  return EnvironmentProjection::Latlong;
}

Result<FileFormat> formatOf(const std::string& path) {
  const Result<FileFormat> format = engine::fileFormatOf(path);
  const std::string end = path.size() < 4 ? "" : path.substr(path.size() - 4);
  if (format && (*format != FileFormat::Other || end == ".hdr" || end == ".HDR")) return format;
  return Error{ErrorCode::Usage, "not a format that can be written; there are .exr, .hdr, .pfm, .npy and .png", path, ""};
}

// "WxH" of the image; empty text: as many texels as the input has.
Result<EnvironmentProjector> sizeOf(const std::string& text, EnvironmentProjection to, const EnvironmentProjector& from) {
  if (text.empty()) {
    const EnvironmentProjector same = engine::projectorOfTexels(to, engine::usedTexels(from));
    return from.projection == to ? from : same;
  }
  int size[2] = {0, 0};
  const bool good = readSize(text, size[0], size[1]);
  const auto p = good ? engine::projectorOfImage(to, size[0], size[1]) : std::nullopt;
  if (p) return *p;
  const std::string shape = to == EnvironmentProjection::Cube ? "4 to 3" : to == EnvironmentProjection::Sphere ? "1 to 1" : "2 to 1";
  return Error{ErrorCode::Usage, "--size: \"" + text + "\" is not the size WxH of a " + nameOf(kProjectionNames, to) + " map: " + shape + ", up to " + std::to_string(raster::kMaxImageSize) + " a side", "", ""};
}

Result<std::vector<uint8_t>> encode(FileFormat format, const EnvironmentMap& map, const std::string& path) {
  engine::Image image = engine::imageOfEnvironment(map);
  if (format == FileFormat::Png) image = srgbPicture(image, 8);
  Result<std::vector<uint8_t>> bytes = engine::encodeImage(format, {{"color", {"R", "G", "B"}, std::move(image)}}, path);
  if (bytes) return bytes;
  Error error = bytes.error();
  error.code = ErrorCode::CannotWrite;
  return error;
}

std::string described(const EnvironmentProjector& p) {
  return nameOf(kProjectionNames, p.projection) + " " + std::to_string(p.imageWidth()) + "x" + std::to_string(p.imageHeight());
}

}  // namespace

void EnvmapCommand::addTo(CLI::App& program) {
  CLI::App& c = *program.add_subcommand("envmap", "converts an environment map to another projection");
  c.footer(kEnvmapExamples);
  c.add_option("IN", input_, "an environment map, any image: .hdr, .exr, .png, ...")->required()->type_name("");
  c.add_option("-o,--output", output_, "file to write: .exr, .hdr, .pfm, .npy (linear floats) or .png (sRGB)")->required()->type_name("FILE");
  const char* names = "latlong|sphere|cube|paraboloid";
  c.add_option("--to", to_, "projection to write")->required()->check(projectionName())->type_name(names);
  c.add_option("--from", from_, "projection of the input [latlong]")->check(projectionName())->type_name(names);
  c.add_option("--size", size_, "of the image that is written, in pixels [as many texels as the input]")->type_name("WxH");
}

int EnvmapCommand::run() {
  endCleanlyOnSignals();
  const Result<FileFormat> format = formatOf(output_);
  if (!format) return fail(format.error());
  const EnvironmentProjection to = projectionOf(to_);
  if (const auto asked = sizeOf(size_, to, {to, 2, 2}); !asked) return fail(asked.error());
  if (const auto writable = checkWritable(output_); !writable) return fail(writable.error());
  raster::Parallel parallel;
  const Result<engine::EnvironmentFile> in = engine::readEnvironmentMap(input_, projectionOf(from_), parallel);
  if (!in) return fail(in.error());
  if (in->clamped > 0) printWarning(input_ + ": " + std::to_string(in->clamped) + " values are negative, no numbers or too large: clamped");
  const Result<EnvironmentProjector> size = sizeOf(size_, to, in->map.projector());
  if (!size) return fail(size.error());
  const EnvironmentMap out = engine::convertEnvironment(in->map, *size, parallel);
  const engine::EnvironmentDifference lost = engine::compareEnvironments(in->map, out, parallel);
  const Result<std::vector<uint8_t>> bytes = encode(*format, out, output_);
  if (!bytes) return fail(bytes.error());
  if (const auto done = engine::writeFileAtomically(output_, *bytes); !done) return fail(done.error());
  std::printf("%s -> %s\nround_trip_rmse %.6g\nround_trip_relative %.6g\nround_trip_largest %.6g\nround_trip_rmse_below_1 %.6g\n",
              described(in->map.projector()).c_str(), described(out.projector()).c_str(), lost.rmse, lost.relative, lost.largest, lost.clamped);
  return std::fflush(stdout) == 0 ? kDone : kCannotWrite;
}

}  // namespace obscura::apps
