#include "obscura/engine/extended_ambient.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/raster/srgb.h"

namespace obscura::engine {
namespace {

constexpr double kMostReflectance = 0.99;
constexpr size_t kTrianglesPerTask = 4096;  // fixes the order of the sums

// Linear mean of a texture: of its first level that has few texels, as each level is made of means.
glm::dvec3 meanOf(const raster::TextureView& t, const raster::SrgbTable& table) {
  int width = t.width, height = t.height;
  size_t first = 0;
  for (int level = 1; level < t.levels && width * height > 4096; ++level) {
    first += size_t(width) * size_t(height);
    width = std::max(width / 2, 1), height = std::max(height / 2, 1);
  }
  glm::dvec3 sum(0);
  const size_t count = size_t(width) * size_t(height);
  for (size_t i = first; i < first + count; ++i)
    for (int c = 0; c < 3; ++c) {
      const uint32_t byte = t.texels[i] >> (8 * c) & 0xFF;
      sum[c] += t.srgb ? double(table.linear[byte]) : byte / 255.0;
    }
  return sum / double(count);
}

// The means of the textures that are asked for.
class TextureMeans {
 public:
  explicit TextureMeans(const Scene& scene) : scene_(scene), means_(scene.textures.size()) {}
  glm::dvec3 of(const raster::TextureSlot& slot) {
    if (slot.texture < 0) return glm::dvec3(1);
    std::optional<glm::dvec3>& mean = means_[size_t(slot.texture)];
    if (!mean) mean = meanOf(scene_.textures[size_t(slot.texture)].view, table_);
    return *mean;
  }

 private:
  const Scene& scene_;
  const raster::SrgbTable table_;
  std::vector<std::optional<glm::dvec3>> means_;
};

struct Surface {
  glm::dvec3 reflectance{0}, emission{0};
};

Surface surfaceOf(const raster::Material& m, TextureMeans& means) {
  const glm::dvec3 base = glm::dvec3(m.baseColor) * means.of(m.baseColorMap);
  if (m.unlit) return {glm::dvec3(0), base};
  return {base, glm::dvec3(m.emissive) * means.of(m.emissiveMap)};
}

// What a mesh's triangles of one instance add to the classes; the colours of materials are applied afterwards.
struct Sums {
  double area = 0;
  glm::dvec3 colored{0};  // times the vertex colour
  glm::dvec3 lit{0};      // that, times the irradiance over pi
};

class InstanceTriangles {
 public:
  InstanceTriangles(const Mesh& mesh, const glm::dmat4& worldFromObject, bool bothSides, const std::vector<glm::dvec3>& directions,
                    const BouncedLight* direct)
      : mesh_(mesh), worldFromObject_(worldFromObject), linear_(worldFromObject), flip_(glm::determinant(linear_) < 0 ? -0.5 : 0.5),
        bothSides_(bothSides), directions_(directions), direct_(direct), weights_(directions.size()) {}

  void add(size_t first, size_t end, Sums* sums) {
    for (size_t i = first; i < end; ++i) {
      const uint32_t* v = &mesh_.indices[3 * i];
      const glm::dvec3 a(mesh_.positions[v[0]]), b(mesh_.positions[v[1]]), c(mesh_.positions[v[2]]);
      const glm::dvec3 normal = glm::cross(linear_ * (b - a), linear_ * (c - a)) * flip_;
      glm::dvec3 color(1);
      if (!mesh_.colors.empty())
        color = (glm::dvec3(mesh_.colors[v[0]]) + glm::dvec3(mesh_.colors[v[1]]) + glm::dvec3(mesh_.colors[v[2]])) / 3.0;
      const glm::dvec3 center(worldFromObject_ * glm::dvec4((a + b + c) / 3.0, 1));
      addSide(center, normal, color, sums);
      if (bothSides_) addSide(center, -normal, color, sums);
    }
  }

 private:
  // normal: as long as the area.
  void addSide(const glm::dvec3& center, const glm::dvec3& normal, const glm::dvec3& color, Sums* sums) {
    double all = 0;
    for (size_t k = 0; k < directions_.size(); ++k) all += weights_[k] = std::max(0.0, glm::dot(normal, directions_[k]));
    const double area = std::sqrt(glm::dot(normal, normal));
    if (!(all > 0 && area < 1e200)) return;
    const double scale = area / all;
    const glm::dvec3 lit = direct_ ? color * direct_->at(center, normal / area) / 3.141592653589793 : glm::dvec3(0);
    for (size_t k = 0; k < directions_.size(); ++k) {
      sums[k].area += weights_[k] * scale;
      sums[k].colored += color * (weights_[k] * scale);
      sums[k].lit += lit * (weights_[k] * scale);
    }
  }

