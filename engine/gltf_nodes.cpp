#include "obscura/engine/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "obscura/engine/gltf_accessor.h"
#include "obscura/engine/gltf_implicit.h"
#include "obscura/engine/gltf_lights.h"

namespace obscura::engine::gltf {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

// Quaternion (x, y, z, w) of any length but 0: dividing by its square makes it a rotation; 0 counts as none.
dmat4 transform(dvec3 t, dvec4 q, dvec3 scale) {
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const double s = square > 0 ? 2 / square : 0;
  const double xx = s * q.x * q.x, yy = s * q.y * q.y, zz = s * q.z * q.z, xy = s * q.x * q.y, xz = s * q.x * q.z,
               yz = s * q.y * q.z, wx = s * q.w * q.x, wy = s * q.w * q.y, wz = s * q.w * q.z;
  return dmat4(dvec4(1 - (yy + zz), xy + wz, xz - wy, 0) * scale.x, dvec4(xy - wz, 1 - (xx + zz), yz + wx, 0) * scale.y,
               dvec4(xz + wy, yz - wx, 1 - (xx + yy), 0) * scale.z, dvec4(t, 1));
}

dmat4 localTransform(const tinygltf::Node& n, const std::string& path) {
  if (!n.matrix.empty()) {
    const std::vector<double>& m = n.matrix;  // by columns, as GLM's
    constexpr double kRounding = 1e-6;
    dmat4 matrix(1.0);
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 3; ++r) matrix[c][r] = m[size_t(c * 4 + r)];
      if (std::abs(m[size_t(c * 4 + 3)] - matrix[c][3]) > kRounding)
        fail(path + "/matrix", "the last row is not 0 0 0 1");
    }
    return matrix;
  }
  dvec3 t(0), s(1);
  dvec4 q(0, 0, 0, 1);
  if (!n.translation.empty()) t = {n.translation[0], n.translation[1], n.translation[2]};
  if (!n.rotation.empty()) q = {n.rotation[0], n.rotation[1], n.rotation[2], n.rotation[3]};
  if (!n.scale.empty()) s = {n.scale[0], n.scale[1], n.scale[2]};
  return transform(t, q, s);
}

// Keeps the place, the direction of view and, as far as it can, what is up; scale, shear and mirroring go.
// False: there is no direction left.
bool makeRigid(dmat4& m) {
  const dvec3 backward(m[2]), up(m[1]), eye(m[3]);
  const double backwardLength = glm::length(backward);
  const dvec3 right = glm::cross(up, backward);
  const double rightLength = glm::length(right);
  if (!(backwardLength > 0 && rightLength > 0)) return false;
  for (const double v : {backwardLength, rightLength, eye.x, eye.y, eye.z})
    if (!std::isfinite(v)) return false;
  const dvec3 z = backward / backwardLength, x = right / rightLength;
  m = dmat4(dvec4(x, 0), dvec4(glm::cross(z, x), 0), dvec4(z, 0), dvec4(eye, 1));
  return true;
}

void check(bool holds, const std::string& path, const char* otherwise) {
  if (!holds) fail(path, otherwise);
}

void readLens(const tinygltf::Camera& in, const std::string& path, SceneCamera& out) {
  constexpr double kPi = 3.14159265358979323846;
  if (in.type == "perspective") {
    const tinygltf::PerspectiveCamera& p = in.perspective;
    check(p.yfov > 0 && p.yfov < kPi, path + "/perspective/yfov", "not between 0 and pi");
    check(p.znear > 0, path + "/perspective/znear", "not above 0");
    check(p.zfar == 0 || p.zfar > p.znear, path + "/perspective/zfar", "not above znear");
    check(p.aspectRatio >= 0, path + "/perspective/aspectRatio", "below 0");
    out.projection = raster::Projection::Perspective;
    out.yFov = p.yfov;
    out.aspect = p.aspectRatio;
    out.zNear = p.znear;
    out.zFar = p.zfar;
  } else {
    const tinygltf::OrthographicCamera& o = in.orthographic;
    check(o.xmag != 0, path + "/orthographic/xmag", "0");
    check(o.ymag != 0, path + "/orthographic/ymag", "0");
    check(o.znear >= 0, path + "/orthographic/znear", "below 0");
    check(o.zfar > o.znear, path + "/orthographic/zfar", "not above znear");
    out.projection = raster::Projection::Orthographic;
    out.xMag = std::abs(o.xmag);
    out.yMag = std::abs(o.ymag);
    out.zNear = o.znear;
    out.zFar = o.zfar;
  }
}

class Walk {
 public:
  explicit Walk(Document& document) : document_(document), nodes_(document.model.nodes), seen_(nodes_.size(), false) {}

