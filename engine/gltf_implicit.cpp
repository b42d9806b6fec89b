#include "obscura/engine/gltf_implicit.h"

namespace obscura::engine::gltf {
namespace {

using raster::ImplicitShape;
using tinygltf::Value;

ImplicitShape shapeOf(const std::string& type, const std::string& path) {
  constexpr struct {
    const char* name;
    ImplicitShape shape;
  } kShapes[] = {{"sphere", ImplicitShape::Sphere},
                 {"box", ImplicitShape::Box},
                 {"torus", ImplicitShape::Torus},
                 {"metaballs", ImplicitShape::Metaballs},
                 {"gyroid", ImplicitShape::Gyroid}};
  for (const auto& s : kShapes)
    if (type == s.name) return s.shape;
  fail(path + "/type", "neither sphere, box, torus, metaballs nor gyroid");
}

double number(const Value& v, const char* name, const std::string& path) {
  if (!v.Has(name)) fail(path, std::string(name) + " is missing");
  return v.Get(name).GetNumberAsDouble();
}

glm::dvec3 vector(const Value& v) { return {v.Get(0).GetNumberAsDouble(), v.Get(1).GetNumberAsDouble(), v.Get(2).GetNumberAsDouble()}; }

glm::dvec3 halfSize(const Value& v, const std::string& path) {
  if (!v.Has("size")) fail(path, "size is missing");
  return vector(v.Get("size")) * 0.5;
}

}  // namespace

raster::ImplicitSurface readImplicit(const Document& document, const Value& extras, const std::string& path) {
  raster::ImplicitSurface s;
  s.shape = shapeOf(extras.Get("type").Get<std::string>(), path);
  switch (s.shape) {
    case ImplicitShape::Box: s.halfSize = halfSize(extras, path); break;
    case ImplicitShape::Metaballs:
      for (size_t i = 0; extras.Has("balls") && i < extras.Get("balls").ArrayLen(); ++i) {
        const Value& ball = extras.Get("balls").Get(int(i));
        s.balls.push_back({ball.Has("center") ? vector(ball.Get("center")) : glm::dvec3(0), ball.Get("radius").GetNumberAsDouble()});
      }
      break;
    case ImplicitShape::Gyroid:
      s.period = number(extras, "period", path);
      s.thickness = number(extras, "thickness", path);
      if (extras.Has("radius") == extras.Has("size")) fail(path, "not just one of radius and size");
      s.radius = 0;
      if (extras.Has("size")) s.halfSize = halfSize(extras, path);
      else if (s.radius = number(extras, "radius", path); s.radius == 0) fail(path + "/radius", "not above 0");
      break;
    case ImplicitShape::Torus: s.tube = number(extras, "tube", path); [[fallthrough]];
    default: s.radius = number(extras, "radius", path);
  }
  const char* wrong = raster::wrongImplicit(s);
  if (wrong) fail(path, wrong);
  const std::vector<tinygltf::Material>& materials = document.model.materials;
  s.material = uint32_t(materials.size());
  if (extras.Has("material")) {
    const int material = extras.Get("material").GetNumberAsInt();
    at(materials, material, "material", path + "/material");
    s.material = uint32_t(material);
  }
  return s;
}

}  // namespace obscura::engine::gltf
