// Materials and textures as plain data: what resolve needs to turn attributes into albedo, normal and emission.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "obscura/raster/span.h"

namespace obscura::raster {

enum class Wrap : uint8_t { Repeat, MirroredRepeat, ClampToEdge };
enum class Filter : uint8_t { Nearest, Linear };
enum class MipFilter : uint8_t { None, Nearest, Linear };

// One image with its sampler. Texels are RGBA, 8 bits a channel, R in the lowest byte; all levels follow one
// another without padding, level k of max(1, width >> k) x max(1, height >> k) texels, row 0 first (v = 0).
struct TextureView {
  Span<const uint32_t> texels;
  int width = 0, height = 0;  // 1 ... 32768
  int levels = 1;             // levels that `texels` holds; only level 0 is read when mip is None
  bool srgb = false;          // RGB are sRGB-encoded; alpha never is
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
  Filter magFilter = Filter::Linear, minFilter = Filter::Linear;
  MipFilter mip = MipFilter::Linear;
};

// A height map: heights 0 ... 1, row 0 first (v = 0), linear between their centres.
struct HeightView {
  Span<const float> heights;
  int width = 0, height = 0;  // 1 ... 32768
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
};

// A use of a texture: u' = m00 u + m01 v + m02, v' = m10 u + m11 v + m12 (KHR_texture_transform).
struct TextureSlot {
  int texture = -1;  // index into the frame's textures; -1: none
  int uvSet = 0;     // 0 or 1
  std::array<float, 6> uvFromUv = {1, 0, 0, 0, 1, 0};
};

enum class AlphaMode : uint8_t {
  Opaque,
  Mask,  // a pixel is covered where alpha >= alphaCutoff, decided per pixel in the visibility pass
};

struct Material {
  glm::vec4 baseColor{1, 1, 1, 1};  // linear
  glm::vec3 emissive{0, 0, 0};      // linear, any non-negative value
  float metallic = 1, roughness = 1;
  float alphaCutoff = 0.5f;
  float normalScale = 1;
  AlphaMode alphaMode = AlphaMode::Opaque;
  bool doubleSided = false;
  bool unlit = false;  // KHR_materials_unlit: reflects nothing (albedo 0) and emits its base colour
  TextureSlot baseColorMap, metallicRoughnessMap, normalMap, emissiveMap;
  TextureSlot heightMap;  // texture: index into DrawList::heights; displaces the surface inwards, see relief.h
  float heightScale = 0;  // of heightMap: object space, how deep h = 0 lies; >= 0
};

// It may send out light of its own.
inline bool emits(const Material& m) { return m.unlit || m.emissive.x > 0 || m.emissive.y > 0 || m.emissive.z > 0; }

}  // namespace obscura::raster