  // A stack of our own: the depth of a hostile tree is not the depth of ours.
  NodeTree from(const std::vector<int>& roots, const std::string& path) {
    push(roots, path + "/nodes", dmat4(1.0), std::nullopt, 1);
    while (!stack_.empty()) {
      const Pending next = stack_.back();
      stack_.pop_back();
      visit(next);
    }
    for (const auto& [name, color] : document_.options.ambient)
      if (named_.count(name) == 0)
        throw Failure{{ErrorCode::Usage, "no node of the scene is named \"" + name + "\" to be given an ambient light", "", ""}};
    return std::move(tree_);
  }

 private:
  struct Pending {
    int node;
    uint32_t depth;
    dmat4 worldFromParent;
    std::optional<glm::vec3> ambient;  // of the parent
  };

  void push(const std::vector<int>& children, const std::string& path, const dmat4& worldFromParent,
            const std::optional<glm::vec3>& ambient, uint32_t depth) {
    for (size_t i = children.size(); i-- > 0;) {
      at(nodes_, children[i], "node", pointer(path, i));
      const std::string node = pointer("/nodes", uint64_t(children[i]));
      if (seen_[size_t(children[i])]) fail(node, "a node with two parents, or its own ancestor");
      seen_[size_t(children[i])] = true;
      if (depth > document_.options.limits.nodeDepth) {
        fail(node, "deeper than the limit of " + std::to_string(document_.options.limits.nodeDepth) + " levels");
      }
      stack_.push_back({children[i], depth, worldFromParent, ambient});
    }
  }

  void visit(const Pending& p) {
    const tinygltf::Node& node = nodes_[size_t(p.node)];
    const std::string path = pointer("/nodes", uint64_t(p.node));
    const dmat4 worldFromNode = p.worldFromParent * localTransform(node, path);
    std::optional<glm::vec3> ambient = ownAmbient(node, path);
    if (!ambient) ambient = p.ambient;
    if (node.mesh >= 0) placeMesh(node, uint32_t(p.node), path, worldFromNode, ambient);
    placeImplicit(node, path, worldFromNode);
    if (node.camera >= 0) placeCamera(node, path, worldFromNode);
    placeLight(node, path, worldFromNode);
    push(node.children, path + "/children", worldFromNode, ambient, p.depth + 1);
  }

  // The load options go before the file.
  std::optional<glm::vec3> ownAmbient(const tinygltf::Node& node, const std::string& path) {
    for (const auto& [name, color] : document_.options.ambient) {
      if (name != node.name) continue;
      named_.insert(name);
      return color;
    }
    if (!node.extras.Has("obscura_ambient")) return std::nullopt;
    const tinygltf::Value& numbers = node.extras.Get("obscura_ambient");
    glm::vec3 color;
    for (int c = 0; c < 3; ++c) {
      const double v = numbers.Get(c).GetNumberAsDouble();
      check(v >= 0 && v < 1e30, path + "/extras/obscura_ambient", "a colour that is below 0 or not finite");
      color[c] = float(v);
    }
    return color;
  }

  void placeMesh(const tinygltf::Node& node, uint32_t index, const std::string& path, const dmat4& worldFromNode,
                 const std::optional<glm::vec3>& ambient) {
    const tinygltf::Mesh& mesh = at(document_.model.meshes, node.mesh, "mesh", path + "/mesh");
    if (node.skin >= 0) document_.warnings.add("skins are ignored: meshes are drawn at rest, by their node");
    const auto instancing = node.extensions.find("EXT_mesh_gpu_instancing");
    if (instancing == node.extensions.end()) {
      reserve(1, mesh.primitives.size(), path);
      tree_.placements.push_back({index, uint32_t(node.mesh), worldFromNode, ambient});
      return;
    }
    placeInstances(instancing->second.Get("attributes"), index, mesh, path, worldFromNode, ambient);
  }

  void placeImplicit(const tinygltf::Node& node, const std::string& path, const dmat4& worldFromNode) {
    if (!node.extras.IsObject() || !node.extras.Has("obscura_implicit")) return;
    reserve(1, 1, path);
    tree_.implicits.push_back(readImplicit(document_, node.extras.Get("obscura_implicit"), path + "/extras/obscura_implicit"));
    tree_.implicits.back().worldFromObject = worldFromNode;
  }

