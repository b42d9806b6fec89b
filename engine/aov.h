// AOVs: the pictures and buffers that a frame can give, and what each one needs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::engine {

enum class Aov : uint8_t { Color, Depth, Normal, Albedo, Emissive, Obscurance, Transfer, Position, Triangle, Instance, Material,
                           Depth2, DepthBack, Metallic, Roughness };

struct AovInfo {
  Aov aov;
  const char* name;                   // as on the command line
  std::vector<std::string> channels;  // as in EXR files
  const char* what;                   // one line for --help
};

const std::vector<AovInfo>& allAovs();
const AovInfo& infoOf(Aov aov);
std::optional<Aov> aovFromName(std::string_view name);

}  // namespace obscura::engine
