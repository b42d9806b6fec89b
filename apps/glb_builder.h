// Puts scenes of the project's own together.
#pragma once

#include <string>
#include <utility>

#include "obscura/apps/demo_random.h"
#include "obscura/apps/glb_writer.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {

class GlbBuilder {
 public:
  GlbScene scene;

  int addMaterial(const char* name, glm::dvec3 color, int texture = -1) {
    GlbMaterial material;
    material.name = name;
    material.baseColor = color;
    material.texture = texture;
    scene.materials.push_back(material);
    return int(scene.materials.size()) - 1;
  }
  GlbMaterial& material(int index) { return scene.materials[size_t(index)]; }

  int addTexture(GlbTexture texture) {
    scene.textures.push_back(std::move(texture));
    return int(scene.textures.size()) - 1;
  }

  int addMesh(GlbMesh mesh, int material) {
    mesh.material = material;
    mesh.name += " " + std::to_string(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    return int(scene.meshes.size()) - 1;
  }

  int addNode(GlbNode node, int parent = -1) {
    scene.nodes.push_back(std::move(node));
    const int index = int(scene.nodes.size()) - 1;
    (parent < 0 ? scene.roots : scene.nodes[size_t(parent)].children).push_back(index);
    return index;
  }

  int addGroup(const char* name, int mesh = -1) {
    GlbNode node;
    node.name = name;
    node.mesh = mesh;
    return addNode(node);
  }

  // A mesh at a place, turned by `yaw` radians about the vertical.
  int place(int mesh, glm::dvec3 at, double yaw = 0, glm::dvec3 scale = glm::dvec3(1)) {
    GlbNode node;
    node.name = scene.meshes[size_t(mesh)].name;
    node.mesh = mesh;
    node.translation = at;
    node.scale = scale;
    if (yaw != 0) node.rotation = {0, raster::exactSin(yaw / 2), 0, raster::exactCos(yaw / 2)};
    return addNode(std::move(node));
  }

  void lookAt(glm::dvec3 eye, glm::dvec3 target, double yFov) {
    scene.camera.name = "view";
    scene.camera.eye = eye;
    scene.camera.target = target;
    scene.camera.yFov = yFov;
  }
};

}  // namespace obscura::apps
