#include "test_scene.h"

#include <cstdio>

namespace obscura::tests {

using namespace raster;

void TestScene::place(TestMesh& mesh, uint32_t material, const glm::dmat4& worldFromObject, bool clusters) {
  MeshView& v = mesh.view;
  v.positions = mesh.positions;
  v.normals = mesh.normals;
  v.tangents = mesh.tangents;
  v.uvs[0] = mesh.uvs;
  v.colors = mesh.colors;
  v.indices = mesh.indices;
  if (clusters && mesh.clusters.empty()) mesh.clusters = buildClusters(mesh.positions, mesh.indices);
  v.clusters = clusters ? &mesh.clusters : nullptr;
  instances.push_back({&v, material, worldFromObject});
}

void TestScene::addQuad(TestMesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const uint32_t first = uint32_t(mesh.positions.size());
  for (const glm::vec3& p : {a, b, c, d}) mesh.positions.push_back(p);
  for (uint32_t i : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(first + i);
}

TestScene soupScene(uint32_t seed) {
  Random random(seed);
  TestScene s;
  const int triangles = seed % 3 == 0 ? 20 : seed % 3 == 1 ? 1500 : 250;
  const float size = seed % 3 == 0 ? 3.f : seed % 3 == 1 ? 0.05f : 0.6f;
  TestMesh& m = s.addMesh();
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 center = random.vector(-3, 3);
    for (int k = 0; k < 3; ++k) {
      m.indices.push_back(uint32_t(m.positions.size()));
      m.positions.push_back(center + random.vector(-size, size));
      if (seed & 1) m.normals.push_back(random.vector(-1, 1));
      const float u = random.real(-2, 2), v = random.real(-2, 2);
      m.uvs.push_back({u, v});
      if (seed & 2) m.colors.push_back(glm::vec4(random.vector(0, 1), random.real(0.3f, 1)));
      if (seed % 5 == 2) m.tangents.push_back(glm::vec4(random.vector(-1, 1), random.integer(0, 1) ? 1 : -1));
    }
  }
  TextureView t;
  t.width = 13;
  t.height = 6;
  t.levels = 0;
  s.texels.emplace_back();
  for (int w = t.width, h = t.height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    for (int i = 0; i < w * h; ++i) s.texels[0].push_back(random.bits());
    ++t.levels;
    if (w == 1 && h == 1) break;
  }
  t.texels = s.texels[0];
  t.srgb = (seed & 8) != 0;
  t.wrapU = Wrap(seed % 3);
  t.wrapV = Wrap(seed / 3 % 3);
  t.magFilter = Filter(seed / 2 % 2);
  t.minFilter = Filter(seed / 5 % 2);
  t.mip = MipFilter(seed / 7 % 3);
  s.textures.push_back(t);

  s.materials.resize(2);
  s.materials[0].baseColor = {0.5f, 0.6f, 0.7f, 1};
  s.materials[0].metallic = 0.25f, s.materials[0].roughness = 0.6f;
  s.materials[0].doubleSided = seed % 5 == 0;
  Material& mapped = s.materials[1];
  mapped.baseColorMap.texture = mapped.normalMap.texture = mapped.emissiveMap.texture = 0;
  mapped.baseColorMap.uvFromUv = {0.8f, 0.1f, 0.2f, -0.1f, 1.2f, 0.4f};
  mapped.emissive = {1, 0.5f, 2};
  mapped.metallicRoughnessMap = {0, 0, {1.1f, 0, 0.3f, 0.2f, 0.9f, 0}};
  mapped.metallic = 0.9f, mapped.roughness = 0.7f;
  mapped.doubleSided = (seed & 16) != 0;
  mapped.alphaMode = seed & 4 ? AlphaMode::Mask : AlphaMode::Opaque;
  mapped.unlit = seed % 11 == 0;

  s.place(m, 0, glm::dmat4(1), seed % 2 == 0);
  glm::dmat4 mirrored(1), squashed(1);
  mirrored[0][0] = -1;
  mirrored[3] = {0.3, 0.1, -0.2, 1};
  squashed[1][1] = seed % 7 == 0 ? 0 : 0.7;  // flattened: no inverse
  s.place(m, 1, mirrored, seed % 2 == 0);
  s.place(m, 1, squashed, seed % 2 == 0);

  s.width = random.integer(1, 180);
  s.height = random.integer(1, 140);
  const double aspect = double(s.width) / s.height;
  s.camera = seed % 4 == 3 ? orthographic(2 * aspect, 2, seed % 8 == 7 ? 1 : 0.01, seed % 8 == 7 ? 5 : 100)
                           : perspective(0.9, aspect, seed % 5 == 0 ? 2.5 : 0.01, seed % 6 == 0 ? 6 : 0);
  s.camera.viewFromWorld = lookAt(random.vector(-5, 5), {0, 0, 0}, {0, 1, 0});
  return s;
}

namespace {

template <class T>
std::string difference(const char* name, const Plane<T>& a, const Plane<T>& b, const char* format) {
  if (a.width() != b.width() || a.height() != b.height()) return std::string(name) + ": sizes differ";
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      if (std::memcmp(&a.at(x, y), &b.at(x, y), sizeof(T)) == 0) continue;
      uint32_t bits[2];
      std::memcpy(&bits[0], &a.at(x, y), 4);
      std::memcpy(&bits[1], &b.at(x, y), 4);
      char text[200];
      std::snprintf(text, sizeof text, format, name, x, y, a.at(x, y), bits[0], b.at(x, y), bits[1]);
      return text;
    }
  return "";
}

}  // namespace

std::string firstDifference(const char* name, const Plane<float>& a, const Plane<float>& b) {
  return difference(name, a, b, "%s differs at (%d, %d): %.9g (%08x) and %.9g (%08x)");
}

std::string firstDifference(const char* name, const Plane<uint32_t>& a, const Plane<uint32_t>& b) {
  return difference(name, a, b, "%s differs at (%d, %d): %u (%08x) and %u (%08x)");
}

std::string firstDifference(const GBuffer& a, const GBuffer& b) {
  std::string d = firstDifference("triangle", a.triangle, b.triangle);
  if (d.empty()) d = firstDifference("depth", a.depth, b.depth);
  if (d.empty()) d = firstDifference("instance", a.instance, b.instance);
  if (d.empty()) d = firstDifference("material", a.material, b.material);
  for (int c = 0; c < 3 && d.empty(); ++c) {
    d = firstDifference("normal", a.normal[c], b.normal[c]);
    if (d.empty()) d = firstDifference("facet", a.facet[c], b.facet[c]);
    if (d.empty()) d = firstDifference("albedo", a.albedo[c], b.albedo[c]);
    if (d.empty()) d = firstDifference("emissive", a.emissive[c], b.emissive[c]);
    if (d.empty()) d = firstDifference("position", a.position[c], b.position[c]);
  }
  if (d.empty()) d = firstDifference("metallic", a.metallic, b.metallic);
  if (d.empty()) d = firstDifference("roughness", a.roughness, b.roughness);
  if (d.empty()) d = firstDifference("depth2", a.depth2, b.depth2);
  if (d.empty()) d = firstDifference("depthBack", a.depthBack, b.depthBack);
  return d;
}


}  // namespace obscura::tests
