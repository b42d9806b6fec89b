// Environment maps from and to images.
#include "obscura/engine/environment_map.h"

#include <new>

#include "obscura/engine/image_file.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/srgb.h"

namespace obscura::engine {
namespace {

constexpr size_t kRowsPerTask = 8;
constexpr DecodeLimits kLimits{16384, 2ull << 30};

// What the integers of a file stand for; empty for floats.
std::vector<float> radianceOfIntegers(Format format) {
  const size_t count = format == Format::U8 ? 256 : format == Format::U16 ? 65536 : 0;
  std::vector<float> table(count);
  for (size_t k = 0; k < count; ++k) table[k] = float(raster::linearFromSrgb(double(k) / double(count - 1)));
  return table;
}

Error badMap(const std::string& path, const std::string& message) { return {ErrorCode::BadInput, message, path, ""}; }

const char* shapeOf(EnvironmentProjection p) {
  switch (p) {
    case EnvironmentProjection::Latlong: return "a latlong map is twice as wide as high";
    case EnvironmentProjection::Sphere: return "a sphere map is as wide as high";
    case EnvironmentProjection::Cube: return "a cube map is a cross of 4 x 3 squares";
    case EnvironmentProjection::Paraboloid: return "a paraboloid map is two squares side by side";
  }
  return "";
}

struct Reader {
  const Image& image;
  const std::vector<float>& table;

  float at(int x, int y, int channel) const {
    const int c = image.channels >= 3 ? channel : 0, i = x * image.channels + c;
    return image.format == Format::U8    ? table[image.row<uint8_t>(y)[i]]
           : image.format == Format::U16 ? table[image.row<uint16_t>(y)[i]]
                                         : image.row<float>(y)[i];
  }
};

// The texels that the projector shows; returns how many values could not be taken as they are.
size_t readRow(const Reader& in, EnvironmentMap& map, int panel, int y) {
  const EnvironmentProjector& p = map.projector();
  const glm::ivec2 origin = p.originOf(panel);
  size_t clamped = 0;
  for (int x = 0; x < p.width; ++x) {
    if (!p.shows(x, y)) continue;
    for (int c = 0; c < 3; ++c) {
      const float v = in.at(origin.x + x, origin.y + y, c);
      const float taken = v > EnvironmentMap::kMostRadiance ? EnvironmentMap::kMostRadiance : v > 0 ? v : 0;
      clamped += !(v == taken);
      map.at(panel, x, y)[c] = taken;
    }
  }
  return clamped;
}

}  // namespace

Result<EnvironmentFile> readEnvironmentMap(const std::string& path, EnvironmentProjection projection, raster::Parallel& parallel) try {
  const Result<std::vector<uint8_t>> bytes = readImageBytes(path, kLimits);
  if (!bytes) return bytes.error();
  return decodeEnvironmentMap(*bytes, path, projection, parallel);
} catch (const std::bad_alloc&) {
  return badMap(path, "out of memory");
}

Result<EnvironmentFile> decodeEnvironmentMap(raster::Span<const uint8_t> bytes, const std::string& path, EnvironmentProjection projection,
                                             raster::Parallel& parallel) try {
  const raster::FloatEnvironment environment;
  const Result<Image> image = decodeImage(bytes, path, kLimits);
  if (!image) return image.error();
  const std::string size = std::to_string(image->width) + " x " + std::to_string(image->height);
  const std::optional<EnvironmentProjector> p = projectorOfImage(projection, image->width, image->height);
  if (!p) return badMap(path, std::string(shapeOf(projection)) + ", this image has " + size + " pixels: name another projection");
  if (image->format == Format::U32) return badMap(path, "32-bit integers are no radiance: floats, 16 or 8 bits are read");
  const std::vector<float> table = radianceOfIntegers(image->format);
  const Reader reader{*image, table};
  EnvironmentFile file;
  file.map = EnvironmentMap(*p);
  std::vector<size_t> clamped(size_t(p->panels()) * size_t(p->height));
  parallel.forRanges(clamped.size(), kRowsPerTask, [&](size_t begin, size_t end, int) {
    for (size_t row = begin; row < end; ++row)
      clamped[row] = readRow(reader, file.map, int(row / size_t(p->height)), int(row % size_t(p->height)));
  });
  for (size_t n : clamped) file.clamped += n;
  file.map.fillBorders(parallel);
  return file;
} catch (const std::bad_alloc&) {
  return badMap(path, "out of memory");
}

Image imageOfEnvironment(const EnvironmentMap& map) {
  const EnvironmentProjector& p = map.projector();
  Image image(p.imageWidth(), p.imageHeight(), 3, Format::F32);
  for (int panel = 0; panel < p.panels(); ++panel)
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        if (p.projection == EnvironmentProjection::Sphere && !p.shows(x, y)) continue;
        const glm::ivec2 at = p.originOf(panel) + glm::ivec2(x, y);
        for (int c = 0; c < 3; ++c) image.row<float>(at.y)[at.x * 3 + c] = map.at(panel, x, y)[c];
      }
  return image;
}

}  // namespace obscura::engine
