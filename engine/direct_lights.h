// In:  a scene's lights and what casts shadows, the G-buffer of a frame.
// Out: what the surfaces reflect of them, linear colour.
#pragma once

#include <optional>
#include <vector>

#include "obscura/engine/frame.h"
#include "obscura/engine/shadow_maps.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {

// The frame has direct lights; shadow maps are looked into.
bool hasLights(const Scene& scene, const FrameSettings& settings);
bool hasShadows(const Scene& scene, const FrameSettings& settings);
// Null, or what is wrong with one of them.
const char* wrongLights(const Scene& scene, const FrameSettings& settings);

// Keeps the memory of the maps. Lights add to the result in their order, and few maps are there at a time, so the memory
// that many lights need is limited.
class DirectLights {
 public:
  struct Input {
    const Scene& scene;
    const FrameSettings& settings;
    const raster::DrawList& list;         // of the scene
    const raster::GBuffer& g;             // depth, normal, albedo, metallic and roughness of a glossy BRDF, and facet if hasShadows()
    post::Projector projector;            // of g
    int firstRow, endRow;                 // of g: what is wanted
    const raster::Plane<float>& whole;    // depth of the image and its border, if there are directional lights with shadows,
    post::Projector wholeProjector;       // which is the same for all crops
    bool reference, skip;
    raster::Target target;
  };
  LightStatistics draw(const Input& in, raster::Rasterizer& rasterizer, raster::Parallel& parallel, post::LinearColor& out,
                       FrameTimings& timings);

 private:
  std::vector<raster::Plane<float>> maps_;
  std::vector<raster::Material> casting_;
};

}  // namespace obscura::engine
