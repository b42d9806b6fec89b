// The scene: what a file becomes in memory, ready to be drawn from any camera. Everything is owned here.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "obscura/post/punctual_light.h"
#include "obscura/raster/camera.h"
#include "obscura/raster/clusters.h"
#include "obscura/raster/implicit_surface.h"
#include "obscura/raster/material.h"
#include "obscura/raster/mesh.h"

namespace obscura::engine {

// One glTF primitive, as an indexed triangle list (strips and fans are unrolled). Stored once, however many
// instances show it. All vectors but positions and indices may be empty; see raster::MeshView for the layout.
// From a file, texture coordinates and tangents are there only if the material samples a texture with them.
struct Mesh {
  std::string name;  // "MESH/primitive K"
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents, colors;
  std::vector<glm::vec2> uvs[2];
  std::vector<uint32_t> indices;
  uint32_t material = 0;      // index into Scene::materials
  raster::Clusters clusters;  // see engine/cluster_mesh.h
  raster::MeshView view() const;
};

struct Instance {
  uint32_t mesh = 0;
  uint32_t node = 0;  // index of the glTF node it comes from
  glm::dmat4 worldFromObject{1.0};
  std::optional<glm::vec3> ambient{};  // La of its node group, linear; else that of the frame
};

// A decoded image with the sampler it is used with; `view` points into `texels`, which textures of the same image
// share, so that a copied scene stays valid.
struct Texture {
  std::string name;
  std::shared_ptr<const std::vector<uint32_t>> texels;  // all levels, see raster::TextureView
  raster::TextureView view;
};

// A decoded height map; `view` points into `heights`, see Texture.
struct HeightMap {
  std::string name;
  std::shared_ptr<const std::vector<float>> heights;
  raster::HeightView view;
};

struct SceneCamera {
  std::string name;
  glm::dmat4 worldFromView{1.0};  // rigid: the node's scale is taken out
  raster::Projection projection = raster::Projection::Perspective;
  double yFov = 0.8, aspect = 0;  // perspective; radians; aspect 0: the image's
  double xMag = 1, yMag = 1;      // orthographic: half extents
  double zNear = 0.1, zFar = 0;   // zFar 0: none
};

// A light without extent, as in KHR_lights_punctual. World space; a node's scale is taken out.
struct SceneLight {
  std::string name;
  post::LightKind kind = post::LightKind::Directional;
  glm::dvec3 position{0};           // of point and spot
  glm::dvec3 direction{0, 0, -1};   // unit, where it shines to; of directional and spot
  glm::vec3 color{1};               // linear, times the intensity: lux (directional) or candela; 0 ... kMostLight
  double range = 0;                 // of point and spot: how far it reaches, world units; 0: without end
  double innerCone = 0, outerCone = 0.78539816339744828;  // of spot: radians from the direction, 0 <= inner <= outer <= pi / 2
  bool shadows = true;
};
constexpr float kMostLight = 1e15f;

struct Bounds {
  glm::dvec3 min{0}, max{0};
  bool empty = true;
};

struct Scene {
  std::vector<Mesh> meshes;
  std::vector<raster::Material> materials;  // at least one; from a file: as numbered there, then the default one
  std::vector<std::string> materialNames;
  std::vector<Texture> textures;
  std::vector<HeightMap> heightMaps;
  std::vector<Instance> instances;  // in the order of the node tree, depth first
  // From a file: what nodes have as extras, in the same order. A program may add its own, functions included.
  std::vector<raster::ImplicitSurface> implicits;
  std::vector<std::string> nodeNames;
  std::vector<SceneCamera> cameras;
  std::vector<SceneLight> lights;     // in the order of the node tree
  Bounds bounds;                      // of all instances and implicit surfaces, world space
  std::vector<std::string> warnings;  // one line each, every kind once
};

}  // namespace obscura::engine
