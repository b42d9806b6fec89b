#include "obscura/raster/gbuffer.h"

namespace obscura::raster {

GBuffer::GBuffer(int w, int h, const PlaneSet& planes) : width(w), height(h) {
  auto make = [&](bool wanted, auto& plane) {
    if (wanted) plane = std::decay_t<decltype(plane)>(w, h);
  };
  make(planes.depth, depth);
  for (int c = 0; c < 3; ++c) {
    make(planes.normal, normal[c]);
    make(planes.facet, facet[c]);
    make(planes.albedo, albedo[c]);
    make(planes.emissive, emissive[c]);
    make(planes.position, position[c]);
  }
  make(planes.metallic, metallic);
  make(planes.roughness, roughness);
  make(planes.triangle, triangle);
  make(planes.instance, instance);
  make(planes.material, material);
  make(planes.depth2, depth2);
  make(planes.depthBack, depthBack);
  make(planes.relief, heightMap);
  for (Plane<float>& plane : relief) make(planes.relief, plane);
}

bool GBuffer::has(const PlaneSet& planes) const {
  return planes.depth != depth.empty() && planes.normal != normal[0].empty() && planes.facet != facet[0].empty() && planes.albedo != albedo[0].empty() &&
         planes.emissive != emissive[0].empty() && planes.position != position[0].empty() &&
         planes.metallic != metallic.empty() && planes.roughness != roughness.empty() &&
         planes.triangle != triangle.empty() && planes.instance != instance.empty() &&
         planes.material != material.empty() && planes.depth2 != depth2.empty() && planes.depthBack != depthBack.empty() &&
         planes.relief != heightMap.empty();
}

void cutOut(const GBuffer& from, const Window& part, GBuffer& to) {
  to.width = part.width;
  to.height = part.height;
  cutOut(from.depth, part, to.depth);
  for (int c = 0; c < 3; ++c) {
    cutOut(from.normal[c], part, to.normal[c]);
    cutOut(from.facet[c], part, to.facet[c]);
    cutOut(from.albedo[c], part, to.albedo[c]);
    cutOut(from.emissive[c], part, to.emissive[c]);
    cutOut(from.position[c], part, to.position[c]);
  }
  cutOut(from.metallic, part, to.metallic);
  cutOut(from.roughness, part, to.roughness);
  cutOut(from.triangle, part, to.triangle);
  cutOut(from.instance, part, to.instance);
  cutOut(from.material, part, to.material);
  cutOut(from.depth2, part, to.depth2);
  cutOut(from.depthBack, part, to.depthBack);
  cutOut(from.heightMap, part, to.heightMap);
  for (int k = 0; k < 12; ++k) cutOut(from.relief[k], part, to.relief[k]);
}

}  // namespace obscura::raster