  const Mesh& mesh_;
  const glm::dmat4 worldFromObject_;
  const glm::dmat3 linear_;
  const double flip_;
  const bool bothSides_;
  const std::vector<glm::dvec3>& directions_;
  const BouncedLight* direct_;
  std::vector<double> weights_;
};

}  // namespace

std::vector<AmbientClass> ambientClasses(const Scene& scene, const std::vector<glm::dvec3>& directions, raster::Parallel& parallel,
                                         const BouncedLight* direct) {
  const size_t classes = directions.size();
  std::vector<AmbientClass> all(classes);
  for (size_t k = 0; k < classes; ++k) all[k].direction = directions[k];
  TextureMeans means(scene);
  std::vector<Sums> parts;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const raster::Material& material = scene.materials[mesh.material];
    const size_t triangles = mesh.indices.size() / 3, tasks = (triangles + kTrianglesPerTask - 1) / kTrianglesPerTask;
    parts.assign(tasks * classes, {});
    parallel.forRanges(tasks, 1, [&](size_t first, size_t end, int) {
      InstanceTriangles each(mesh, instance.worldFromObject, material.doubleSided, directions, direct);
      for (size_t t = first; t < end; ++t)
        each.add(t * kTrianglesPerTask, std::min((t + 1) * kTrianglesPerTask, triangles), &parts[t * classes]);
    });
    const Surface surface = surfaceOf(material, means);
    for (size_t i = 0; i < parts.size(); ++i) {
      AmbientClass& to = all[i % classes];
      to.area += parts[i].area;
      to.reflected += surface.reflectance * parts[i].colored;
      // Vertex colours are part of the base colour, which is what is emitted by unlit things only.
      to.emitted += surface.reflectance * parts[i].lit;
      to.emitted += material.unlit ? surface.emission * parts[i].colored : surface.emission * parts[i].area;
    }
  }
  return all;
}

std::vector<glm::vec3> incomingLight(const std::vector<AmbientClass>& classes, const glm::dvec3& light) {
  const size_t count = classes.size();
  const double formFactor = count > 1 ? 1.0 / double(count - 1) : 0;
  std::vector<glm::vec3> incoming(count);
  for (int c = 0; c < 3; ++c) {
    // (I - diag(rho) F) B = U / A + rho light: rows of the matrix and the right side, by elimination. The diagonal is larger
    // than the rest of its row, as rho < 1, so that no row has to be exchanged.
    std::vector<std::vector<double>> rows(count, std::vector<double>(count + 1, 0.0));
    for (size_t k = 0; k < count; ++k) {
      const double area = classes[k].area;
      const double rho = area > 0 ? std::min(classes[k].reflected[c] / area, kMostReflectance) : 0;
      for (size_t j = 0; j < count; ++j) rows[k][j] = j == k ? 1 : -rho * formFactor;
      rows[k][count] = (area > 0 ? classes[k].emitted[c] / area : 0) + rho * light[c];
    }
    for (size_t k = 0; k < count; ++k)
      for (size_t i = k + 1; i < count; ++i) {
        const double by = rows[i][k] / rows[k][k];
        for (size_t j = k; j <= count; ++j) rows[i][j] -= by * rows[k][j];
      }
    std::vector<double> sent(count);
    for (size_t k = count; k-- > 0;) {
      double rest = rows[k][count];
      for (size_t j = k + 1; j < count; ++j) rest -= rows[k][j] * sent[j];
      sent[k] = rest / rows[k][k];
    }
    for (size_t k = 0; k < count; ++k) {
      double sum = light[c];
      for (size_t j = 0; j < count; ++j)
        if (j != k) sum += sent[j] * formFactor;
      incoming[k][c] = float(sum);
    }
  }
  return incoming;
}

Result<std::vector<post::AmbientDirection>> extendedAmbient(const Scene& scene, const std::optional<glm::dvec3>& light, raster::Parallel& parallel,
                                                            const BouncedLight* direct, int count) {
  const std::vector<AmbientClass> classes = ambientClasses(scene, spreadDirections(count), parallel, direct);
  const bool dark = std::none_of(classes.begin(), classes.end(), [](const AmbientClass& k) { return k.emitted.x + k.emitted.y + k.emitted.z > 0; });
  const std::vector<glm::vec3> in = incomingLight(classes, light.value_or(glm::dvec3(dark ? 1 : 0)));
  float mean = 0;
  for (const glm::vec3& k : in) mean += (k.x + k.y + k.z) / float(3 * count);
  std::vector<post::AmbientDirection> out;
  for (size_t k = 0; k < classes.size(); ++k) {
    const glm::vec3 color = dark && !light ? in[k] / mean : in[k];
    for (int c = 0; c < 3; ++c)
      if (!(color[c] >= 0 && color[c] < 1e30f)) return Error{ErrorCode::BadInput, "the scene emits more light than floats hold", "", ""};
    out.push_back({glm::vec3(classes[k].direction), color});
  }
  return out;
}

}  // namespace obscura::engine
