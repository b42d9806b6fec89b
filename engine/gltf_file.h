// In: paths and URIs.  Out: bytes, every size checked first.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "obscura/engine/result.h"
#include "obscura/raster/span.h"

namespace obscura::engine::gltf {

using Bytes = raster::Span<const uint8_t>;

// How the parts of the loader give up. sceneFromGltf catches it: nothing else ever sees it.
struct Failure {
  Error error;
};
// BadInput; `gltfPath` is a JSON pointer or empty, an empty `file` is the .gltf itself. Control characters, which a
// hostile file may put into names, are replaced.
[[noreturn]] void fail(const std::string& gltfPath, const std::string& message, const std::string& file = {});

// Bytes that are owned, and not zeroed before they are written.
struct Blob {
  std::unique_ptr<uint8_t[]> data;
  size_t size = 0;
  Blob() = default;
  explicit Blob(size_t n) : data(new uint8_t[n]), size(n) {}
  Bytes view() const { return {data.get(), size}; }
};

// Only regular files: a pipe or device could block or never end. `gltfPath`: who refers to the file.
Blob readFile(const std::string& path, uint64_t limit, const std::string& gltfPath);

// The two parts of a file: a .glb's chunks (recognised by its magic), or all of it as JSON.
struct Parts {
  Bytes json, binary;
  bool hasBinary = false;
};
Parts splitContainer(Bytes file);

// What a URI holds or names: "data:...;base64,..." or a relative path, percent-encoded, that stays in `folder`.
bool isDataUri(const std::string& uri);
Blob decodeDataUri(const std::string& uri, const std::string& gltfPath);
std::string pathOfUri(const std::string& folder, const std::string& uri, const std::string& gltfPath);

}  // namespace obscura::engine::gltf
