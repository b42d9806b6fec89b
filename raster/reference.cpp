// The scalar twins of setup and tiles, and the reference frame made of all twins.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "obscura/raster/clip.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/rasterizer.h"
#include "obscura/raster/reference.h"
#include "obscura/raster/srgb.h"
#include "obscura/raster/view.h"

namespace obscura::raster {
namespace ref {
namespace {

using Point = glm::tvec2<int64_t>;

// Positive where c is to the right of p -> q on the screen (y points down).
int64_t side(Point p, Point q, Point c) { return (q.x - p.x) * (c.y - p.y) - (q.y - p.y) * (c.x - p.x); }

// The interior lies below a top edge and to the right of a left one.
bool ownsItsEdge(Point p, Point q) { return q.y < p.y || (q.y == p.y && q.x > p.x); }

bool covers(const Point v[3], Point c) {
  for (int i = 0; i < 3; ++i) {
    const int64_t s = side(v[i], v[(i + 1) % 3], c);
    if (s < 0 || (s == 0 && !ownsItsEdge(v[i], v[(i + 1) % 3]))) return false;
  }
  return true;
}

struct Vertex {
  Point at;
  float key;
};

// What becomes of the pixels that triangles cover: alpha is asked where they are wanted.
struct Fragments {
  std::function<bool(int x, int y, float key, uint32_t id)> wants;
  std::function<void(int x, int y, float key, uint32_t id)> take;
  bool back = false;  // only of single-sided triangles that face away
};

void drawSnapped(const SurfaceContext& context, const Draw& draw, uint32_t triangle, const Vertex vertex[3], const Fragments& out) {
  const View& view = *context.view;
  Point v[3] = {vertex[0].at, vertex[1].at, vertex[2].at};
  const Point e1 = v[1] - v[0], e2 = v[2] - v[0];
  const int64_t area = e1.x * e2.y - e1.y * e2.x;
  const bool front = draw.mirrored ? area > 0 : area < 0;
  if (area == 0 || (!draw.material->doubleSided && front == out.back)) return;

  const double d1 = double(vertex[1].key) - vertex[0].key, d2 = double(vertex[2].key) - vertex[0].key, perArea = 1.0 / double(area);
  const float gx = float((d1 * double(e2.y) - d2 * double(e1.y)) * perArea), gy = float((d2 * double(e1.x) - d1 * double(e2.x)) * perArea);
  const float nearest = std::max({vertex[0].key, vertex[1].key, vertex[2].key});
  const float farthest = std::min({vertex[0].key, vertex[1].key, vertex[2].key});
  if (area < 0) std::swap(v[1], v[2]);

  const auto columns = std::minmax({v[0].x, v[1].x, v[2].x}), rows = std::minmax({v[0].y, v[1].y, v[2].y});
  auto pixel = [](int64_t sub, int firstSub, int size) { return int(std::clamp<int64_t>((sub - firstSub) / kSub, 0, size - 1)); };
  const uint32_t id = draw.firstTriangle + triangle;
  for (int y = pixel(rows.first, view.yFirstSub, view.height); y <= pixel(rows.second, view.yFirstSub, view.height); ++y)
    for (int x = pixel(columns.first, view.xFirstSub, view.width); x <= pixel(columns.second, view.xFirstSub, view.width); ++x) {
      const Point c(view.xCenterSub(x), view.yCenterSub(y));
      if (!covers(v, c)) continue;
      float key = vertex[0].key + (gx * float(c.x - vertex[0].at.x) + gy * float(c.y - vertex[0].at.y));
      if (!(key > farthest)) key = farthest;
      if (!(key < nearest)) key = nearest;
      if (!out.wants(x, y, key, id)) continue;
      if (draw.material->alphaMode == AlphaMode::Mask &&
          !(baseColor(context, seePixel(view, draw, triangle, x, y)).a >= draw.material->alphaCutoff))
        continue;
      out.take(x, y, key, id);
    }
}

bool seenFrom(bool inside, const Draw& draw, const glm::vec3 o[3]) {
  if (draw.material->doubleSided || !draw.invertible) return true;
  const glm::dvec3 first(o[0]), a = glm::dvec3(o[1]) - first, b = glm::dvec3(o[2]) - first, eye(draw.eye[0], draw.eye[1], draw.eye[2]);
  const glm::dvec3 n(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  const glm::dvec3 toEye = draw.eye[3] > 0 ? eye - first : eye;
  const double outwards = n.x * toEye.x + n.y * toEye.y + n.z * toEye.z;
  return inside ? outwards < 0 : outwards > 0;
}

void drawTriangle(const SurfaceContext& context, const Draw& draw, uint32_t triangle, const Fragments& out) {
  const View& view = *context.view;
  glm::vec3 o[3], v[3], polygon[kMaxClipped];
  bool inside = true;
  for (int i = 0; i < 3; ++i) {
    o[i] = draw.mesh->positions[draw.mesh->indices[size_t(triangle) * 3 + size_t(i)]];
    for (int r = 0; r < 3; ++r) {
      const float* m = draw.viewFromObject[r];
      v[i][r] = m[0] * o[i].x + m[1] * o[i].y + m[2] * o[i].z + m[3];
    }
    const float w = view.perspective ? 1 / -v[i].z : 1, zView = -v[i].z;
    const float xs = v[i].x * w * view.xScaleSub + view.xShiftSub, ys = v[i].y * w * view.yScaleSub + view.yShiftSub;
    inside &= zView >= view.zNear && zView <= view.zFar && std::fabs(xs) <= float(kGuardSub) && std::fabs(ys) <= float(kGuardSub);
    polygon[i] = v[i];
  }
  if (!seenFrom(out.back, draw, o)) return;
  const int corners = inside ? 3 : clipTriangle(view, v, polygon);
  for (int k = 2; k < corners; ++k) {
    Vertex fan[3];
    const glm::vec3 points[3] = {polygon[0], polygon[k - 1], polygon[k]};
    for (int i = 0; i < 3; ++i) {
      int32_t x, y;
      snapVertex(view, points[i], x, y, fan[i].key);
      fan[i].at = Point(x, y);
    }
    drawSnapped(context, draw, triangle, fan, out);
  }
}

template <class Wanted>
void drawAll(const SurfaceContext& context, const Wanted& wanted, const Fragments& out) {
  for (const Draw& draw : context.draws) {
    if (!wanted(draw)) continue;
    for (uint32_t t = 0; t < draw.triangleCount; ++t) drawTriangle(context, draw, t, out);
  }
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// `plane` begins empty and takes, per pixel, the depth of the largest key up to limit(key of the first layer).
template <class Limit>
void layerBehind(const SurfaceContext& context, Span<const ImplicitDraw> implicits, const Visibility& first, bool back,
                 const Limit& limit, Plane<float>& plane) {
  Plane<float> best(first.width, first.height);
  for (int y = 0; y < first.height; ++y) std::fill_n(best.row(y), first.width, -kInfinity);
  Fragments f;
  f.back = back;
  f.wants = [&](int x, int y, float key, uint32_t) { return key > best.at(x, y) && key <= limit(first.key.at(x, y)); };
  f.take = [&](int x, int y, float key, uint32_t) { best.at(x, y) = key; };
  drawAll(context, [&](const Draw& draw) { return !back || !draw.material->doubleSided; }, f);
  drawImplicitsBehind(*context.view, implicits, back, [&](int x, int y) { return limit(first.key.at(x, y)); }, best);
  for (int y = 0; y < first.height; ++y)
    for (int x = 0; x < first.width; ++x) {
      const float key = best.at(x, y);
      plane.at(x, y) = key == -kInfinity ? kInfinity : context.view->perspective ? 1 / key : 0 - key;
    }
}

}  // namespace

Visibility visibility(const SurfaceContext& context, bool displaced) {
  Visibility out;
  out.width = context.view->width;
  out.height = context.view->height;
  out.key = Plane<float>(out.width, out.height);
  out.triangle = Plane<uint32_t>(out.width, out.height);
  for (int y = 0; y < out.height; ++y) {
    std::fill_n(out.key.row(y), out.width, -kInfinity);
    std::fill_n(out.triangle.row(y), out.width, kNoTriangle);
  }
  Fragments f;
  f.wants = [&](int x, int y, float key, uint32_t id) {
    return key > out.key.at(x, y) || (key == out.key.at(x, y) && id < out.triangle.at(x, y));
  };
  f.take = [&](int x, int y, float key, uint32_t id) {
    out.key.at(x, y) = key;
    out.triangle.at(x, y) = id;
  };
  drawAll(context, [&](const Draw& draw) { return displaced == (draw.material->heightMap.texture >= 0); }, f);
  return out;
}

void layersBehind(const SurfaceContext& context, Span<const ImplicitDraw> implicits, const Visibility& first, float separation,
                  GBuffer& out) {
  const bool perspective = context.view->perspective;
  if (!out.depth2.empty())
    layerBehind(context, implicits, first, false, [&](float key) {
      if (key == -kInfinity) return -kInfinity;
      const float seen = perspective ? 1 / key : 0 - key;
      const float behind = std::max(seen + separation, seen * (1 + 1 / 1048576.0f));
      return perspective ? 1 / behind : 0 - behind;
    }, out.depth2);
  if (!out.depthBack.empty())
    layerBehind(context, implicits, first, true, [](float key) { return key == -kInfinity ? kInfinity : key; }, out.depthBack);
}

}  // namespace ref

void renderReference(const DrawList& list, const Camera& camera, int width, int height, const PlaneSet& planes, GBuffer& out,
                     const std::optional<Window>& window) {
  checkArguments(list, camera, width, height, window);
  checkPlanes(planes);
  const FloatEnvironment environment;
  const SrgbTable srgb;
  const View view = makeView(camera, width, height, window);
  const std::vector<Draw> draws = makeDraws(list, camera);
  const SurfaceContext context{&view, draws, nullptr, list.textures, srgb.linear, list.heights};
  const std::vector<ImplicitDraw> implicits = makeImplicitDraws(list, camera);
  ref::Visibility visibility = ref::visibility(context, false);
  ref::sinkInto(context, ref::visibility(context, true), visibility);
  out = GBuffer(view.width, view.height, planes);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) ref::resolvePixel(context, visibility.triangle.at(x, y), visibility.key.at(x, y), x, y, out);
  ref::storeRelief(context, visibility, out);
  ref::drawImplicits(view, implicits, visibility, out);
  ref::layersBehind(context, implicits, visibility, planes.separation, out);
}

}  // namespace obscura::raster
