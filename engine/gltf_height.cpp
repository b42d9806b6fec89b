#include "obscura/engine/gltf_material.h"
#include "obscura/engine/image_file.h"

namespace obscura::engine::gltf {
namespace {

// First channel, 0 ... 1; NaN is 0.
std::vector<float> heightsOf(const Image& image) {
  std::vector<float> heights(size_t(image.width) * size_t(image.height));
  const size_t step = size_t(image.channels);
  for (size_t i = 0; i < heights.size(); ++i) {
    float h = 0;
    switch (image.format) {
      case Format::U8: h = float(image.row<uint8_t>(0)[i * step]) / 255.0f; break;
      case Format::U16: h = float(image.row<uint16_t>(0)[i * step]) / 65535.0f; break;
      case Format::U32: h = float(double(image.row<uint32_t>(0)[i * step]) / 4294967295.0); break;
      case Format::F32: h = image.row<float>(0)[i * step]; break;
    }
    heights[i] = h > 0 ? (h < 1 ? h : 1) : 0;
  }
  return heights;
}

}  // namespace

int HeightLoader::request(int texture, const std::string& user) {
  const auto known = known_.find(texture);
  if (known != known_.end()) return known->second;
  const int source = imageOf(document_, texture, user);
  if (source < 0) return known_[texture] = -1;
  const raster::TextureView sampler = samplerOf(document_, texture);
  const std::string path = pointer("/images", uint64_t(source));
  const LoadLimits& limits = document_.options.limits;
  DecodeLimits decodeLimits;
  decodeLimits.size = limits.textureSize;
  decodeLimits.bytes = limits.textureBytes;
  HeightMap map;
  map.name = document_.images[size_t(source)].name.empty() ? path : document_.images[size_t(source)].name;
  const Result<Image> image =
      decodeImage(document_.imageBytes(source, pointer("/textures", uint64_t(texture)) + "/source"), map.name, decodeLimits);
  if (!image) fail(path, image.error().message);
  if (image->width < 1 || image->height < 1) fail(path, "an image without pixels");
  bytes_ += 4 * uint64_t(image->width) * uint64_t(image->height);
  if (bytes_ > limits.textureBytes)
    fail("/images", "the height maps take more than the limit of " + std::to_string(limits.textureBytes) + " bytes");
  map.heights = std::make_shared<const std::vector<float>>(heightsOf(*image));
  map.view = {*map.heights, image->width, image->height, sampler.wrapU, sampler.wrapV};
  heightMaps.push_back(std::move(map));
  return known_[texture] = int(heightMaps.size()) - 1;
}

}  // namespace obscura::engine::gltf