  void placeInstances(const tinygltf::Value& attributes, uint32_t index, const tinygltf::Mesh& mesh,
                      const std::string& nodePath, const dmat4& worldFromNode, const std::optional<glm::vec3>& ambient) {
    const std::string path = nodePath + "/extensions/EXT_mesh_gpu_instancing/attributes";
    constexpr struct {
      const char* name;
      int components;
      float rest[4];
    } kParts[] = {
        {"TRANSLATION", 3, {0, 0, 0, 0}}, {"ROTATION", 4, {0, 0, 0, 1}}, {"SCALE", 3, {1, 1, 1, 0}}};
    std::optional<size_t> count;
    Accessor accessors[3];
    for (int k = 0; k < 3; ++k) {
      if (!attributes.IsObject() || !attributes.Has(kParts[k].name)) continue;
      const std::string user = pointer(path, kParts[k].name);
      accessors[k] = openAccessor(document_, attributes.Get(kParts[k].name).GetNumberAsInt(), user);
      if (accessors[k].components != kParts[k].components) fail(user, "an accessor of the wrong type");
      if (count && *count != accessors[k].count) fail(user, "not as many elements as its neighbours");
      count = accessors[k].count;
    }
    if (!count) fail(path, "neither TRANSLATION, ROTATION nor SCALE");
    reserve(*count, mesh.primitives.size(), nodePath);

    std::vector<float> parts[3];
    for (int k = 0; k < 3; ++k) {
      const size_t width = size_t(kParts[k].components);
      parts[k].resize(*count * width);
      if (!accessors[k].path.empty()) {
        readFloats(accessors[k], {0, *count, nullptr}, int(width), parts[k].data());
      } else {
        for (size_t i = 0; i < parts[k].size(); ++i) parts[k][i] = kParts[k].rest[i % width];
      }
    }
    for (size_t i = 0; i < *count; ++i) {
      const float *t = &parts[0][i * 3], *q = &parts[1][i * 4], *s = &parts[2][i * 3];
      const dmat4 nodeFromInstance = transform({t[0], t[1], t[2]}, {q[0], q[1], q[2], q[3]}, {s[0], s[1], s[2]});
      tree_.placements.push_back({index, uint32_t(nodes_[index].mesh), worldFromNode * nodeFromInstance, ambient});
    }
  }

  void reserve(uint64_t count, uint64_t primitives, const std::string& path) {
    const uint64_t limit = document_.options.limits.instances, each = std::max<uint64_t>(1, primitives);
    if (count > (limit - instances_) / each) fail(path, "more instances than the limit of " + std::to_string(limit));
    instances_ += count * each;
  }

  void placeCamera(const tinygltf::Node& node, const std::string& path, const dmat4& worldFromNode) {
    const tinygltf::Camera& in = at(document_.model.cameras, node.camera, "camera", path + "/camera");
    SceneCamera camera;
    camera.name = !node.name.empty() ? node.name : in.name;
    camera.worldFromView = worldFromNode;
    readLens(in, pointer("/cameras", uint64_t(node.camera)), camera);
    if (!makeRigid(camera.worldFromView)) {
      document_.warnings.add("cameras whose transform is singular or not finite are ignored");
      return;
    }
    tree_.cameras.push_back(std::move(camera));
  }

  void placeLight(const tinygltf::Node& node, const std::string& path, const dmat4& worldFromNode) {
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end()) return;
    SceneLight light = readLight(document_, extension->second.Get("light").GetNumberAsInt(), path + "/extensions/KHR_lights_punctual/light");
    if (tree_.lights.size() >= document_.options.limits.lights)
      fail(path, "more lights than the limit of " + std::to_string(document_.options.limits.lights));
    if (light.name.empty()) light.name = node.name;
    if (!placeAt(worldFromNode, light)) {
      document_.warnings.add("lights whose transform is singular or not finite are ignored");
      return;
    }
    tree_.lights.push_back(std::move(light));
  }

  Document& document_;
  const std::vector<tinygltf::Node>& nodes_;
  std::vector<bool> seen_;
  std::set<std::string> named_;  // of the load options' names, those that were found
  std::vector<Pending> stack_;
  NodeTree tree_;
  uint64_t instances_ = 0;
};

}  // namespace

NodeTree placeNodes(Document& document) {
  const tinygltf::Model& model = document.model;
  if (document.options.scene >= 0) {
    if (size_t(document.options.scene) >= model.scenes.size()) {
      throw Failure{{ErrorCode::Usage,
                     "there is no scene " + std::to_string(document.options.scene) + ", only " +
                         std::to_string(model.scenes.size()), "", "/scenes"}};
    }
    return Walk(document).from(model.scenes[size_t(document.options.scene)].nodes,
                               pointer("/scenes", uint64_t(document.options.scene)));
  }
  if (model.defaultScene >= 0) at(model.scenes, model.defaultScene, "scene", "/scene");
  if (!model.scenes.empty()) {
    const int scene = std::max(model.defaultScene, 0);
    return Walk(document).from(model.scenes[size_t(scene)].nodes, pointer("/scenes", uint64_t(scene)));
  }
  std::vector<bool> isChild(model.nodes.size(), false);  // without any scene, all that is there is shown
  for (const tinygltf::Node& node : model.nodes)
    for (int child : node.children)
      if (size_t(child) < isChild.size()) isChild[size_t(child)] = true;
  std::vector<int> roots;
  for (size_t i = 0; i < isChild.size(); ++i)
    if (!isChild[i]) roots.push_back(int(i));
  return Walk(document).from(roots, "");
}

}  // namespace obscura::engine::gltf
