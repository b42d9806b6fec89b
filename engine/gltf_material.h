// In: a document and which of its materials are drawn.  Out: materials, and the textures they sample.
// Private to engine/gltf*.cpp.
#pragma once

#include <atomic>
#include <map>
#include <memory>

#include "obscura/engine/gltf_document.h"
#include "obscura/engine/gltf_geometry.h"

namespace obscura::engine::gltf {

struct Materials {
  std::vector<raster::Material> materials;  // those of the file, then the default one
  std::vector<std::string> names;
  std::vector<VertexNeeds> needs;           // alike
  std::vector<Texture> textures;
  std::vector<HeightMap> heightMaps;
};

// The image of a texture, -1 with a warning where it has none; and its sampler.
int imageOf(Document& document, int texture, const std::string& user);
raster::TextureView samplerOf(const Document& document, int texture);

// Decodes the height maps of materials: the first channel of an image, in its own depth.
class HeightLoader {
 public:
  explicit HeightLoader(Document& document) : document_(document) {}
  // The index the map has in the scene, or -1 with a warning: the file names no image for it.
  int request(int texture, const std::string& user);
  std::vector<HeightMap> heightMaps;

 private:
  Document& document_;
  std::map<int, int> known_;  // by texture
  uint64_t bytes_ = 0;
};

// `used[i]`: material i of the file is drawn; the textures of others are not looked at. Images are decoded in
// parallel, each once; those of one image, colour space and mip filter share their texels.
Materials readMaterials(Document& document, const std::vector<bool>& used);

// A use of a texture of the file, and what decodes them all.
class TextureLoader {
 public:
  explicit TextureLoader(Document& document) : document_(document) {}
  // The index the texture will have in the scene, or -1 with a warning: the file names no image for it.
  int request(int texture, bool srgb, const std::string& user);
  std::vector<Texture> load();

 private:
  struct Texels {  // of one image in one colour space, with or without mip levels
    bool srgb, mips;
    int width = 0, height = 0, levels = 1;
    std::shared_ptr<const std::vector<uint32_t>> data;
  };
  struct Request {
    int image;
    size_t texels;  // into ImageJob::variants
    raster::TextureView view;
  };
  struct ImageJob {
    Bytes encoded;
    std::string name, path;
    std::vector<Texels> variants;
  };
  void decode(ImageJob& job, std::atomic<uint64_t>& bytes) const;

  Document& document_;
  std::map<int, ImageJob> jobs_;  // by image
  std::vector<Request> requests_;
};

}  // namespace obscura::engine::gltf
