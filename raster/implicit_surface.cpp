#include "obscura/raster/implicit_surface.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "obscura/raster/implicit.h"

namespace obscura::raster {
namespace {

constexpr double kRoom = 1.001;  // the surface lies inside its bound

double length(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

// Of the balls' reaches.
ImplicitBound boundOfBalls(const std::vector<ImplicitBall>& balls) {
  if (balls.empty()) return {};
  glm::dvec3 low = balls[0].center, high = low;
  for (const ImplicitBall& b : balls)
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], b.center[c] - kBallReach * b.radius);
      high[c] = std::max(high[c], b.center[c] + kBallReach * b.radius);
    }
  ImplicitBound bound{(low + high) * 0.5, 0};
  for (const ImplicitBall& b : balls) bound.radius = std::max(bound.radius, length(b.center - bound.center) + kBallReach * b.radius);
  return bound;
}

// The field of a ball, (1 - (d / reach)^2)^3, is nowhere steeper than 96 / (25 sqrt 5) / reach. Where fields add up their
// balls' reaches meet in pairs: no point's slopes add up to more than those of some ball and all that meet it.
double steepnessOfBalls(const std::vector<ImplicitBall>& balls) {
  constexpr double kSteepest = 1.7174;
  double most = 0;
  for (const ImplicitBall& a : balls) {
    double sum = 0;
    for (const ImplicitBall& b : balls)
      if (length(a.center - b.center) <= kBallReach * (a.radius + b.radius) * kRoom) sum += kSteepest / (kBallReach * b.radius);
    most = std::max(most, sum);
  }
  return most;
}

bool isLength(double v) { return v > 0 && v <= kMostImplicit; }
bool isPoint(const glm::dvec3& v) { return length(v) <= kMostImplicit; }

float unitRange(float v) { return v > 0 ? std::min(v, 1.0f) : 0; }

// False: there is no inverse.
bool invert(const glm::dmat4& m, double out[3][4]) {
  double cofactor[3][3], determinant = 0;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cofactor[r][c] = m[c1][r1] * m[c2][r2] - m[c2][r1] * m[c1][r2];
    }
  for (int c = 0; c < 3; ++c) determinant += m[c][0] * cofactor[0][c];
  const double perDeterminant = 1 / determinant;
  bool finite = std::isfinite(perDeterminant) && determinant != 0;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out[r][c] = cofactor[c][r] * perDeterminant;
    out[r][3] = -(out[r][0] * m[3][0] + out[r][1] * m[3][1] + out[r][2] * m[3][2]);
    for (int c = 0; c < 4; ++c) finite &= std::isfinite(out[r][c]);
  }
  return finite;
}

ViewSphere sphereInView(const glm::dmat4& m, const ImplicitBound& bound) {
  constexpr double kSlack = 1e-4;  // far more than double and float lose on the way to the screen
  ViewSphere s;
  double size = 0, most = 0;
  for (int r = 0; r < 3; ++r) {
    double p = m[3][r];
    size += std::fabs(p);
    for (int c = 0; c < 3; ++c) {
      p += m[c][r] * bound.center[c];
      size += std::fabs(m[c][r] * bound.center[c]);
    }
    s.p[r] = float(p);
  }
  // No direction is stretched more than by the root of the largest row sum of M^T M, of a rotation 1.
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) sum += std::fabs(m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2]);
    most = std::max(most, sum);
  }
  const double reach = bound.radius * std::sqrt(most);
  s.reach = float(reach + (size + reach) * kSlack);
  return s;
}

}  // namespace

ImplicitBound boundOf(const ImplicitSurface& s) {
  ImplicitBound b;
  switch (s.shape) {
    case ImplicitShape::Sphere:
    case ImplicitShape::Function: b.radius = s.radius; break;
    case ImplicitShape::Box: b.radius = length(s.halfSize); break;
    case ImplicitShape::Torus: b.radius = s.radius + s.tube; break;
    case ImplicitShape::Metaballs: b = boundOfBalls(s.balls); break;
    case ImplicitShape::Gyroid: b.radius = s.radius > 0 ? s.radius : length(s.halfSize); break;
  }
  b.radius *= kRoom;
  return b;
}

