#include "obscura/apps/demo_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "obscura/apps/demo_shapes.h"
#include "obscura/tests/fnv1a.h"

using namespace obscura::apps;
using nlohmann::json;

namespace {

const GlbScene& demo() {
  static const GlbScene scene = makeDemoScene();
  return scene;
}

const std::vector<uint8_t>& demoBytes() {
  static const std::vector<uint8_t> bytes = glbFromScene(demo());
  return bytes;
}

uint32_t little(const std::vector<uint8_t>& bytes, size_t at) {
  uint32_t v = 0;
  for (size_t i = 4; i-- > 0;) v = v << 8 | bytes[at + i];
  return v;
}

// The two chunks of a .glb, after checking its headers.
struct Glb {
  json text;
  std::vector<uint8_t> bin;

  explicit Glb(const std::vector<uint8_t>& file) {
    REQUIRE(std::memcmp(file.data(), "glTF", 4) == 0);
    REQUIRE(little(file, 4) == 2);
    REQUIRE(little(file, 8) == file.size());
    const size_t jsonSize = little(file, 12), binAt = 20 + jsonSize;
    REQUIRE(jsonSize % 4 == 0);
    REQUIRE(std::memcmp(&file[16], "JSON", 4) == 0);
    REQUIRE(little(file, binAt) == file.size() - binAt - 8);
    REQUIRE(std::memcmp(&file[binAt + 4], "BIN\0", 4) == 0);
    text = json::parse(file.begin() + 20, file.begin() + std::ptrdiff_t(binAt));
    bin.assign(file.begin() + std::ptrdiff_t(binAt) + 8, file.end());
  }

  const json& view(const json& accessor) const { return text["bufferViews"].at(accessor["bufferView"].get<size_t>()); }
  const uint8_t* data(const json& accessor) const { return bin.data() + view(accessor)["byteOffset"].get<size_t>(); }
};

}  // namespace

TEST_CASE("demo scene: its bytes are the same on every machine") {
  CHECK(obscura::tests::fnv1a(demoBytes().data(), demoBytes().size()) == 0x2c5d6cf10e1aff5full);
}

TEST_CASE("demo scene: about 120,000 triangles, nine materials, and most meshes shown by many nodes") {
  size_t drawn = 0, unique = 0, showing = 0;
  for (const GlbMesh& mesh : demo().meshes) unique += mesh.indices.size() / 3;
  for (const GlbNode& node : demo().nodes)
    if (node.mesh >= 0) {
      drawn += demo().meshes[size_t(node.mesh)].indices.size() / 3;
      ++showing;
    }
  CHECK(drawn > 100000);
  CHECK(drawn < 130000);
  CHECK(unique < drawn / 2);
  CHECK(showing > 20 * demo().meshes.size());
  CHECK(demo().materials.size() == 9);
}

TEST_CASE("demo scene: every node is in the tree once, and children follow their parents") {
  std::vector<int> seen(demo().nodes.size(), 0);
  for (int root : demo().roots) ++seen.at(size_t(root));
  for (size_t i = 0; i < demo().nodes.size(); ++i)
    for (int child : demo().nodes[i].children) {
      REQUIRE(child > int(i));
      ++seen.at(size_t(child));
    }
  CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

TEST_CASE("demo scene: rotations and normals are unit, scales are positive, no value is NaN") {
  for (const GlbNode& node : demo().nodes) {
    double length = 0;
    for (double q : node.rotation) length += q * q;
    REQUIRE(std::fabs(length - 1) < 1e-12);
    for (int k = 0; k < 3; ++k) REQUIRE(node.scale[k] > 0);
  }
  for (const GlbMesh& mesh : demo().meshes) {
    INFO(mesh.name);
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    double worst = 0;
    bool near = true;  // false for NaN
    for (const glm::vec3& n : mesh.normals)
      worst = std::max(worst, std::fabs(double(n.x * n.x + n.y * n.y + n.z * n.z) - 1));
    for (const glm::vec3& p : mesh.positions) near = near && p.x * p.x + p.y * p.y + p.z * p.z < 900;
    CHECK(worst < 1e-5);
    CHECK(near);
  }
}

TEST_CASE("demo scene: faces wind the way their normals point") {
  for (const GlbMesh& mesh : demo().meshes) {
    size_t against = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const uint32_t* v = &mesh.indices[i];
      const glm::vec3 p = mesh.positions[v[0]], a = mesh.positions[v[1]] - p, b = mesh.positions[v[2]] - p;
      const glm::vec3 n = mesh.normals[v[0]] + mesh.normals[v[1]] + mesh.normals[v[2]];
      against += (a.y * b.z - a.z * b.y) * n.x + (a.z * b.x - a.x * b.z) * n.y + (a.x * b.y - a.y * b.x) * n.z < 0;
    }
    INFO(mesh.name);
    if (!demo().materials[size_t(mesh.material)].doubleSided) CHECK(against <= mesh.indices.size() / 3 / 200);
  }
}

TEST_CASE("demo scene: stones and bark face outwards, the ground faces up") {
  for (const GlbMesh& mesh : demo().meshes) {
    double volume = 0;  // six times what the surface encloses, positive for counter-clockwise outsides
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]];
      const glm::vec3 c = mesh.positions[mesh.indices[i + 2]];
      volume += double(a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x));
    }
    INFO(mesh.name);
    if (mesh.name.rfind("stone", 0) == 0 || mesh.name.rfind("bark", 0) == 0) CHECK(volume > 1);
    if (mesh.name.rfind("ground", 0) == 0)
      CHECK(std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const glm::vec3& n) { return n.y > 0.3f; }));
  }
}

