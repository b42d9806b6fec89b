#include "obscura/engine/aov.h"

namespace obscura::engine {

const std::vector<AovInfo>& allAovs() {
  static const std::vector<AovInfo> all = {
      {Aov::Color, "color", {"R", "G", "B"}, "the picture: ambient reflectance x W x ambient light + emission, linear (sRGB in 8-bit files)"},
      {Aov::Depth, "depth", {"Z"}, "distance along the view axis, scene units; infinity where empty"},
      {Aov::Normal, "normal", {"X", "Y", "Z"}, "unit normal in camera space: x right, y up, z towards the eye"},
      {Aov::Albedo, "albedo", {"R", "G", "B"}, "linear reflectance, 0 to 1"},
      {Aov::Emissive, "emissive", {"R", "G", "B"}, "linear emission"},
      {Aov::Obscurance, "obscurance", {"Y"}, "O: how open the neighbourhood is, 0 to 1"},
      {Aov::Transfer, "transfer", {"R", "G", "B"}, "W: the ambient transfer function, 0 to 1"},
      {Aov::Position, "position", {"X", "Y", "Z"}, "point seen, in camera space, scene units"},
      {Aov::Triangle, "triangle", {"id"}, "number of the triangle, counted through the instances"},
      {Aov::Instance, "instance", {"id"}, "number of the instance, in the order of the node tree"},
      {Aov::Material, "material", {"id"}, "number of the material in the file"},
      {Aov::Depth2, "depth2", {"Z"}, "depth of what lies behind, at least the separation farther; infinity where nothing does"},
      {Aov::DepthBack, "depthback", {"Z"}, "depth of the nearest back face there, where what is seen ends"},
      {Aov::Metallic, "metallic", {"Y"}, "how metallic the surface is, 0 to 1"},
      {Aov::Roughness, "roughness", {"Y"}, "how rough it is, 0 to 1; 0 where empty"},
  };
  return all;
}

const AovInfo& infoOf(Aov aov) { return allAovs()[size_t(aov)]; }

std::optional<Aov> aovFromName(std::string_view name) {
  for (const AovInfo& info : allAovs())
    if (info.name == name) return info.aov;
  return std::nullopt;
}

}  // namespace obscura::engine
