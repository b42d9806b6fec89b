#include "obscura/post/brdf_ref.h"

#include <algorithm>
#include <cmath>

namespace obscura::post::ref {
namespace {

bool isUnlit(const Surface& s) { return std::signbit(s.metallic); }

struct Lobe {
  float e, share;  // E, B / E
};

Lobe lookUp(Brdf brdf, float nv, float roughness) {
  const uint32_t* table = brdfTable(brdf);
  const float x = std::sqrt(nv) * 31, y = roughness * 31;
  const int i = std::min(int(x), 30), j = std::min(int(y), 30);
  const float u = x - float(i), w = y - float(j);
  const auto between = [&](int shift) {
    const auto texel = [&](int column, int row) {
      return float(table[row * kBrdfTable + column] >> shift & 0xFFFF);
    };
    const float above = texel(i, j) + (texel(i + 1, j) - texel(i, j)) * u;
    const float below = texel(i, j + 1) + (texel(i + 1, j + 1) - texel(i, j + 1)) * u;
    return (above + (below - above) * w) / 32768;
  };
  return {between(0), between(16)};
}

// (F0 A + B) / E and E k(F0).
float fresnel(const Lobe& lobe, float f0) { return lobe.share + f0 * (1 - lobe.share); }
float regained(const Lobe& lobe, float f0) { return lobe.e + f0 * (1 - lobe.e); }

float dot(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

float facing(const glm::vec3& n, const glm::vec3& v) {
  const float cosine = std::fabs(dot(n, v));
  return cosine > kLeastFacing ? std::min(cosine, 1.0f) : kLeastFacing;
}

float raised(float x, int p) {
  float result = 1;
  for (; p > 0; p >>= 1, x *= x)
    if (p & 1) result *= x;
  return result;
}

// N (n.h)^p
float highlight(Brdf brdf, float roughness, float nh) {
  const float alpha = roughness * roughness, p = std::max(1.0f, std::min(2 / (alpha * alpha) - 2, kMostShininess));
  const int n = int(p);
  const auto between = [&](float first, float next) { return first + (next - first) * (p - float(n)); };
  const float power = raised(nh, n), root = std::ldexp(n % 2 ? 0.707106781f : 1.0f, -std::min(n / 2, 100));
  float value = between(power, power * nh);
  if (brdf == Brdf::BlinnPhongThresholded) value = value >= 0.5f ? kThresholded : 0;
  return (p + 2) * (p + 4) / (25.1327412f * (p + between(root, root * 0.707106781f))) * value;
}

// D V of GGX and Smith.
float microfacets(float roughness, float nl, float nv, float sine2) {
  const float alpha = std::max(roughness * roughness, kLeastAlpha), a2 = alpha * alpha;
  const auto shadowed = [&](float cosine) { return std::sqrt(cosine * cosine * (1 - a2) + a2); };
  const float t = sine2 * (1 - a2) + a2;
  return a2 * 0.159154943f / (t * t * (nl * shadowed(nv) + nv * shadowed(nl)));
}

}  // namespace

glm::vec3 viewDirection(const Projector& p, int x, int y) {
  if (!p.perspective) return {0, 0, 1};
  const float vx = (p.xCenter - (float(p.xFirst + x) + 0.5f)) * p.xInverse, vy = (p.yCenter - (float(p.yFirst + y) + 0.5f)) * p.yInverse;
  const float perLength = 1 / std::sqrt(vx * vx + vy * vy + 1);
  return {vx * perLength, vy * perLength, perLength};
}

Reflectance ambientReflectance(Brdf brdf, const Surface& s) {
  if (brdf == Brdf::Lambert) return {s.base, glm::vec3(0)};
  if (isUnlit(s)) return {glm::vec3(0), glm::vec3(0)};
  const Lobe lobe = lookUp(brdf, facing(s.n, s.v), s.roughness);
  const float m = s.metallic;
  Reflectance r;
  for (int c = 0; c < 3; ++c) {
    const float base = s.base[c];
    if (brdf == Brdf::Gltf) {
      const float ofOther = (1 - m) * (fresnel(lobe, kDielectric) * regained(lobe, kDielectric));
      r.specular[c] = m * (fresnel(lobe, base) * regained(lobe, base)) + ofOther;
      r.diffuse[c] = base * (1 - (m + ofOther));
    } else {
      const float f0 = m * base + (1 - m) * kDielectric;
      r.specular[c] = fresnel(lobe, f0) * lobe.e;
      r.diffuse[c] = (1 - m) * base * (1 - r.specular[c]);
    }
  }
  return r;
}

glm::vec3 reflection(Brdf brdf, const Surface& s, const glm::vec3& l, float nl) {
  constexpr float kPerPi = 0.318309886f;
  const glm::vec3 diffuse = ambientReflectance(brdf, s).diffuse * kPerPi;
  if (brdf == Brdf::Lambert || isUnlit(s)) return diffuse;
  const glm::vec3 h = l + s.v, across(s.n.y * h.z - s.n.z * h.y, s.n.z * h.x - s.n.x * h.z, s.n.x * h.y - s.n.y * h.x);
  const float square = dot(h, h) > 1e-12f ? dot(h, h) : 1e-12f, length = std::sqrt(square);
  const float nh = std::max(std::min(dot(s.n, h) / length, 1.0f), 0.0f), sine2 = std::min(dot(across, across) / square, 1.0f);
  const float x = std::max(1 - 0.5f * length, 0.0f), schlick = x * x * (x * x) * x;
  const Lobe lobe = lookUp(brdf, facing(s.n, s.v), s.roughness);
  const float m = s.metallic;
  glm::vec3 f;
  for (int c = 0; c < 3; ++c) {
    const float base = s.base[c];
    if (brdf == Brdf::Gltf) {
      const float perE = 1 / lobe.e, metal = m * (regained(lobe, base) * perE), other = (1 - m) * (regained(lobe, kDielectric) * perE);
      const float normal = metal * base + other * kDielectric, grazing = metal * (1 - base) + other * (1 - kDielectric);
      f[c] = (normal + grazing * schlick) * microfacets(s.roughness, nl, facing(s.n, s.v), sine2) + diffuse[c];
    } else {
      const float f0 = m * base + (1 - m) * kDielectric;
      f[c] = (f0 + (1 - f0) * schlick) * highlight(brdf, s.roughness, nh) + diffuse[c];
    }
  }
  return f;
}

}  // namespace obscura::post::ref
