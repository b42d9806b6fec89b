// In: a .gltf or .glb file.  Out: a Scene.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/engine/result.h"
#include "obscura/engine/scene.h"

namespace obscura::engine {

// Every input is hostile: sizes are checked against these before anything is allocated.
struct LoadLimits {
  uint64_t fileBytes = 4ull << 30;          // each file read
  uint64_t triangles = 1ull << 28;          // unique, over all meshes
  uint64_t instancedTriangles = 0xFFFFFFFEull;  // ids are 32 bits, one value means "none"
  uint64_t instances = 1ull << 24;
  uint64_t geometryBytes = 8ull << 30;      // vertices and indices of all meshes in memory, without clusters
  uint64_t zeroElements = 1ull << 20;       // of accessors without a bufferView, summed over their uses
  uint32_t lights = 1024;                   // placed by nodes
  uint32_t nodeDepth = 1024;
  uint32_t textureSize = 16384;             // texels a side
  uint64_t textureBytes = 4ull << 30;       // all decoded levels together
};

struct LoadOptions {
  int scene = -1;               // -1: the file's default scene, else its first
  bool textures = true;         // false: only those that decide what is seen (of masks), else factors only
  // Ambient light of the nodes of this name and of all below them, linear, >= 0 and finite, instead of what the file says;
  // the first of equal names counts.
  std::vector<std::pair<std::string, glm::vec3>> ambient;
  LoadLimits limits;
};

// Reads what the chosen scene draws and nothing else: meshes, materials and images that no node of it shows are not
// decoded. A node's extras {"obscura_ambient": [r, g, b]} are the ambient light of what it and all below it show, the
// nearest counts. Errors: Usage (options.scene or a node of options.ambient does not exist), else BadInput with the file and the JSON pointer concerned;
// no exception escapes. What is left out (Scene::warnings says so, once a kind):
//   - an extension that is not supported and not required; required ones are errors;
//   - points and lines; primitives without POSITION; triangles that a strip or list does not complete;
//   - skins: the vertices are shown as stored, with the transform of their node (which glTF ignores for a skinned
//     mesh, expecting the joints to bring it: in the bind pose of common exporters both are the same);
//   - morph targets: the mesh without them;
//   - alphaMode BLEND: drawn as MASK with the cutoff 0.5;
//   - occlusion textures and animations, without a word: obscurance is computed, and a frame shows the rest pose.
// External files must lie in the folder of the .gltf or below it.
Result<Scene> sceneFromGltf(const std::string& path, const LoadOptions& options = {});

// The same from a file in memory, which may name no other files; `name` is that of the error messages.
Result<Scene> sceneFromGltf(raster::Span<const uint8_t> file, const std::string& name, const LoadOptions& options = {});

}  // namespace obscura::engine
