#include "obscura/engine/gltf_geometry.h"

#include <algorithm>
#include <numeric>

#include "obscura/engine/gltf_accessor.h"

namespace obscura::engine::gltf {
namespace {

uint64_t triangleCount(int mode, uint64_t indices) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return indices / 3;
  return indices < 3 ? 0 : indices - 2;
}

// glTF 2.0, section 3.7.2.1: which corners make triangle i.
std::vector<uint32_t> unrolled(int mode, const std::vector<uint32_t>& in) {
  const size_t n = size_t(triangleCount(mode, in.size()));
  std::vector<uint32_t> out(n * 3);
  for (size_t i = 0; i < n; ++i) {
    uint32_t* t = &out[i * 3];
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
      t[0] = in[i];
      t[1] = in[i + 1 + i % 2];
      t[2] = in[i + 2 - i % 2];
    } else {
      t[0] = in[i + 1];
      t[1] = in[i + 2];
      t[2] = in[0];
    }
  }
  return out;
}

// Which vertices of the accessors the triangles use; `indices` are renumbered to it. Many primitives may share one
// large vertex buffer, so copying all of it for each could fill any memory.
struct UsedVertices {
  Selection selection;
  std::vector<uint32_t> list;
};

UsedVertices selectVertices(std::vector<uint32_t>& indices, uint32_t lowest, uint32_t highest) {
  UsedVertices used;
  const size_t range = size_t(highest) - lowest + 1;
  used.selection = {lowest, range, nullptr};
  if (lowest > 0)
    for (uint32_t& i : indices) i -= lowest;
  if (indices.size() >= range) return used;

  constexpr size_t kSparse = 8;  // a table as long as the range costs more than sorting when it is so empty
  std::vector<uint32_t>& list = used.list;
  if (range / kSparse <= indices.size()) {
    std::vector<uint32_t> renumbered(range, 0);
    for (uint32_t i : indices) renumbered[i] = 1;
    for (size_t i = 0; i < range; ++i)
      if (renumbered[i]) {
        renumbered[i] = uint32_t(list.size());
        list.push_back(uint32_t(i));
      }
    for (uint32_t& i : indices) i = renumbered[i];
  } else {
    list = indices;
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (uint32_t& i : indices) i = uint32_t(std::lower_bound(list.begin(), list.end(), i) - list.begin());
  }
  for (uint32_t& i : list) i += lowest;
  used.selection = {0, list.size(), list.data()};
  return used;
}

class PrimitiveReader {
 public:
  PrimitiveReader(Document& document, const tinygltf::Primitive& primitive, const std::string& path)
      : document_(document), primitive_(primitive), path_(path) {}

  std::optional<Geometry> read(const VertexNeeds& needs) {
    if (!drawsTriangles()) return std::nullopt;
    const Accessor positions = openAttribute("POSITION", 3, 3);
    vertexCount_ = positions.count;
    if (!readTriangles()) return std::nullopt;

    Mesh& mesh = geometry_.mesh;
    used_ = selectVertices(mesh.indices, lowest_, highest_);
    fill(positions, mesh.positions);
    readOptional("NORMAL", 3, 3, mesh.normals);
    readOptional("COLOR_0", 3, 4, mesh.colors);
    if (needs.tangents) readOptional("TANGENT", 4, 4, mesh.tangents);
    for (int k = 0; k < 2; ++k)
      if (needs.uvSource[k] >= 0) readOptional("TEXCOORD_" + std::to_string(needs.uvSource[k]), 2, 2, mesh.uvs[k]);
    bound();
    return std::move(geometry_);
  }

 private:
  bool drawsTriangles() {
    if (primitive_.mode > TINYGLTF_MODE_TRIANGLE_FAN) fail(path_ + "/mode", "there is no such mode");
    if (primitive_.mode < TINYGLTF_MODE_TRIANGLES) {
      document_.warnings.add("points and lines are not drawn");
      return false;
    }
    if (primitive_.attributes.count("POSITION") == 0) {
      document_.warnings.add("primitives without POSITION are not drawn");
      return false;
    }
    if (!primitive_.targets.empty()) document_.warnings.add("morph targets are ignored: meshes are drawn without them");
    return true;
  }

  Accessor openAttribute(const std::string& name, int leastComponents, int mostComponents) {
    const std::string user = path_ + "/attributes/" + name;
    Accessor a = openAccessor(document_, primitive_.attributes.at(name), user);
    const int type = document_.model.accessors[size_t(primitive_.attributes.at(name))].type;
    if (type < TINYGLTF_TYPE_VEC2 || type > TINYGLTF_TYPE_VEC4 || a.components < leastComponents ||
        a.components > mostComponents) {
      fail(user, "accessor " + std::to_string(primitive_.attributes.at(name)) + " has the wrong type, not VEC" +
                     std::to_string(leastComponents));
    }
    return a;
  }

