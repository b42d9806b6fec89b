#include <algorithm>
#include <atomic>
#include <optional>

#include "obscura/engine/gltf_material.h"
#include "obscura/engine/image_file.h"
#include "obscura/engine/mipmap.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine::gltf {
namespace {

using raster::Filter;
using raster::MipFilter;
using raster::Wrap;

Wrap wrapOf(int code, const std::string& path) {
  switch (code) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT: return Wrap::Repeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT: return Wrap::MirroredRepeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE: return Wrap::ClampToEdge;
    default: fail(path, std::to_string(code) + " is no wrap mode");
  }
}

// Filters that the file leaves open are the best ones: linear everywhere.
raster::TextureView samplerOf(const tinygltf::Sampler& in, const std::string& path) {
  raster::TextureView view;
  view.wrapU = wrapOf(in.wrapS, path + "/wrapS");
  view.wrapV = wrapOf(in.wrapT, path + "/wrapT");
  if (in.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) {
    view.magFilter = Filter::Nearest;
  } else if (in.magFilter != TINYGLTF_TEXTURE_FILTER_LINEAR && in.magFilter != -1) {
    fail(path + "/magFilter", std::to_string(in.magFilter) + " is no filter");
  }
  const auto set = [&](Filter filter, MipFilter mip) {
    view.minFilter = filter;
    view.mip = mip;
  };
  switch (in.minFilter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST: set(Filter::Nearest, MipFilter::None); break;
    case TINYGLTF_TEXTURE_FILTER_LINEAR: set(Filter::Linear, MipFilter::None); break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST: set(Filter::Nearest, MipFilter::Nearest); break;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST: set(Filter::Linear, MipFilter::Nearest); break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR: set(Filter::Nearest, MipFilter::Linear); break;
    case -1:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR: set(Filter::Linear, MipFilter::Linear); break;
    default: fail(path + "/minFilter", std::to_string(in.minFilter) + " is no filter");
  }
  return view;
}

bool sameSampler(const raster::TextureView& a, const raster::TextureView& b) {
  return a.wrapU == b.wrapU && a.wrapV == b.wrapV && a.magFilter == b.magFilter && a.minFilter == b.minFilter &&
         a.mip == b.mip;
}

std::vector<uint32_t> packed(const Image& image) {
  std::vector<uint32_t> texels(size_t(image.width) * size_t(image.height));
  for (size_t i = 0; i < texels.size(); ++i) {
    const uint8_t* p = &image.bytes[i * 4];
    texels[i] = uint32_t(p[0]) | uint32_t(p[1]) << 8 | uint32_t(p[2]) << 16 | uint32_t(p[3]) << 24;
  }
  return texels;
}

}  // namespace

int imageOf(Document& document, int texture, const std::string& user) {
  const tinygltf::Texture& t = at(document.model.textures, texture, "texture", user + "/index");
  if (t.source < 0 || document.images.empty()) {
    document.warnings.add("textures without an image are ignored");
    return -1;
  }
  at(document.images, t.source, "image", pointer("/textures", uint64_t(texture)) + "/source");
  return t.source;
}

raster::TextureView samplerOf(const Document& document, int texture) {
  const int sampler = document.model.textures[size_t(texture)].sampler;
  if (sampler < 0) return {};
  return samplerOf(at(document.model.samplers, sampler, "sampler", pointer("/textures", uint64_t(texture)) + "/sampler"),
                   pointer("/samplers", uint64_t(sampler)));
}

int TextureLoader::request(int texture, bool srgb, const std::string& user) {
  const int source = imageOf(document_, texture, user);
  if (source < 0) return -1;
  const std::string path = pointer("/textures", uint64_t(texture));
  const Source& image = document_.images[size_t(source)];
  raster::TextureView view = samplerOf(document_, texture);
  ImageJob& job = jobs_[source];
  if (job.variants.empty()) {
    job.path = pointer("/images", uint64_t(source));
    job.encoded = document_.imageBytes(source, path + "/source");
    job.name = !image.name.empty() ? image.name : image.hasUri && !isDataUri(image.uri) ? image.uri : job.path;
  }
  view.srgb = srgb;
  const bool mips = view.mip != MipFilter::None;
  const auto variant = std::find_if(job.variants.begin(), job.variants.end(),
                                    [&](const Texels& v) { return v.srgb == srgb && v.mips == mips; });
  const size_t texels = size_t(variant - job.variants.begin());
  if (variant == job.variants.end()) job.variants.push_back({srgb, mips, 0, 0, 1, nullptr});
  for (size_t i = 0; i < requests_.size(); ++i) {
    const Request& r = requests_[i];
    if (r.image == source && r.texels == texels && sameSampler(r.view, view)) return int(i);
  }
  requests_.push_back({source, texels, view});
  return int(requests_.size() - 1);
}

void TextureLoader::decode(ImageJob& job, std::atomic<uint64_t>& bytes) const {
  const LoadLimits& limits = document_.options.limits;
  const auto reserve = [&](uint64_t n) {
    if (bytes.fetch_add(n) + n > limits.textureBytes) {
      fail("/images", "the textures take more than the limit of " + std::to_string(limits.textureBytes) + " bytes");
    }
  };
  DecodeLimits decodeLimits;
  decodeLimits.size = limits.textureSize;
  decodeLimits.bytes = limits.textureBytes;
  Result<Image> image = decodeImageRgba8(job.encoded, job.name, decodeLimits);
  if (!image) fail(job.path, image.error().message);
  if (image->width < 1 || image->height < 1) fail(job.path, "an image without pixels");

  for (Texels& v : job.variants) {
    v.width = image->width;
    v.height = image->height;
    v.levels = v.mips ? mipLevels(v.width, v.height) : 1;
    reserve(4 * (v.mips ? mipTexels(v.width, v.height) : uint64_t(v.width) * uint64_t(v.height)));
    std::vector<uint32_t> level0 = packed(*image);
    v.data = std::make_shared<const std::vector<uint32_t>>(v.mips ? mipChain(level0, v.width, v.height, v.srgb)
                                                                  : std::move(level0));
  }
}

std::vector<Texture> TextureLoader::load() {
  std::vector<ImageJob*> jobs;
  for (auto& [image, job] : jobs_) jobs.push_back(&job);

  // The failure that is reported is that of the first image, not of the first thread.
  std::vector<std::optional<Failure>> failures(jobs.size());
  std::atomic<uint64_t> bytes{0};
  raster::Parallel().forRanges(jobs.size(), 1, [&](size_t begin, size_t end, int) {
    for (size_t i = begin; i < end; ++i) {
      try {
        decode(*jobs[i], bytes);
      } catch (const Failure& failure) {
        failures[i] = failure;
      }
    }
  });
  for (const std::optional<Failure>& failure : failures)
    if (failure) throw *failure;

  std::vector<Texture> textures;
  for (const Request& r : requests_) {
    const ImageJob& job = jobs_.at(r.image);
    const Texels& v = job.variants[r.texels];
    Texture t;
    t.name = job.name;
    t.texels = v.data;
    t.view = r.view;
    t.view.texels = *v.data;
    t.view.width = v.width;
    t.view.height = v.height;
    t.view.levels = v.levels;
    textures.push_back(std::move(t));
  }
  return textures;
}

}  // namespace obscura::engine::gltf