TEST_CASE("demo scene: the .glb's accessors lie inside its buffer, indices inside their mesh, bounds are exact") {
  const Glb glb(demoBytes());
  REQUIRE(glb.text["buffers"][0]["byteLength"] == glb.bin.size());
  size_t end = 0;
  for (const json& view : glb.text["bufferViews"]) {
    CHECK(view["byteOffset"].get<size_t>() % 4 == 0);
    CHECK(view["byteOffset"].get<size_t>() >= end);  // views do not overlap
    end = view["byteOffset"].get<size_t>() + view["byteLength"].get<size_t>();
    CHECK(end <= glb.bin.size());
  }
  for (const json& accessor : glb.text["accessors"]) {
    const std::string type = accessor["type"];
    const size_t bytes = accessor["componentType"] == 5123 ? 2 : 4;
    const size_t components = type == "SCALAR" ? 1 : size_t(type[3] - '0');
    CHECK(accessor["count"].get<size_t>() * components * bytes == glb.view(accessor)["byteLength"]);
  }
  REQUIRE(glb.text["meshes"].size() == demo().meshes.size());
  for (const json& mesh : glb.text["meshes"]) {
    const json& primitive = mesh["primitives"][0];
    const json& positions = glb.text["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
    for (const auto& [name, accessor] : primitive["attributes"].items())
      CHECK(glb.text["accessors"][accessor.get<size_t>()]["count"] == positions["count"]);
    const json& indices = glb.text["accessors"][primitive["indices"].get<size_t>()];
    REQUIRE(indices["count"].get<size_t>() % 3 == 0);
    const bool isShort = indices["componentType"] == 5123;
    bool inside = true;
    for (size_t i = 0; i < indices["count"]; ++i) {
      uint32_t index = 0;
      std::memcpy(&index, glb.data(indices) + i * (isShort ? 2 : 4), isShort ? 2 : 4);
      inside = inside && index < positions["count"].get<uint32_t>();
    }
    CHECK(inside);
    std::vector<float> values(positions["count"].get<size_t>() * 3);
    std::memcpy(values.data(), glb.data(positions), values.size() * 4);
    for (size_t k = 0; k < 3; ++k) {
      float lo = values[k], hi = values[k];
      for (size_t i = k; i < values.size(); i += 3) {
        lo = std::min(lo, values[i]);
        hi = std::max(hi, values[i]);
      }
      CHECK(positions["min"][k].get<double>() == double(lo));
      CHECK(positions["max"][k].get<double>() == double(hi));
    }
  }
}

TEST_CASE("demo scene: the camera stands above the ground and looks at the tree along -z") {
  const GlbCamera& camera = demo().camera;
  CHECK(camera.eye.y > groundHeight(camera.eye.x, camera.eye.z) + 1);
  const Glb glb(demoBytes());
  const json& node = glb.text["nodes"].back();
  REQUIRE(node["camera"] == 0);
  const std::vector<double> m = node["matrix"];
  const glm::dvec3 back(m[8], m[9], m[10]), eye(m[12], m[13], m[14]);
  CHECK(eye == camera.eye);
  const glm::dvec3 gap = eye - camera.target;
  const glm::dvec3 miss = gap - back * std::sqrt(gap.x * gap.x + gap.y * gap.y + gap.z * gap.z);
  CHECK(std::fabs(miss.x) + std::fabs(miss.y) + std::fabs(miss.z) < 1e-9);
  CHECK(m[15] == 1);
}

TEST_CASE("demo scene: a stone is closed, every edge has one triangle on either side") {
  const GlbMesh stone = makeStone(3, 1);
  CHECK(stone.indices.size() == 3 * 20 * 64);
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (size_t i = 0; i < stone.indices.size(); ++i)
    REQUIRE(edges.emplace(stone.indices[i], stone.indices[i % 3 == 2 ? i - 2 : i + 1]).second);
  CHECK(std::all_of(edges.begin(), edges.end(), [&](const auto& e) { return edges.count({e.second, e.first}) == 1; }));
}

TEST_CASE("demo scene: tiled textures meet at opposite edges, the leaf is cut out of its image") {
  for (const GlbTexture& texture : {makeBarkTexture(), makeSoilTexture()}) {
    const auto difference = [&](int x0, int y0, int x1, int y1) {
      const auto at = [&](int x, int y) { return int(texture.rgba[size_t(4 * (y * texture.width + x))]); };
      return std::abs(at(x0, y0) - at(x1, y1));
    };
    double inside = 0, across = 0;
    for (int i = 0; i < texture.width; ++i) {
      inside += difference(i, 31, i, 32) + difference(31, i, 32, i);
      across += difference(i, 63, i, 0) + difference(63, i, 0, i);
    }
    INFO(texture.name);
    CHECK(across < 2 * inside);
  }
  const GlbTexture leaf = makeLeafTexture();
  size_t covered = 0;
  for (size_t i = 3; i < leaf.rgba.size(); i += 4) covered += leaf.rgba[i] == 255;
  CHECK(covered > leaf.rgba.size() / 4 * 2 / 5);
  CHECK(covered < leaf.rgba.size() / 4 * 4 / 5);
}