  // False: there is no triangle.
  bool readTriangles() {
    std::vector<uint32_t>& indices = geometry_.mesh.indices;
    const bool isIndexed = primitive_.indices >= 0;
    Accessor a;
    if (isIndexed) {
      a = openAccessor(document_, primitive_.indices, path_ + "/indices");
      const bool isScalar = document_.model.accessors[size_t(primitive_.indices)].type == TINYGLTF_TYPE_SCALAR;
      if (!isScalar || !isIndexType(a.componentType)) fail(path_ + "/indices", "not scalars of an unsigned type");
    }
    const uint64_t count = isIndexed ? a.count : vertexCount_, triangles = triangleCount(primitive_.mode, count);
    if (triangles == 0) return false;
    if (triangles > UINT32_MAX || vertexCount_ > UINT32_MAX) fail(path_, "more than 2^32 vertices or triangles");
    document_.reserveGeometry((count + triangles * 3) * sizeof(uint32_t), path_);

    indices.resize(size_t(count));
    if (isIndexed) {
      readIndices(a, indices.data());
    } else {
      std::iota(indices.begin(), indices.end(), 0u);
    }
    lowest_ = UINT32_MAX;
    for (uint32_t i : indices) {
      lowest_ = std::min(lowest_, i);
      highest_ = std::max(highest_, i);
    }
    if (highest_ >= vertexCount_) reportIndex();
    if (primitive_.mode != TINYGLTF_MODE_TRIANGLES) {
      indices = unrolled(primitive_.mode, indices);
    } else if (count % 3 != 0) {
      document_.warnings.add("triangles that are not complete are not drawn");
      indices.resize(size_t(triangles) * 3);
    }
    return true;
  }

  [[noreturn]] void reportIndex() {
    const std::vector<uint32_t>& indices = geometry_.mesh.indices;
    const auto bad = std::find_if(indices.begin(), indices.end(), [&](uint32_t i) { return i >= vertexCount_; });
    fail(path_ + "/indices", "index " + std::to_string(bad - indices.begin()) + " is " + std::to_string(*bad) +
                                 ", there are " + std::to_string(vertexCount_) + " vertices");
  }

  template <class Vector>
  void fill(const Accessor& a, std::vector<Vector>& out) {
    static_assert(sizeof(Vector) == size_t(Vector::length()) * sizeof(float), "vectors are read as plain floats");
    document_.reserveGeometry(uint64_t(used_.selection.count) * sizeof(Vector), path_);
    out.resize(used_.selection.count);
    readFloats(a, used_.selection, Vector::length(), &out[0].x);
  }

  template <class Vector>
  void readOptional(const std::string& name, int leastComponents, int mostComponents, std::vector<Vector>& out) {
    if (primitive_.attributes.count(name) == 0) return;
    Accessor a = openAttribute(name, leastComponents, mostComponents);
    if (a.count != vertexCount_) {
      fail(path_ + "/attributes/" + name, std::to_string(a.count) + " elements for " + std::to_string(vertexCount_) +
                                              " positions");
    }
    if (name == "COLOR_0") a.normalized = true;  // integer colours are nothing else; some exporters forget to say so
    fill(a, out);
  }

  // By the indices: a vertex that no triangle uses does not count. NaN and infinity fail every comparison.
  void bound() {
    constexpr float kLargest = std::numeric_limits<float>::max();
    glm::vec3 low(kLargest), high(-kLargest);
    for (uint32_t i : geometry_.mesh.indices) {
      const glm::vec3& p = geometry_.mesh.positions[i];
      if (!(std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(p.z) <= kLargest)) continue;
      for (int c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
      geometry_.bounded = true;
    }
    geometry_.min = low;
    geometry_.max = high;
  }

  Document& document_;
  const tinygltf::Primitive& primitive_;
  const std::string& path_;
  Geometry geometry_;
  size_t vertexCount_ = 0;
  uint32_t lowest_ = 0, highest_ = 0;
  UsedVertices used_;
};

}  // namespace

std::optional<Geometry> readPrimitive(Document& document, const tinygltf::Primitive& primitive, const std::string& path,
                                      const VertexNeeds& needs) {
  return PrimitiveReader(document, primitive, path).read(needs);
}

}  // namespace obscura::engine::gltf