const char* wrongImplicit(const ImplicitSurface& s) {
  const bool box = s.shape == ImplicitShape::Box || (s.shape == ImplicitShape::Gyroid && s.radius == 0);
  if (s.shape != ImplicitShape::Metaballs && !box && !isLength(s.radius)) return "its radius is not positive, or too large";
  if (box && !(isLength(s.halfSize.x) && isLength(s.halfSize.y) && isLength(s.halfSize.z)))
    return "its half size is not positive, or too large";
  switch (s.shape) {
    case ImplicitShape::Sphere:
    case ImplicitShape::Box: break;
    case ImplicitShape::Torus:
      if (!isLength(s.tube)) return "its tube's radius is not positive, or too large";
      break;
    case ImplicitShape::Gyroid:
      if (!isLength(s.period)) return "its period is not positive, or too large";
      if (!isLength(s.thickness)) return "its thickness is not positive, or too large";
      break;
    case ImplicitShape::Function:
      if (!s.function) return "it has no function";
      if (!isLength(s.steepness)) return "its steepness is not positive, or too large";
      break;
    case ImplicitShape::Metaballs:
      if (s.balls.empty() || s.balls.size() > kMostBalls) return "it does not have 1 to 1024 balls";
      for (const ImplicitBall& b : s.balls)
        if (!isLength(b.radius) || !isPoint(b.center)) return "a ball's radius is not positive, or it is too large or too far away";
      break;
    default: return "its shape is none of ImplicitShape";
  }
  return nullptr;
}

std::vector<ImplicitDraw> makeImplicitDraws(const DrawList& list, const Camera& camera) {
  std::vector<ImplicitDraw> draws;
  uint32_t id = 0;
  for (const Instance& i : list.instances) id += i.mesh->triangleCount();
  for (size_t k = 0; k < list.implicits.size(); ++k, ++id) {
    const ImplicitSurface& s = list.implicits[k];
    const Material& m = list.materials[s.material];
    if (m.alphaMode == AlphaMode::Mask && !(m.baseColor.a >= m.alphaCutoff)) continue;
    ImplicitDraw d;
    const glm::dmat4 viewFromObject = camera.viewFromWorld * s.worldFromObject;
    if (!invert(viewFromObject, d.objectFromView)) continue;
    d.surface = &s;
    d.bound = boundOf(s);
    d.sphere = sphereInView(viewFromObject, d.bound);
    if (s.shape == ImplicitShape::Metaballs) d.perSteepness = 1 / steepnessOfBalls(s.balls);
    if (s.shape == ImplicitShape::Function) d.perSteepness = 1 / s.steepness;
    // The gradient of sin x cos y + ... has a length of at most sqrt 3.
    if (s.shape == ImplicitShape::Gyroid) d.perPeriod = 1 / s.period, d.perSlope = s.period / (6.283185307179586 * 1.7320508075688774);
    for (int c = 0; c < 3; ++c) {
      const float base = unitRange(m.baseColor[c]);
      d.albedo[c] = m.unlit ? 0 : base;
      d.emissive[c] = m.unlit ? base : m.emissive[c] > 0 ? m.emissive[c] : 0;
    }
    d.metallic = m.unlit ? -0.0f : unitRange(m.metallic);
    d.roughness = m.unlit ? 1 : unitRange(m.roughness);
    d.doubleSided = m.doubleSided;
    d.id = id;
    d.instance = uint32_t(list.instances.size() + k);
    d.materialIndex = s.material;
    draws.push_back(d);
  }
  return draws;
}

bool touchesImplicits(const View& view, Span<const ImplicitDraw> surfaces, const TileBuffers& tile, bool skip) {
  if (!skip) return !surfaces.empty();
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const ImplicitDraw& s) {
    const ScreenBound b = screenBound(view, s.sphere);
    return b.x0 < tile.x + tile.width && b.x1 >= tile.x && b.y0 < tile.y + tile.height && b.y1 >= tile.y;
  });
}

}  // namespace obscura::raster
