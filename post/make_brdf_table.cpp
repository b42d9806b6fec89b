#include "obscura/post/make_brdf_table.h"

#include <algorithm>
#include <cmath>

#include "obscura/raster/exact_math.h"

namespace obscura::post {
namespace {

constexpr double kPi = 3.141592653589793, kRootTwo = 1.4142135623730951;

// The specular part of a BRDF for F = 1.
struct Highlight {
  Brdf brdf;
  double alpha2;       // of GGX, or of the GGX that is about as wide
  double p = 1;        // shininess
  double scale = 1;    // N
  double least = 0;    // n.h below which nothing is seen

  Highlight(Brdf b, double roughness) : brdf(b) {
    double alpha = roughness * roughness;
    if (brdf == Brdf::Gltf) {
      alpha = std::max(alpha, double(kLeastAlpha));
      alpha2 = alpha * alpha;
      return;
    }
    p = std::clamp(2 / std::max(alpha * alpha, 1e-9) - 2, 1.0, double(kMostShininess));
    alpha2 = 2.0 / (p + 2);
    scale = (p + 2) * (p + 4) / (8 * kPi * (p + power(0.5 * kRootTwo)));
    if (brdf != Brdf::BlinnPhongThresholded) return;
    double most = 1;
    for (int k = 0; k < 60; ++k) {  // by halving, as the power is linear between whole numbers
      const double middle = 0.5 * (least + most);
      (power(middle) < 0.5 ? least : most) = middle;
    }
  }

  double power(double x) const {
    const double whole = std::floor(p), first = raster::exactPow(x, whole);
    return first + (first * x - first) * (p - whole);
  }

  double at(double nl, double nv, double nh) const {
    if (brdf == Brdf::BlinnPhong) return scale * power(nh);
    if (brdf == Brdf::BlinnPhongThresholded) return scale * double(kThresholded);
    const double t = 1 + nh * nh * (alpha2 - 1);
    const auto shadowed = [&](double c) { return std::sqrt(c * c * (1 - alpha2) + alpha2); };
    return alpha2 / (kPi * t * t) * 0.5 / (nl * shadowed(nv) + nv * shadowed(nl));
  }
};

}  // namespace

LobeIntegrals integrateLobe(Brdf brdf, double nv, double roughness) {
  const Highlight highlight(brdf, roughness);
  const double a2 = highlight.alpha2, sv = std::sqrt(std::max(1 - nv * nv, 0.0));
  double stepSin[kHalfVectorSteps], stepCos[kHalfVectorSteps];
  for (int k = 0; k < kHalfVectorSteps; ++k) {
    const double angle = kPi / 2 * (k + 0.5) / kHalfVectorSteps;
    stepSin[k] = raster::exactSin(angle), stepCos[k] = raster::exactCos(angle);
  }
  // u is the part of D n.h within the ring of n.h. All of a ring has n.l > 0 up to n.h^2 = (1 + sin v) / 2, and nothing of
  // those beyond (1 - sin v) / 2.
  const auto partWithin = [&](double nh2) { return (1 - nh2) / (1 + (a2 - 1) * nh2); };
  const double seen = partWithin(highlight.least * highlight.least);
  const double whole = std::min(partWithin(0.5 + 0.5 * sv), seen), none = std::min(partWithin(0.5 - 0.5 * sv), seen);
  LobeIntegrals sum;
  for (int ring = 0; ring < 2 * kHalfVectorRings; ++ring) {
    const double first = ring < kHalfVectorRings ? 0 : whole, size = ring < kHalfVectorRings ? whole : none - whole;
    const double t = (ring % kHalfVectorRings + 0.5) / kHalfVectorRings;
    const double u = first + size * t * t * t * (10 - 15 * t + 6 * t * t), du = size * 30 * t * t * (1 - t) * (1 - t) / kHalfVectorRings;
    const double nh2 = (1 - u) / (1 + (a2 - 1) * u), nh = std::sqrt(nh2), sh = std::sqrt(std::max(1 - nh2, 0.0));
    const double d = a2 / (kPi * (1 + nh2 * (a2 - 1)) * (1 + nh2 * (a2 - 1)));
    // n.l = 2 v.h n.h - n.v > 0 where the cosine of the azimuth is above this.
    const double end = ring < kHalfVectorRings ? -1 : std::clamp((nv / (2 * nh) - nh * nv) / (sh * sv), -1.0, 1.0);
    for (int k = 0; k < kHalfVectorSteps; ++k) {
      // cos azimuth = 1 - (1 - end) y^2, y the sine of evenly spread angles.
      const double y2 = stepSin[k] * stepSin[k], azimuth = 1 - (1 - end) * y2;
      const double dAzimuth = 2 * std::sqrt(1 - end) * (kPi / 2 * stepCos[k] / kHalfVectorSteps) / std::sqrt(2 - (1 - end) * y2);
      const double vh = sh * azimuth * sv + nh * nv, nl = 2 * vh * nh - nv;
      if (!(nl > 0 && vh > 0)) continue;
      // Both halves of the ring, and h as often as D n.h says.
      const double weight = highlight.at(nl, nv, nh) * nl * 4 * vh / (d * nh) * du * dAzimuth / kPi, x = 1 - vh;
      sum.e += weight;
      sum.share += weight * (x * x * x * x * x);
    }
  }
  if (sum.e > 0) sum.share /= sum.e;
  return sum;
}

uint32_t makeBrdfElement(Brdf brdf, int i, int j) {
  constexpr double kLast = kBrdfTable - 1;
  const double x = i / kLast;
  const LobeIntegrals lobe = integrateLobe(brdf, std::max(x * x, double(kLeastFacing)), j / kLast);
  const auto rounded = [](double v) { return uint32_t(std::min(v, 1.0) * 32768 + 0.5); };
  return rounded(lobe.e) | rounded(lobe.share) << 16;
}

}  // namespace obscura::post
