// In: the JSON of a glTF file as text.  Out: the part of it that the loader uses, with every type checked.
// Private to engine/gltf*.cpp.
#pragma once

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "obscura/engine/gltf_file.h"

namespace obscura::engine::gltf {

struct CheckedJson {
  nlohmann::json root;
  std::set<std::string> ignoredExtensions;  // that the file declares or uses
};

// After it:
//   - every member is one the loader knows; animations, skins, extras and extensions that are not ours or supported are
//     gone, and morph targets are only an array of as many empty objects;
//   - every member has the type glTF gives it, required ones exist, number arrays have their length;
//   - indices and enumerations are in 0 ... 2^31 - 1, sizes in 0 ... 2^53.
// Whether an index names something is for whoever follows it.
CheckedJson checkedJson(Bytes text);

}  // namespace obscura::engine::gltf
