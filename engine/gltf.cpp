#include "obscura/engine/gltf.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "obscura/engine/cluster_mesh.h"
#include "obscura/engine/gltf_geometry.h"
#include "obscura/engine/gltf_material.h"
#include "obscura/engine/gltf_nodes.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {
namespace gltf {
namespace {

constexpr uint32_t kNoMesh = 0xFFFFFFFF;

std::string primitivePath(size_t mesh, size_t primitive) {
  return pointer(pointer("/meshes", mesh) + "/primitives", primitive);
}

class Assembly {
 public:
  explicit Assembly(Document& document) : document_(document), model_(document.model) {}

  Scene assemble() {
    NodeTree tree = placeNodes(document_);
    findDrawn(tree.placements);
    readMeshes();
    placeMeshes(tree.placements);
    placeImplicits(std::move(tree.implicits));
    if (scene_.instances.empty() && scene_.implicits.empty()) fail("", "the scene has no triangles");
    raster::Parallel().forRanges(scene_.meshes.size(), 1, [this](size_t begin, size_t end, int) {
      for (size_t i = begin; i < end; ++i) clusterMesh(scene_.meshes[i]);
    });
    scene_.cameras = std::move(tree.cameras);
    scene_.lights = std::move(tree.lights);
    for (const tinygltf::Node& node : model_.nodes) scene_.nodeNames.push_back(node.name);
    scene_.warnings = std::move(document_.warnings.lines);
    return std::move(scene_);
  }

 private:
  void findDrawn(const std::vector<Placement>& placements) {
    meshOfPrimitive_.resize(model_.meshes.size());
    std::vector<bool> usedMaterials(model_.materials.size(), false);
    for (const Placement& p : placements) {
      const std::vector<tinygltf::Primitive>& primitives = model_.meshes[p.mesh].primitives;
      if (!meshOfPrimitive_[p.mesh].empty() || primitives.empty()) continue;
      meshOfPrimitive_[p.mesh].assign(primitives.size(), kNoMesh);
      for (size_t k = 0; k < primitives.size(); ++k) {
        const int material = primitives[k].material;
        if (material < 0) continue;
        at(model_.materials, material, "material", primitivePath(p.mesh, k) + "/material");
        usedMaterials[size_t(material)] = true;
      }
    }
    Materials materials = readMaterials(document_, usedMaterials);
    scene_.materials = std::move(materials.materials);
    scene_.materialNames = std::move(materials.names);
    scene_.textures = std::move(materials.textures);
    scene_.heightMaps = std::move(materials.heightMaps);
    needs_ = std::move(materials.needs);
  }

  void readMeshes() {
    uint64_t triangles = 0;
    for (size_t m = 0; m < model_.meshes.size(); ++m) {
      for (size_t k = 0; k < meshOfPrimitive_[m].size(); ++k) {
        const tinygltf::Primitive& primitive = model_.meshes[m].primitives[k];
        const size_t material = primitive.material >= 0 ? size_t(primitive.material) : model_.materials.size();
        const std::string path = primitivePath(m, k);
        std::optional<Geometry> geometry = readPrimitive(document_, primitive, path, needs_[material]);
        if (!geometry) continue;
        triangles += geometry->mesh.indices.size() / 3;
        const uint64_t limit = document_.options.limits.triangles;
        if (triangles > limit) fail(path, "more triangles than the limit of " + std::to_string(limit));
        meshOfPrimitive_[m][k] = uint32_t(scene_.meshes.size());
        geometry->mesh.material = uint32_t(material);
        geometry->mesh.name = model_.meshes[m].name + "/primitive " + std::to_string(k);
        scene_.meshes.push_back(std::move(geometry->mesh));
        boxes_.push_back({geometry->min, geometry->max, geometry->bounded});
      }
    }
  }

  void placeMeshes(const std::vector<Placement>& placements) {
    uint64_t instances = 0, triangles = 0;
    for (const Placement& p : placements) {
      for (uint32_t mesh : meshOfPrimitive_[p.mesh]) {
        if (mesh == kNoMesh) continue;
        ++instances;
        triangles += scene_.meshes[mesh].indices.size() / 3;
      }
    }
    const uint64_t limit = document_.options.limits.instancedTriangles;
    if (triangles > limit) {
      fail("", std::to_string(triangles) + " instanced triangles, more than the limit of " + std::to_string(limit));
    }
    scene_.instances.reserve(size_t(instances));
    for (const Placement& p : placements) {
      for (uint32_t mesh : meshOfPrimitive_[p.mesh]) {
        if (mesh == kNoMesh) continue;
        scene_.instances.push_back({mesh, p.node, p.worldFromObject, p.ambient});
        extendBounds(boxes_[mesh], p.worldFromObject);
      }
    }
  }

  void placeImplicits(std::vector<raster::ImplicitSurface> implicits) {
    scene_.implicits = std::move(implicits);
    for (const raster::ImplicitSurface& s : scene_.implicits) {
      const raster::ImplicitBound bound = raster::boundOf(s);
      extendBounds({glm::vec3(bound.center - bound.radius), glm::vec3(bound.center + bound.radius), true}, s.worldFromObject);
    }
  }

  struct Box {
    glm::vec3 min, max;
    bool bounded;
  };

  // By the corners of the mesh's box. What is not finite in the world is not drawn and does not count.
  void extendBounds(const Box& box, const glm::dmat4& worldFromObject) {
    if (!box.bounded) return;
    Bounds& bounds = scene_.bounds;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                         corner & 4 ? box.max.z : box.min.z, 1);
      const glm::dvec3 world(worldFromObject * p);
      if (!(std::isfinite(world.x) && std::isfinite(world.y) && std::isfinite(world.z))) continue;
      for (int c = 0; c < 3; ++c) {
        bounds.min[c] = bounds.empty ? world[c] : std::min(bounds.min[c], world[c]);
        bounds.max[c] = bounds.empty ? world[c] : std::max(bounds.max[c], world[c]);
      }
      bounds.empty = false;
    }
  }

  Document& document_;
  const tinygltf::Model& model_;
  Scene scene_;
  std::vector<std::vector<uint32_t>> meshOfPrimitive_;  // per mesh of the file; empty where no node shows it
  std::vector<VertexNeeds> needs_;                      // per material
  std::vector<Box> boxes_;                              // per mesh of the scene
};

}  // namespace
}  // namespace gltf

namespace {

// source: a path, or the bytes themselves; `name` is the file of the error messages.
template <class Source>
Result<Scene> sceneFrom(const Source& source, const std::string& name, const LoadOptions& options) {
  const raster::FloatEnvironment environment;
  Error error;
  try {
    gltf::Document document(source, options);
    return gltf::Assembly(document).assemble();
  } catch (gltf::Failure& failure) {
    error = std::move(failure.error);
  } catch (const std::bad_alloc&) {
    error.message = "not enough memory to load it";
  } catch (const std::exception& e) {
    error.message = std::string("cannot be loaded: ") + e.what();
  }
  if (error.file.empty()) error.file = name;
  return error;
}

}  // namespace

Result<Scene> sceneFromGltf(const std::string& path, const LoadOptions& options) { return sceneFrom(path, path, options); }

Result<Scene> sceneFromGltf(raster::Span<const uint8_t> file, const std::string& name, const LoadOptions& options) {
  return sceneFrom(file, name, options);
}

}  // namespace obscura::engine
