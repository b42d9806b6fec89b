// In: the bytes of a .gltf or .glb.  Out: its JSON as structures, every type and size in it checked.
// Private to engine/gltf*.cpp, as tinygltf's structures are named here.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "obscura/engine/gltf.h"
#include "obscura/engine/gltf_file.h"

namespace obscura::engine::gltf {

// "/accessors" and 3 give "/accessors/3".
std::string pointer(const std::string& parent, uint64_t index);
std::string pointer(const std::string& parent, const std::string& key);

class Warnings {
 public:
  void add(const std::string& line) {
    if (seen_.insert(line).second) lines.push_back(line);
  }
  std::vector<std::string> lines;  // each once, in the order of their first occurrence

 private:
  std::set<std::string> seen_;
};

// Where a buffer or an image keeps its bytes. The strings are taken out of the JSON before tinygltf sees it.
struct Source {
  std::string uri;
  bool hasUri = false;
  int bufferView = -1;
  uint64_t byteLength = 0;  // of a buffer
  std::string name;
};

class Document {
 public:
  Document(const std::string& path, const LoadOptions& loadOptions);
  Document(Bytes file, const LoadOptions& loadOptions);  // which must stay; without a folder, it names no other files

  LoadOptions options;
  tinygltf::Model model;  // without buffers and images
  std::vector<Source> images;
  Warnings warnings;

  // The bytes of a bufferView, of a buffer, of an image still encoded. Files and data URIs are read at the first use.
  Bytes bufferViewBytes(int index, const std::string& user);
  Bytes bufferBytes(int index, const std::string& user);
  Bytes imageBytes(int index, const std::string& user);

  // Counts what a mesh is going to allocate, before it does.
  void reserveGeometry(uint64_t bytes, const std::string& user);
  void reserveZeroElements(uint64_t count, const std::string& user);

 private:
  void parse(Bytes json);
  Bytes externalBytes(const Source& source, const std::string& user);

  std::string folder_;
  Blob file_;
  Parts parts_;
  std::vector<Source> buffers_;
  std::map<std::string, Blob> externals_;  // by URI: buffers that name the same file share its bytes
  uint64_t geometryBytes_ = 0, zeroElements_ = 0;
};

// Checks that `index` is one of `items` and gives that item; `user` is the JSON pointer of who says so.
template <class T>
const T& at(const std::vector<T>& items, int index, const char* kind, const std::string& user) {
  if (index < 0 || size_t(index) >= items.size()) {
    fail(user, "there is no " + std::string(kind) + " " + std::to_string(index) + ", only " +
                   std::to_string(items.size()));
  }
  return items[size_t(index)];
}

}  // namespace obscura::engine::gltf
