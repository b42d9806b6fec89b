#include "obscura/engine/extended_ambient.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/engine/ambient_light.h"
#include "obscura/engine/outside_light.h"
#include "obscura/raster/srgb.h"

namespace obscura::engine {
namespace {

using glm::dvec3;

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

namespace {

// What a class sees besides what is its own.
struct View {
  dvec3 outside{0};   // what arrives of the light from outside
  double closed = 1;  // the part of its view that shows surfaces
  double others = 0;  // by how many classes that is shared, each alike
  double formFactor() const { return others > 0 ? closed / others : 0; }  // F_kj of each of them
};

// Without knowledge of what is open: all is closed, but for the part of classes without area.
std::vector<View> viewsOf(const std::vector<AmbientClass>& classes, const std::vector<dvec3>& outside) {
  std::vector<View> views;
  for (const dvec3& light : outside) views.push_back({light, 1, double(classes.size() - 1)});
  return views;
}

// B_k.
std::vector<dvec3> sentLight(const std::vector<AmbientClass>& classes, const std::vector<View>& views) {
  const size_t count = classes.size();
  std::vector<dvec3> sent(count);
  for (int c = 0; c < 3; ++c) {
    // (I - diag(rho) F) B = U / A + rho outside: rows of the matrix and the right side, by elimination. The diagonal is larger
    // than the rest of its row, as rho closed < 1, so that no row has to be exchanged.
    std::vector<std::vector<double>> rows(count, std::vector<double>(count + 1, 0.0));
    for (size_t k = 0; k < count; ++k) {
      const double area = classes[k].area, most = std::min(1.0, kMostReflectance / views[k].closed);
      const double rho = area > 0 ? std::min(classes[k].reflected[c] / area, most) : 0;
      for (size_t j = 0; j < count; ++j) rows[k][j] = j == k ? 1 : -rho * views[k].formFactor();
      rows[k][count] = (area > 0 ? classes[k].emitted[c] / area : 0) + rho * views[k].outside[c];
    }
    for (size_t k = 0; k < count; ++k)
      for (size_t i = k + 1; i < count; ++i) {
        const double by = rows[i][k] / rows[k][k];
        for (size_t j = k; j <= count; ++j) rows[i][j] -= by * rows[k][j];
      }
    for (size_t k = count; k-- > 0;) {
      double rest = rows[k][count];
      for (size_t j = k + 1; j < count; ++j) rest -= rows[k][j] * sent[j][c];
      sent[k][c] = rest / rows[k][k];
    }
  }
  return sent;
}

// `light` and what arrives of the other classes.
dvec3 withReceived(dvec3 light, size_t k, const std::vector<dvec3>& sent, const View& view) {
  for (size_t j = 0; j < sent.size(); ++j)
    if (j != k) light += sent[j] * view.formFactor();
  return light;
}

std::vector<glm::vec3> incomingLight(const std::vector<AmbientClass>& classes, const std::vector<dvec3>& outside) {
  const std::vector<View> views = viewsOf(classes, outside);
  const std::vector<dvec3> sent = sentLight(classes, views);
  std::vector<glm::vec3> incoming;
  for (size_t k = 0; k < classes.size(); ++k) incoming.push_back(glm::vec3(withReceived(outside[k], k, sent, views[k])));
  return incoming;
}

// D(n) of post::AmbientLight.
dvec3 factorAt(const std::vector<post::AmbientDirection>& factors, const dvec3& n) {
  dvec3 sum(0);
  double weights = 0;
  for (const post::AmbientDirection& f : factors) {
    const double weight = std::max(0.0, glm::dot(n, dvec3(f.direction)));
    sum += weight * dvec3(f.color), weights += weight;
  }
  return weights > 0 ? sum / weights : dvec3(1);
}

bool isLight(const glm::vec3& v) { return v.x >= 0 && v.y >= 0 && v.z >= 0 && std::max({v.x, v.y, v.z}) < 1e30f; }
const Error kTooBright{ErrorCode::BadInput, "the scene emits more light than floats hold", "", ""};

}  // namespace

std::vector<glm::vec3> incomingLight(const std::vector<AmbientClass>& classes, const dvec3& light) {
  return incomingLight(classes, std::vector<dvec3>(classes.size(), light));
}

Result<std::vector<post::AmbientDirection>> extendedAmbient(const Scene& scene, const std::optional<dvec3>& light, raster::Parallel& parallel,
                                                            const BouncedLight* direct, int count, const std::vector<post::AmbientDirection>& factors) {
  const std::vector<AmbientClass> classes = ambientClasses(scene, spreadDirections(count), parallel, direct);
  const bool dark = std::none_of(classes.begin(), classes.end(), [](const AmbientClass& k) { return k.emitted.x + k.emitted.y + k.emitted.z > 0; });
  std::vector<dvec3> outside;
  float asked = 0, mean = 0;  // of factors, and of light for them
  for (const AmbientClass& k : classes) {
    const dvec3 factor = factorAt(factors, k.direction);
    asked += float(factor.x + factor.y + factor.z);
    outside.push_back(factor * light.value_or(dvec3(dark ? 1 : 0)));
  }
  const std::vector<glm::vec3> in = incomingLight(classes, outside);
  for (const glm::vec3& k : in) mean += (k.x + k.y + k.z) / asked;
  const bool scaled = dark && !light && asked > 0;
  std::vector<post::AmbientDirection> out;
  for (size_t k = 0; k < classes.size(); ++k) {
    out.push_back({glm::vec3(classes[k].direction), scaled ? in[k] / mean : in[k]});
    if (!isLight(out.back().color)) return kTooBright;
  }
  return out;
}

Result<std::vector<post::AmbientDirection>> extendedEnvironment(const Scene& scene, const EnvironmentLight& light, const raster::Settings& settings,
                                                                const BouncedLight* direct, int count, const std::vector<post::AmbientDirection>& factors) {
  raster::Parallel parallel(settings.threads);
  const std::vector<dvec3> directions = spreadDirections(count);
  const std::vector<AmbientClass> classes = ambientClasses(scene, directions, parallel, direct);
  const glm::dmat3 worldFromMap = viewFromEnvironment({}, light.rotation), mapFromWorld = glm::transpose(worldFromMap);
  const std::vector<OutsidePart> parts = outsideParts(scene, directions, light.environment.harmonics, worldFromMap, settings);
  const double withArea = double(std::count_if(classes.begin(), classes.end(), [](const AmbientClass& k) { return k.area > 0; }));
  std::vector<post::AmbientDirection> out;
  std::vector<View> views;
  for (size_t k = 0; k < classes.size(); ++k) {
    const dvec3 factor = parts[k].passed * factorAt(factors, directions[k]);
    const dvec3 sent = glm::max(irradiance(light.environment.harmonics, mapFromWorld * directions[k]), 0.0) * (light.intensity / 3.141592653589793);
    views.push_back({factor * sent, 1 - parts[k].open, classes[k].area > 0 ? withArea - 1 : withArea});
    out.push_back({glm::vec3(directions[k]), glm::vec3(factor)});
  }
  const std::vector<dvec3> sent = sentLight(classes, views);
  for (size_t k = 0; k < classes.size(); ++k) {
    out[k].added = glm::vec3(withReceived(dvec3(0), k, sent, views[k]));
    if (!isLight(out[k].added)) return kTooBright;
  }
  return out;
}

}  // namespace obscura::engine
