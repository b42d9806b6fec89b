#include <cmath>
#include <stdexcept>
#include <string>

#include "obscura/raster/rasterizer.h"
#include "obscura/raster/view.h"

namespace obscura::raster {
namespace {

template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::string text = "obscura raster: ";
  auto add = [&](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(part)>>) text += std::to_string(part);
    else text += part;
  };
  (add(parts), ...);
  throw std::invalid_argument(text);
}

void checkSlot(const TextureSlot& slot, size_t textures, size_t material) {
  if (slot.texture >= 0 && size_t(slot.texture) >= textures)
    fail("material ", material, " uses texture ", slot.texture, " of ", textures);
  if (slot.uvSet < 0 || slot.uvSet > 1) fail("material ", material, " uses uv set ", slot.uvSet, ", not 0 or 1");
}

void checkTexture(const TextureView& t, size_t index) {
  if (t.width < 1 || t.height < 1 || t.width > 32768 || t.height > 32768)
    fail("texture ", index, " has ", t.width, " x ", t.height, " texels, not 1 ... 32768");
  if (t.levels < 1 || t.levels > 16) fail("texture ", index, " has ", t.levels, " levels, not 1 ... 16");
  size_t texels = 0;
  for (int k = 0; k < t.levels; ++k) texels += size_t(std::max(1, t.width >> k)) * size_t(std::max(1, t.height >> k));
  if (t.texels.size() < texels) fail("texture ", index, " holds ", t.texels.size(), " texels of ", texels);
}

void checkHeights(const HeightView& h, size_t index) {
  if (h.width < 1 || h.height < 1 || h.width > 32768 || h.height > 32768)
    fail("height map ", index, " has ", h.width, " x ", h.height, " heights, not 1 ... 32768");
  if (h.heights.size() < size_t(h.width) * size_t(h.height)) fail("height map ", index, " holds only ", h.heights.size(), " heights");
}

void checkMesh(const MeshView& m, size_t instance) {
  const size_t n = m.positions.size();
  if (n > 0x20000000u || m.indices.size() > 0x7FFFFFFFu)
    fail("instance ", instance, " has ", n, " vertices and ", m.indices.size(), " indices, too many");
  if (m.indices.size() % 3 != 0) fail("instance ", instance, " has ", m.indices.size(), " indices, not a multiple of 3");
  for (size_t k : {m.normals.size(), m.tangents.size(), m.uvs[0].size(), m.uvs[1].size(), m.colors.size()})
    if (k != 0 && k != n) fail("instance ", instance, " has an attribute of ", k, " elements for ", n, " vertices");
  if (!m.clusters)
    for (uint32_t index : m.indices)
      if (index >= n) fail("instance ", instance, " has vertex ", index, " of ", n);
  if (m.clusters && m.clusters->triangleCount != m.triangleCount())
    fail("instance ", instance, " has clusters of ", m.clusters->triangleCount, " triangles for ", m.triangleCount());
}

// All of it within half of kMaxImageSize from the image's centre; twice the distances, as half a pixel is no integer.
void checkWindow(const Window& w, int width, int height) {
  const auto fits = [](int first, int size, int image) {
    const int64_t begin = int64_t(first) * 2 - image, end = begin + int64_t(size) * 2;
    return size >= 1 && begin >= -kMaxImageSize && end <= kMaxImageSize;
  };
  if (!fits(w.x, w.width, width) || !fits(w.y, w.height, height))
    fail("window of ", w.width, " x ", w.height, " pixels at ", w.x, ", ", w.y, " of an image of ", width, " x ", height,
         ": it is empty, or reaches farther than ", kMaxImageSize / 2, " pixels from the image's centre");
}

}  // namespace

void checkPlanes(const PlaneSet& planes) {
  if (planes.depth2 && !(planes.separation > 0 && std::isfinite(planes.separation)))
    fail("separation ", planes.separation, " of depth2, not positive and finite");
  if (planes.relief && !planes.normal) fail("the planes of the relief are asked for without the normal's");
}

void checkArguments(const DrawList& list, const Camera& c, int width, int height, const std::optional<Window>& window) {
  if (width < 1 || height < 1 || width > kMaxImageSize || height > kMaxImageSize)
    fail("image of ", width, " x ", height, " pixels, not 1 ... ", kMaxImageSize);
  if (window) checkWindow(*window, width, height);
  const bool perspective = c.projection == Projection::Perspective;
  for (float v : {c.xScale, c.yScale, c.xShift, c.yShift, c.zNear, c.zFar})
    if (!std::isfinite(v) || std::fabs(v) > 1e30f) fail("camera parameter ", v);
  if (!(c.xScale > 0) || !(c.yScale > 0)) fail("camera scale ", c.xScale, ", ", c.yScale, ", not positive");
  if (perspective ? c.zNear < 1e-30f : c.zNear < 0) fail("camera zNear ", c.zNear);
  if (perspective ? c.zFar != 0 && !(c.zFar > c.zNear) : !(c.zFar > c.zNear)) fail("camera zFar ", c.zFar, " for zNear ", c.zNear);

  for (size_t k = 0; k < list.textures.size(); ++k) checkTexture(list.textures[k], k);
  for (size_t k = 0; k < list.materials.size(); ++k)
    for (const TextureSlot* s : {&list.materials[k].baseColorMap, &list.materials[k].metallicRoughnessMap,
                                 &list.materials[k].normalMap, &list.materials[k].emissiveMap})
      checkSlot(*s, list.textures.size(), k);
  for (size_t k = 0; k < list.heights.size(); ++k) checkHeights(list.heights[k], k);
  for (size_t k = 0; k < list.materials.size(); ++k) {
    const Material& m = list.materials[k];
    if (m.heightMap.texture < 0) continue;
    if (size_t(m.heightMap.texture) >= list.heights.size() || m.heightMap.uvSet < 0 || m.heightMap.uvSet > 1)
      fail("material ", k, " uses height map ", m.heightMap.texture, " of ", list.heights.size(), " with uv set ", m.heightMap.uvSet);
    if (!(m.heightScale >= 0 && m.heightScale <= 1e15f)) fail("material ", k, " has a height of ", m.heightScale);
  }
  uint64_t triangles = 0;
  const MeshView* last = nullptr;
  for (size_t k = 0; k < list.instances.size(); ++k) {
    const Instance& i = list.instances[k];
    if (!i.mesh) fail("instance ", k, " has no mesh");
    if (i.material >= list.materials.size()) fail("instance ", k, " has material ", i.material, " of ", list.materials.size());
    if (i.mesh != last) checkMesh(*i.mesh, k);
    last = i.mesh;
    triangles += i.mesh->triangleCount();
  }
  for (size_t k = 0; k < list.implicits.size(); ++k) {
    const ImplicitSurface& s = list.implicits[k];
    if (const char* wrong = wrongImplicit(s)) fail("implicit surface ", k, ": ", wrong);
    if (s.material >= list.materials.size()) fail("implicit surface ", k, " has material ", s.material, " of ", list.materials.size());
  }
  triangles += list.implicits.size();
  if (triangles >= kNoTriangle) fail(triangles, " triangles and implicit surfaces: ids have 32 bits");
}

}  // namespace obscura::raster
