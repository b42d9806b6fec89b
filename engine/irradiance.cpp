#include "obscura/engine/irradiance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace obscura::engine {
namespace {

constexpr size_t kRowsPerTask = 8;
constexpr double kPi = 3.141592653589793;
// Of the real spherical harmonics (equation 3) and of equation 12, to more digits than printed there.
constexpr double kY0 = 0.28209479177387814, kY1 = 0.4886025119029199, kY2 = 1.0925484305920792, kY20 = 0.31539156525252005,
                 kY22 = 0.5462742152960396;
constexpr double kC1 = kPi / 4 * kY22, kC2 = kPi / 3 * kY1, kC3 = 3 * kPi / 4 * kY20, kC4 = kPi * kY0, kC5 = kPi / 4 * kY20;

std::array<double, 9> basisAt(const glm::dvec3& d) {
  return {kY0, kY1 * d.y, kY1 * d.z, kY1 * d.x, kY2 * d.x * d.y, kY2 * d.y * d.z, kY20 * (3 * d.z * d.z - 1), kY2 * d.x * d.z, kY22 * (d.x * d.x - d.y * d.y)};
}

void addTexel(const glm::dvec3& radiance, const glm::dvec3& d, Harmonics& sum) {
  const std::array<double, 9> basis = basisAt(d);
  for (size_t k = 0; k < 9; ++k) sum[k] += basis[k] * radiance;
}

// What a row of a panel adds. Texels on the rim of a circle count with the part inside of it.
Harmonics ofRow(const EnvironmentMap& map, const TexelDirections& directions, int panel, int y) {
  const EnvironmentProjector& p = map.projector();
  Harmonics sum{};
  double weight = 0;
  for (int x = 0; x < p.width; ++x) {
    if (x == 0 || p.projection != EnvironmentProjection::Latlong) weight = p.solidAngle(x, y);  // the same all along a row
    if (weight > 0) addTexel(weight * glm::dvec3(map.at(panel, x, y)), directions.at(panel, x, y), sum);
  }
  return sum;
}

}  // namespace

Harmonics harmonicsOf(const EnvironmentMap& map, raster::Parallel& parallel) {
  const EnvironmentProjector& p = map.projector();
  const TexelDirections directions(p);
  std::vector<Harmonics> rows(size_t(p.panels()) * size_t(p.height));
  parallel.forRanges(rows.size(), kRowsPerTask, [&](size_t begin, size_t end, int) {
    for (size_t row = begin; row < end; ++row) rows[row] = ofRow(map, directions, int(row / size_t(p.height)), int(row % size_t(p.height)));
  });
  Harmonics sum{};  // in the order of the rows
  for (const Harmonics& row : rows)
    for (size_t k = 0; k < 9; ++k) sum[k] += row[k];
  return sum;
}

glm::dvec3 radianceOf(const Harmonics& l, const glm::dvec3& d) {
  const std::array<double, 9> basis = basisAt(d);
  glm::dvec3 sum(0);
  for (size_t k = 0; k < 9; ++k) sum += basis[k] * l[k];
  return sum;
}

glm::dvec3 irradiance(const Harmonics& l, const glm::dvec3& n) {
  return kC1 * l[8] * (n.x * n.x - n.y * n.y) + kC3 * l[6] * (n.z * n.z) + kC4 * l[0] - kC5 * l[6] +
         2 * kC1 * (l[4] * (n.x * n.y) + l[7] * (n.x * n.z) + l[5] * (n.y * n.z)) + 2 * kC2 * (l[3] * n.x + l[1] * n.y + l[2] * n.z);
}

post::NormalQuadric quadricOf(const Harmonics& l, const glm::dmat3& viewFromMap, double intensity) {
  const double scale = intensity / kPi;
  post::NormalQuadric q;
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](size_t k) { return l[k][c] * scale; };
    // E = n^t a n + b n + constant in the map's space; with n = R^t m it is m^t (R a R^t) m + (R b) m + constant.
    const glm::dmat3 a(kC1 * at(8), kC1 * at(4), kC1 * at(7), kC1 * at(4), -kC1 * at(8), kC1 * at(5), kC1 * at(7), kC1 * at(5), kC3 * at(6));
    const glm::dmat3 turned = viewFromMap * a * glm::transpose(viewFromMap);
    const glm::dvec3 b = viewFromMap * (2 * kC2 * glm::dvec3(at(3), at(1), at(2)));
    const double constant = kC4 * at(0) - kC5 * at(6);
    q.constant[c] = float(constant);
    q.x[c] = float(b.x), q.y[c] = float(b.y), q.z[c] = float(b.z);
    q.xx[c] = float(turned[0][0]), q.yy[c] = float(turned[1][1]), q.zz[c] = float(turned[2][2]);
    q.xy[c] = float(2 * turned[0][1]), q.xz[c] = float(2 * turned[0][2]), q.yz[c] = float(2 * turned[1][2]);
    double squares = 0;  // the Frobenius norm bounds n^t a n
    for (int k = 0; k < 9; ++k) squares += turned[k / 3][k % 3] * turned[k / 3][k % 3];
    q.most[c] = float(std::fabs(constant) + glm::length(b) + std::sqrt(squares));
  }
  return q;
}

}  // namespace obscura::engine
