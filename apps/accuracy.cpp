#include "obscura/apps/accuracy.h"

#include <algorithm>
#include <cmath>

#include "obscura/apps/demo_random.h"
#include "obscura/raster/clip.h"
#include "obscura/raster/rasterizer.h"
#include "obscura/raster/view.h"

namespace obscura::apps {
namespace {

using Real = long double;
constexpr int kRamp = 256;  // texels a side of the ramp

struct Point {
  Real x = 0, y = 0, z = 0;
};

Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator*(const Point& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
Point point(const glm::vec3& v) { return {v.x, v.y, v.z}; }
Real length(const Point& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

struct Workload {
  const char* name;
  int width, height;
  raster::Camera camera;
  glm::dmat4 worldFromObject{1};
  std::vector<glm::vec3> positions, normals;  // three each triangle, nothing shared
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec4> colors;
  std::vector<uint32_t> indices;
};

glm::vec3 vector(const glm::dvec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

// Normals about the plane's, within 30 degrees or so; uv away from the ramp's border; colours name the corner.
void addTriangle(Workload& w, Random& random, const glm::dvec3 (&corners)[3]) {
  const glm::dvec3 plane = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = std::sqrt(dot(plane, plane));
  for (int i = 0; i < 3; ++i) {
    w.indices.push_back(uint32_t(w.positions.size()));
    w.positions.push_back(vector(corners[i]));
    w.normals.push_back(vector((size > 0 ? plane / size : glm::dvec3(0, 0, 1)) + random.direction() * 0.5));
    const float u = float(random.in(0.02, 0.98));
    w.uvs.push_back({u, float(random.in(0.02, 0.98))});
    w.colors.push_back({i == 0, i == 1, i == 2, 1});
  }
}

// `count` triangles of about `size`, relative to the distance `near` ... `far` they lie at; as thin as `thickness`.
void addSoup(Workload& w, int count, double size, double near, double far, double thickness = 1) {
  Random random(uint64_t(count) * 977 + uint64_t(w.width));
  const double ratio = far / near * (far / near);
  for (int t = 0; t < count; ++t) {
    // More far than near, so that the near ones do not hide all others.
    const double d = near * std::sqrt(std::sqrt(1 + random.in(0, 1) * (ratio * ratio - 1)));
    const double x = random.in(-0.7, 0.7), y = random.in(-0.5, 0.5);
    const glm::dvec3 center = glm::dvec3(x, y, -1) * d;
    const glm::dvec3 a = random.direction(), b = random.direction();
    addTriangle(w, random,
                {center + a * (size * d), center - a * (size * d * 0.9), center + b * (size * d * thickness)});
  }
}

std::vector<Workload> makeWorkloads(int scale) {
  std::vector<Workload> all;
  const auto add = [&](const char* name, int width, int height, double near, double far) -> Workload& {
    Workload w;
    w.name = name;
    w.width = width, w.height = height;
    w.camera = raster::perspective(1.0, double(width) / height, near, far);
    return all.emplace_back(std::move(w));
  };
  addSoup(add("plain", 400, 300, 0.1, 0), 400 * scale, 0.15, 1, 10);
  addSoup(add("pixel-sized", 400, 300, 0.1, 0), 60000 * scale, 0.004, 1, 10);
  addSoup(add("sub-pixel", 400, 300, 0.1, 0), 60000 * scale, 0.0006, 1, 10);
  addSoup(add("slivers", 400, 300, 0.1, 0), 4000 * scale, 0.3, 1, 10, 0.01);
  addSoup(add("clipped", 400, 300, 0.5, 6), 300 * scale, 40, 1, 10);
  addSoup(add("far / near 10^7", 400, 300, 0.001, 10000), 2000 * scale, 0.1, 0.002, 9000);
  Workload& wide = add("16384 wide", 16384, 64, 0.1, 0);
  wide.camera = raster::perspective(0.0055, 256, 0.1);
  addSoup(wide, 6000 * scale, 0.02, 1, 10);
  Workload& away = add("10^6 away, mm", 400, 300, 0.001, 0);
  addSoup(away, 20000 * scale, 0.01, 0.1, 0.5);
  const glm::dvec3 offset(1e6 + 0.3, -1e6 + 0.7, 1e6);
  away.worldFromObject[3] = glm::dvec4(offset, 1);
  away.camera.viewFromWorld[3] = glm::dvec4(-offset, 1);
  Workload& turned = add("turned", 400, 300, 0.1, 0);
  addSoup(turned, 60000 * scale, 0.004, 1, 10);
  turned.camera.viewFromWorld = raster::lookAt({3, 4, 5}, {0.3, 0.2, -1}, {0.1, 1, 0.2});
  for (std::vector<glm::vec3>* vectors : {&turned.positions, &turned.normals})
    for (glm::vec3& v : *vectors) {
      const glm::dmat4& m = turned.camera.viewFromWorld;  // a rotation, whose inverse is its transpose, and a shift
      const glm::dvec3 from = glm::dvec3(v) - (vectors == &turned.positions ? glm::dvec3(m[3]) : glm::dvec3(0));
      for (int k = 0; k < 3; ++k) v[k] = float(dot(glm::dvec3(m[k]), from));
    }
  Workload& flat = add("orthographic", 400, 300, 0.1, 0);
  addSoup(flat, 400 * scale, 0.15, 1, 10);
  flat.camera = raster::orthographic(6, 4.5, 0.1, 20);
  return all;
}

// One triangle seen from one pixel, in long double.
struct Truth {
  Real weight[3];
  Point position[3];  // of the vertices, view space
  Real zView;
};

Truth see(const Workload& w, uint32_t triangle, int x, int y) {
  const raster::Camera& c = w.camera;
  const bool perspective = c.projection == raster::Projection::Perspective;
  Truth t;
  // The centre of the pixel in ndc, and where the vertices lie as seen from it.
  const Real cx = (2 * Real(x) + 1) / w.width - 1 - c.xShift, cy = 1 - (2 * Real(y) + 1) / w.height - c.yShift;
  Real hx[3], hy[3];
  for (int i = 0; i < 3; ++i) {
    const Point p = point(w.positions[w.indices[size_t(triangle) * 3 + size_t(i)]]);
    Real world[3], view[3];
    for (int r = 0; r < 3; ++r) {
      const glm::dmat4& m = w.worldFromObject;
      world[r] = m[0][r] * p.x + m[1][r] * p.y + m[2][r] * p.z + m[3][r];
    }
    for (int r = 0; r < 3; ++r) {
      const glm::dmat4& m = c.viewFromWorld;
      view[r] = m[0][r] * world[0] + m[1][r] * world[1] + m[2][r] * world[2] + m[3][r];
    }
    t.position[i] = {view[0], view[1], view[2]};
    const Real depth = perspective ? -view[2] : 1;
    hx[i] = view[0] * c.xScale - depth * cx;
    hy[i] = view[1] * c.yScale - depth * cy;
  }
  Real b[3], sum = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum += b[i] = hx[j] * hy[k] - hy[j] * hx[k];
  }
  // A centre that is covered only because vertices snap may lie outside by a hair: the nearest weights, as raster does.
  t.weight[1] = sum != 0 ? std::clamp<Real>(b[1] / sum, 0, 1) : 0;
  t.weight[2] = sum != 0 ? std::clamp<Real>(b[2] / sum, 0, 1 - t.weight[1]) : 0;
  t.weight[0] = 1 - t.weight[1] - t.weight[2];
  t.zView = 0;
  for (int i = 0; i < 3; ++i) t.zView -= t.weight[i] * t.position[i].z;
  return t;
}

// zView of the plane through the snapped vertices; negative where the triangle has to be cut.
Real snappedDepth(const raster::View& view, const raster::Draw& draw, uint32_t triangle, int x, int y) {
  Real px[3], py[3], key[3];
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 o = draw.mesh->positions[draw.mesh->indices[size_t(triangle) * 3 + size_t(i)]];
    glm::vec3 p;
    for (int r = 0; r < 3; ++r) {
      const float* m = draw.viewFromObject[r];
      p[r] = ((m[0] * o.x + m[1] * o.y) + m[2] * o.z) + m[3];
    }
    if (!(-p.z >= view.zNear) || -p.z > view.zFar) return -1;
    int32_t xSub, ySub;
    float k;
    raster::snapVertex(view, p, xSub, ySub, k);
    if (std::abs(xSub) > raster::kGuardSub - 128 || std::abs(ySub) > raster::kGuardSub - 128) return -1;
    px[i] = xSub, py[i] = ySub, key[i] = k;
  }
  const Real cx = view.xCenterSub(x) - px[0], cy = view.yCenterSub(y) - py[0];
  const Real x1 = px[1] - px[0], y1 = py[1] - py[0], x2 = px[2] - px[0], y2 = py[2] - py[0];
  const Real area = x1 * y2 - x2 * y1;
  const Real at = key[0] + ((cx * y2 - x2 * cy) * (key[1] - key[0]) + (x1 * cy - cx * y1) * (key[2] - key[0])) / area;
  return view.perspective ? 1 / at : -at;
}

Real ulp(Real value) { return std::ldexp(Real(1), std::ilogb(value) - 23); }

class Measure {
 public:
  void add(Real ulps, Real units) {
    ++pixels_;
    maxUlp_ = std::max(maxUlp_, ulps), sumUlp_ += ulps * ulps;
    max_ = std::max(max_, units), sum_ += units * units;
  }
  uint64_t pixels() const { return pixels_; }
  AccuracyRow row(const char* workload, const char* quantity, const char* unit) const {
    const Real n = Real(std::max<uint64_t>(1, pixels_));
    return {workload, quantity, unit, pixels_, double(maxUlp_), double(std::sqrt(sumUlp_ / n)), double(max_),
            double(std::sqrt(sum_ / n))};
  }

 private:
  uint64_t pixels_ = 0;
  Real maxUlp_ = 0, sumUlp_ = 0, max_ = 0, sum_ = 0;
};

// The instance's rotation is the identity in every workload, so normals only turn with the camera.
Point trueNormal(const Workload& w, uint32_t triangle, const Truth& t) {
  const glm::dmat4& m = w.camera.viewFromWorld;
  Point world, n;
  for (int i = 0; i < 3; ++i) world = world + point(w.normals[w.indices[size_t(triangle) * 3 + size_t(i)]]) * t.weight[i];
  n.x = m[0].x * world.x + m[1].x * world.y + m[2].x * world.z;
  n.y = m[0].y * world.x + m[1].y * world.y + m[2].y * world.z;
  n.z = m[0].z * world.x + m[1].z * world.y + m[2].z * world.z;
  return n * (1 / length(n));
}

void measure(Workload& w, const raster::TextureView& ramp, std::vector<AccuracyRow>& rows) {
  raster::Material materials[2];
  for (raster::Material& m : materials) m.doubleSided = true;
  materials[1].baseColorMap.texture = 0;
  raster::MeshView mesh;
  mesh.positions = w.positions;
  mesh.normals = w.normals;
  mesh.uvs[0] = w.uvs;
  mesh.indices = w.indices;
  raster::PlaneSet planes;
  planes.depth = planes.normal = planes.albedo = planes.triangle = true;
  raster::Rasterizer rasterizer;
  raster::GBuffer colored, textured;
  const auto render = [&](uint32_t material, raster::GBuffer& out) {
    mesh.colors = material == 0 ? raster::Span<const glm::vec4>(w.colors) : raster::Span<const glm::vec4>();
    const raster::Instance instance{&mesh, material, w.worldFromObject};
    const raster::Span<const raster::Instance> instances(&instance, 1);
    rasterizer.render({instances, materials, {&ramp, 1}}, w.camera, w.width, w.height, planes, out);
    return raster::makeDraws({instances, materials, {&ramp, 1}}, w.camera);
  };
  const raster::Draw draw = render(0, colored).at(0);
  render(1, textured);
  const raster::View view = raster::makeView(w.camera, w.width, w.height);

  Measure depth, surface, weights, texture, normal;
  constexpr Real kUlpOfOne = 1.0L / (1 << 23);
  for (int y = 0; y < w.height; ++y)
    for (int x = 0; x < w.width; ++x) {
      const uint32_t triangle = colored.triangle.at(x, y);
      if (triangle == raster::kNoTriangle) continue;
      const Truth t = see(w, triangle, x, y);
      const Real z = colored.depth.at(x, y), plane = snappedDepth(view, draw, triangle, x, y);
      if (plane > 0) depth.add(std::fabs(z - plane) / ulp(plane), std::fabs(z - plane));
      surface.add(std::fabs(z - t.zView) / ulp(t.zView), std::fabs(z - t.zView));

      Real worst = 0, u = 0, v = 0;
      Point shift;
      for (int i = 0; i < 3; ++i) {
        const Real error = Real(colored.albedo[i].at(x, y)) - t.weight[i];
        worst = std::max(worst, std::fabs(error));
        shift = shift + t.position[i] * error;
        const glm::vec2& uv = w.uvs[w.indices[size_t(triangle) * 3 + size_t(i)]];
        u += t.weight[i] * uv.x, v += t.weight[i] * uv.y;
      }
      weights.add(worst / kUlpOfOne, length(shift));

      // Texel k of the ramp holds k / 255 at u = (k + 1/2) / 256.
      const Real uError = std::fabs(Real(textured.albedo[0].at(x, y)) - (u * kRamp - 0.5L) / 255);
      const Real vError = std::fabs(Real(textured.albedo[1].at(x, y)) - (v * kRamp - 0.5L) / 255);
      texture.add(std::max(uError, vError) / kUlpOfOne, std::max(uError, vError));

      const Point n = trueNormal(w, triangle, t),
                  seen{colored.normal[0].at(x, y), colored.normal[1].at(x, y), colored.normal[2].at(x, y)};
      // Raster turns normals of what is seen from behind; which side is seen is not what is measured here.
      const Real sign = n.x * seen.x + n.y * seen.y + n.z * seen.z < 0 ? -1 : 1;
      const Point off = seen * sign + n * -1;
      normal.add(std::max({std::fabs(off.x), std::fabs(off.y), std::fabs(off.z)}) / kUlpOfOne, length(off));
    }
  if (depth.pixels() > 0) rows.push_back(depth.row(w.name, "depth", "scene units"));
  rows.push_back(surface.row(w.name, "surface", "scene units"));
  rows.push_back(weights.row(w.name, "weights", "scene units"));
  rows.push_back(texture.row(w.name, "texture", "albedo"));
  rows.push_back(normal.row(w.name, "normal", "radians"));
}

}  // namespace

std::vector<AccuracyRow> measureAccuracy(int scale) {
  std::vector<uint32_t> texels;
  for (uint32_t v = 0; v < kRamp; ++v)
    for (uint32_t u = 0; u < kRamp; ++u) texels.push_back(u | v << 8 | 0xFF000000u);
  raster::TextureView ramp;
  ramp.texels = texels;
  ramp.width = ramp.height = kRamp;
  ramp.mip = raster::MipFilter::None;
  std::vector<AccuracyRow> rows;
  for (Workload& w : makeWorkloads(std::max(1, scale))) measure(w, ramp, rows);
  return rows;
}

}  // namespace obscura::apps
