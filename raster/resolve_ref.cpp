// Scalar twin of resolve.cpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/raster/reference.h"

namespace obscura::raster::ref {
namespace {

float dot(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

glm::vec3 cross(const glm::vec3& a, const glm::vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

bool normalize(glm::vec3& v) {
  const float square = dot(v, v);
  if (!(square >= 1e-36f && square <= 1e36f)) return false;
  v *= 1 / std::sqrt(square);
  return true;
}

template <class Rows>
glm::vec3 rotate(const Rows& m, const glm::vec3& v) {
  glm::vec3 r;
  for (int i = 0; i < 3; ++i) r[i] = m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z;
  return r;
}

glm::vec3 geometricNormal(const SurfacePoint& p) {
  const glm::vec3 n = cross(p.object[1] - p.object[0], p.object[2] - p.object[0]);
  const float size = std::max({std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)});
  glm::vec3 v = rotate(p.draw->normalToView, size > 0 && std::isfinite(size) ? n / size : n);
  return normalize(v) ? v : glm::vec3(0, 0, 1);
}

glm::vec3 bend(const SurfaceContext& context, const SurfacePoint& p, const glm::vec3& n) {
  const Draw& draw = *p.draw;
  const Material& m = *draw.material;
  const glm::vec4 texel = sampleSlot(context, p, m.normalMap);
  const glm::vec3 t((texel.x * 2 - 1) * m.normalScale, (texel.y * 2 - 1) * m.normalScale, texel.z * 2 - 1);
  const auto tangents = draw.mesh->tangents;
  const auto uvs = draw.mesh->uvs[m.normalMap.uvSet];
  glm::vec3 tangent(0);
  bool right;
  if (!tangents.empty()) {
    const glm::vec4 t4 = interpolate(p, tangents);
    tangent = glm::vec3(t4);
    right = !(t4.w < 0);
  } else if (!uvs.empty()) {
    const glm::vec2 a = uvs[p.vertex[1]] - uvs[p.vertex[0]], b = uvs[p.vertex[2]] - uvs[p.vertex[0]];
    tangent = (p.object[1] - p.object[0]) * b.y - (p.object[2] - p.object[0]) * a.y;
    right = a.x * b.y - b.x * a.y < 0;
    if (right) tangent = -tangent;
  } else {
    return n;
  }
  tangent = rotate(draw.viewFromObject, tangent);
  if (!normalize(tangent)) return n;
  if (draw.mirrored) right = !right;
  glm::vec3 bitangent = cross(n, tangent);
  if (!right) bitangent = -bitangent;
  glm::vec3 bent = tangent * t.x + bitangent * t.y + n * t.z;
  return normalize(bent) ? bent : n;
}

glm::vec3 shadingNormal(const SurfaceContext& context, const SurfacePoint& p) {
  const Draw& draw = *p.draw;
  const auto normals = draw.mesh->normals;
  glm::vec3 corner[3];
  for (int i = 0; i < 3; ++i) corner[i] = normals.empty() ? geometricNormal(p) : rotate(draw.normalToView, normals[p.vertex[i]]);
  glm::vec3 n = corner[0] + ((corner[1] - corner[0]) * p.weight[1] + (corner[2] - corner[0]) * p.weight[2]);
  if (!normalize(n)) n = geometricNormal(p);
  if (draw.material->normalMap.texture >= 0 && draw.material->heightMap.texture < 0) n = bend(context, p, n);
  const bool fromBehind = p.clockwise != draw.mirrored;
  return draw.material->doubleSided && fromBehind ? -n : n;
}

float nonNegative(float v) { return v > 0 ? v : 0; }

void store(Plane<float> planes[3], int x, int y, const glm::vec3& v) {
  if (planes[0].empty()) return;
  for (int c = 0; c < 3; ++c) planes[c].at(x, y) = v[c];
}

void store(Plane<uint32_t>& plane, int x, int y, uint32_t v) {
  if (!plane.empty()) plane.at(x, y) = v;
}

void store(Plane<float>& plane, int x, int y, float v) {
  if (!plane.empty()) plane.at(x, y) = v;
}

// Of a pixel's centre in view space.
glm::vec3 positionAt(const View& view, int x, int y, float zView) {
  glm::vec3 p((float(view.xCenterSub(x)) - view.xShiftSub) / view.xScaleSub,
              (float(view.yCenterSub(y)) - view.yShiftSub) / view.yScaleSub, 0);
  if (view.perspective) p *= zView;
  p.z = 0 - zView;
  return p;
}

}  // namespace

void resolveImplicit(const View& view, const ImplicitDraw& surface, const glm::vec3& normal, float key, int x, int y, GBuffer& out) {
  const float zView = view.perspective ? 1 / key : 0 - key;
  if (!out.depth.empty()) out.depth.at(x, y) = zView;
  store(out.normal, x, y, normal);
  store(out.facet, x, y, normal);
  store(out.albedo, x, y, surface.albedo);
  store(out.emissive, x, y, surface.emissive);
  store(out.metallic, x, y, surface.metallic);
  store(out.roughness, x, y, surface.roughness);
  store(out.position, x, y, positionAt(view, x, y, zView));
  store(out.triangle, x, y, surface.id);
  store(out.instance, x, y, surface.instance);
  store(out.material, x, y, surface.materialIndex);
  store(out.heightMap, x, y, kNoTriangle);
  for (Plane<float>& plane : out.relief)
    if (!plane.empty()) plane.at(x, y) = 0;
}

glm::vec2 metallicRoughness(const SurfaceContext& context, const SurfacePoint& p) {
  const Material& m = *p.draw->material;
  glm::vec2 v(m.metallic, m.roughness);
  if (m.metallicRoughnessMap.texture >= 0) {
    const glm::vec4 texel = sampleSlot(context, p, m.metallicRoughnessMap);
    v *= glm::vec2(texel.b, texel.g);
  }
  return v;
}

void resolveShaded(const SurfaceContext& context, uint32_t id, float key, const Shaded& shaded, int x, int y, GBuffer& out) {
  const View& view = *context.view;
  const Draw& draw = drawOf(context, id);
  const float zView = view.perspective ? 1 / key : 0 - key;
  glm::vec3 base = shaded.base, emitted = shaded.emitted;
  for (int c = 0; c < 3; ++c) {
    base[c] = std::min(nonNegative(base[c]), 1.0f);
    emitted[c] = nonNegative(emitted[c]);
  }
  const bool unlit = draw.material->unlit;
  if (!out.depth.empty()) out.depth.at(x, y) = zView;
  store(out.normal, x, y, shaded.normal);
  store(out.albedo, x, y, unlit ? glm::vec3(0) : base);
  store(out.emissive, x, y, unlit ? base : emitted);
  store(out.metallic, x, y, unlit ? -0.0f : std::min(nonNegative(shaded.metallic), 1.0f));
  store(out.roughness, x, y, unlit ? 1 : std::min(nonNegative(shaded.roughness), 1.0f));
  store(out.position, x, y, positionAt(view, x, y, zView));
  store(out.triangle, x, y, id);
  store(out.instance, x, y, draw.instance);
  store(out.material, x, y, draw.materialIndex);
}

void resolvePixel(const SurfaceContext& context, uint32_t id, float key, int x, int y, GBuffer& out) {
  if (id != kNoTriangle) {
    const Draw& draw = drawOf(context, id);
    const Material& m = *draw.material;
    const SurfacePoint p = seePixel(*context.view, draw, id - draw.firstTriangle, x, y);
    glm::vec3 emitted = m.emissive;
    store(out.facet, x, y, geometricNormal(p));
    if (m.emissiveMap.texture >= 0) emitted *= glm::vec3(sampleSlot(context, p, m.emissiveMap));
    const glm::vec2 gloss = metallicRoughness(context, p);
    return resolveShaded(context, id, key, {shadingNormal(context, p), glm::vec3(baseColor(context, p)), emitted, gloss.x, gloss.y}, x, y, out);
  }
  if (!out.depth.empty()) out.depth.at(x, y) = std::numeric_limits<float>::infinity();
  for (auto* planes : {out.normal, out.facet, out.albedo, out.emissive, out.position}) store(planes, x, y, glm::vec3(0));
  store(out.metallic, x, y, 0);
  store(out.roughness, x, y, 0);
  for (Plane<uint32_t>* plane : {&out.triangle, &out.instance, &out.material}) store(*plane, x, y, kNoTriangle);
}

}  // namespace obscura::raster::ref
