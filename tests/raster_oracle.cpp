#include "raster_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "obscura/raster/clip.h"
#include "obscura/raster/transform.h"

namespace obscura::tests {
namespace {

Int128 ceilDivide(Int128 n, Int128 d) {  // d > 0
  return n / d + (n % d > 0);
}

double squaredDistance(SubPoint p, SubPoint q, SubPoint c) {
  const double dx = double(q.x - p.x), dy = double(q.y - p.y), cx = double(c.x - p.x), cy = double(c.y - p.y);
  const double square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp((cx * dx + cy * dy) / square, 0.0, 1.0) : 0.0;
  const double ex = cx - t * dx, ey = cy - t * dy;
  return ex * ex + ey * ey;
}

}  // namespace

Columns coveredColumns(const OracleTriangle& t, const OracleImage& image, int row) {
  const int64_t y = image.yCenter(row);
  int at[2], crossings = 0;
  for (int i = 0; i < 3; ++i) {
    SubPoint upper = t.at[i], lower = t.at[(i + 1) % 3];
    if (upper.y > lower.y) std::swap(upper, lower);
    if (!(upper.y <= y && y < lower.y)) continue;
    // x = upper.x + (y - upper.y) dx / dy; the first column whose centre is not left of it.
    const Int128 dy = lower.y - upper.y, dx = lower.x - upper.x;
    const Int128 fromFirstCenter = Int128(upper.x - image.xCenter(0)) * dy + Int128(y - upper.y) * dx;
    const Int128 column = ceilDivide(fromFirstCenter, dy * raster::kSub);
    at[crossings++] = int(std::clamp<Int128>(column, 0, image.width));
  }
  if (crossings == 0) return {};
  return {std::min(at[0], at[1]), std::max(at[0], at[1])};
}

bool insidePolygon(const std::vector<SubPoint>& polygon, SubPoint c) {
  bool inside = false;
  for (size_t i = 0; i < polygon.size(); ++i) {
    SubPoint upper = polygon[i], lower = polygon[(i + 1) % polygon.size()];
    if (upper.y > lower.y) std::swap(upper, lower);
    if (!(upper.y <= c.y && c.y < lower.y)) continue;
    const Int128 dy = lower.y - upper.y;
    if (Int128(upper.x) * dy + Int128(c.y - upper.y) * (lower.x - upper.x) <= Int128(c.x) * dy) inside = !inside;
  }
  return inside;
}

bool nearAnEdge(const OracleTriangle& t, SubPoint center, double distance) {
  for (int i = 0; i < 3; ++i)
    if (squaredDistance(t.at[i], t.at[(i + 1) % 3], center) < distance * distance) return true;
  return false;
}

KeyError keyError(const OracleTriangle& t, SubPoint c, float found) {
  // key * area = sum of key_i times the doubled area opposite to vertex i.
  Int128 weighted = 0, area = 0;
  for (int i = 0; i < 3; ++i) {
    const SubPoint p = t.at[(i + 1) % 3], q = t.at[(i + 2) % 3];
    const Int128 opposite = Int128(p.x - c.x) * (q.y - c.y) - Int128(p.y - c.y) * (q.x - c.x);
    weighted += opposite * Int128(t.key[i]);
    area += opposite;
  }
  constexpr int kFraction = 23;  // bits of a float at or above 1 that lie below the point
  const Int128 foundFixed = Int128(double(found) * double(1 << kFraction));
  const Int128 difference = foundFixed * area - weighted * (1 << kFraction);
  const double x1 = double(t.at[1].x - t.at[0].x), y1 = double(t.at[1].y - t.at[0].y);
  const double x2 = double(t.at[2].x - t.at[0].x), y2 = double(t.at[2].y - t.at[0].y);
  const double k1 = double(t.key[1]) - t.key[0], k2 = double(t.key[2]) - t.key[0];
  const double xGradient = (k1 * y2 - k2 * y1) / double(area), yGradient = (k2 * x1 - k1 * x2) / double(area);
  KeyError e;
  e.error = std::fabs(double(difference) / double(area)) / double(1 << kFraction);
  e.terms = std::fabs(t.key[0]) + std::fabs(xGradient * double(c.x - t.at[0].x)) +
            std::fabs(yGradient * double(c.y - t.at[0].y));
  return e;
}

std::vector<OracleTriangle> snappedPieces(const raster::View& view, const raster::Draw& draw, uint32_t triangle) {
  float p[3][3];
  glm::vec3 inView[3], polygon[raster::kMaxClipped];
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 v = draw.mesh->positions[draw.mesh->indices[size_t(triangle) * 3 + size_t(i)]];
    for (int c = 0; c < 3; ++c) p[c][i] = v[c];
    for (int r = 0; r < 3; ++r) {
      const float* m = draw.viewFromObject[r];
      inView[i][r] = ((m[0] * v.x + m[1] * v.y) + m[2] * v.z) + m[3];
    }
  }
  raster::TransformedVertices vertices;
  raster::transformVerticesRef(view, draw, p[0], p[1], p[2], 3, vertices);
  std::vector<OracleTriangle> pieces;
  if (!(vertices.anyCode & raster::kNeedsClip)) {
    OracleTriangle& t = pieces.emplace_back();
    for (int i = 0; i < 3; ++i) t.at[i] = {vertices.xSub[i], vertices.ySub[i]}, t.key[i] = vertices.key[i];
    return pieces;
  }
  const int corners = raster::clipTriangle(view, inView, polygon);
  for (int k = 2; k < corners; ++k) {
    OracleTriangle& t = pieces.emplace_back();
    const glm::vec3 points[3] = {polygon[0], polygon[k - 1], polygon[k]};
    for (int i = 0; i < 3; ++i) {
      int32_t x, y;
      raster::snapVertex(view, points[i], x, y, t.key[i]);
      t.at[i] = {x, y};
    }
  }
  return pieces;
}

std::string textOf(const OracleTriangle& t) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    char one[96];
    std::snprintf(one, sizeof one, "%s(%lld, %lld) key %.9g", i ? ", " : "", static_cast<long long>(t.at[i].x),
                  static_cast<long long>(t.at[i].y), double(t.key[i]));
    text += one;
  }
  return text;
}

}  // namespace obscura::tests
