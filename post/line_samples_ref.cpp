// Scalar twin of line_samples.cpp, after the formulas of line_samples.h.
#include <cmath>
#include <limits>

#include <glm/vec3.hpp>

#include "obscura/post/depth_map_ref.h"
#include "obscura/post/line_samples.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

float dot(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

void integrate(const TransferInput& in, int x, int y, TransferSums& out) {
  const raster::GBuffer& gbuffer = *in.g;
  const Projector& p = in.projector;
  const AmbientSettings& s = in.settings;
  const bool reads = s.albedo != TransferAlbedo::Own;
  const float n = float(s.samples), z = gbuffer.depth.at(x, y), toR = 1 / s.radius;
  float total = 0, innerSum = 0;
  glm::vec3 readSum(0);

  const int xImage = x + p.xFirst, yImage = y + p.yFirst;
  const bool seen = z < std::numeric_limits<float>::infinity();
  glm::vec3 position((float(xImage) + 0.5f - p.xCenter) * p.xInverse, (float(yImage) + 0.5f - p.yCenter) * p.yInverse, z);
  if (p.perspective) position.x *= z, position.y *= z;
  const glm::vec3 N(gbuffer.normal[0].at(x, y), gbuffer.normal[1].at(x, y), -gbuffer.normal[2].at(x, y));
  const glm::vec3 e = p.perspective ? position * (1 / std::sqrt(dot(position, position))) : glm::vec3(0, 0, 1);
  const float k = 1 / (1 + e.z);
  const glm::vec3 b1(1 - e.x * e.x * k, -(e.x * e.y * k), -e.x), b2(-(e.x * e.y * k), 1 - e.y * e.y * k, -e.y);

  for (size_t i = 0; i < size_t(s.samples) && seen; ++i) {
    const glm::vec3 offset = in.offsets[size_t((xImage & 3) + 4 * (yImage & 3)) * size_t(s.samples) + i];
    const glm::vec3 start = position + s.radius * (offset.x * b1 + offset.y * b2);
    const float inverse = p.perspective ? 1 / start.z : 1;
    const glm::vec3 d = p.perspective ? glm::vec3(start.x * inverse, start.y * inverse, 1) : glm::vec3(0, 0, 1);
    const float A = dot(N, b1) * offset.x + dot(N, b2) * offset.y, B = p.perspective ? dot(N, d) : N.z;
    const float h = offset.x * offset.x + offset.y * offset.y, g = p.perspective ? s.radius * h * inverse : 0;
    const float c = p.perspective ? dot(d, d) : 1, weight = p.perspective ? offset.z * start.z : offset.z;
    const auto integral = [&](float t) { return (A * (c * t + g) - B * (g * t + h)) / std::sqrt((c * t + 2 * g) * t + h); };

    const float root = std::sqrt(g * g + c * (1 - h));
    float low = (-g - root) * (1 / c), high = (root - g) * (1 / c);
    float atLow = A * -root - B * (g * low + h), atHigh = A * root - B * (g * high + h);
    const float turn = -A / B;
    if (B < 0 && turn < high) high = turn, atHigh = integral(turn);
    if (!(B < 0) && turn > low) low = turn, atLow = integral(turn);
    const float whole = (atHigh - atLow) * weight;
    if (!(low < high && whole > 0 && start.z > p.zNear)) continue;
    total += whole;

    const Texel texel = project(p, start);
    const float stored = gbuffer.depth.at(texel.x, texel.y), near = (p.zNear - start.z) * toR;
    float from = near > low ? near : low, inner = 0;
    bool any = false;
    const auto addInside = [&](float first, float last) {
      const float begin = (first - start.z) * toR, end = (last - start.z) * toR;
      const float since = begin > from ? begin : from, to = end < high ? end : high;
      if (!(since < to && begin < high && end > low)) return;
      float part = ((to == high ? atHigh : integral(to)) - (since == low ? atLow : integral(since))) * weight;
      if (!(part < whole)) part = whole;
      if (part > 0) inner += part;
      from = to;
      any = true;
    };
    addInside(stored + s.bias, stored + (s.silhouetteBound ? s.radius : std::numeric_limits<float>::infinity()));
    if (s.layers == 2) {
      const float second = gbuffer.depth2.at(texel.x, texel.y), hidden = second > stored ? second : stored;
      addInside(hidden + s.bias, hidden + kHiddenThickness * s.radius);
    }
    if (!any) continue;
    if (!(inner < whole)) inner = whole;
    innerSum += inner;
    for (int channel = 0; channel < 3 && reads; ++channel) {
      const raster::Plane<float>& read = s.albedo == TransferAlbedo::Radiance ? in.radiance->rgb[channel] : gbuffer.albedo[channel];
      readSum[channel] += inner * read.at(texel.x, texel.y);
    }
  }
  const bool sound = seen && total > 0 && innerSum <= total && total < std::numeric_limits<float>::infinity();
  out.numerator.at(x, y) = sound ? n - n * (innerSum / total) : n;
  const float whole = s.albedo == TransferAlbedo::Radiance ? 0 : n;
  for (int channel = 0; channel < 3 && reads; ++channel)
    out.denominator[channel].at(x, y) = sound ? whole - n * (readSum[channel] / total) : whole;
}

}  // namespace

void lineSamplesRef(const TransferInput& in, int y0, int y1, TransferSums& out) {
  const raster::FloatEnvironment environment;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) {
      integrate(in, x, y, out);
      const uint8_t open = out.numerator.at(x, y) == float(in.settings.samples);
      out.open.at(x / kSegment, y) = x % kSegment == 0 ? open : out.open.at(x / kSegment, y) & open;
    }
}

}  // namespace obscura::post
