// In:  scene, camera, settings, and which AOVs are wanted.
// Out: the frame: every plane that these need, and nothing else.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/engine/aov.h"
#include "obscura/engine/environment.h"
#include "obscura/engine/result.h"
#include "obscura/engine/scene.h"
#include "obscura/post/depth_filter.h"
#include "obscura/post/display.h"
#include "obscura/post/light.h"
#include "obscura/post/tone_map.h"
#include "obscura/raster/rasterizer.h"

namespace obscura::engine {

constexpr float kMostExposure = 0x1p64f;
constexpr int kMostShadowSize = 8192;

struct FrameSettings {
  int width = 800, height = 600;  // pixels, 1 ... raster::kMaxImageSize
  int supersample = 1;            // 1, 2 or 4 sub-pixels a side of a pixel; times width or height up to that size, too
  raster::Camera camera;
  // Pixels more on every side that are rasterized and that the transfer and its filter see, but that are not given: what
  // lies just off screen occludes, too. 0 or more; image and borders are at most raster::kMaxImageSize a side.
  int border = 0;
  // The part of the image that is wanted, inside of it. Changes no bit: its pixels are those of the whole frame with the
  // same border.
  std::optional<raster::Window> crop;
  post::Brdf brdf = post::Brdf::Gltf;
  post::Occlusion ambient = post::Occlusion::Transfer;
  post::AmbientSettings transfer;
  // La, linear: of what belongs to no node group of its own (Instance::ambient), and factors on it and light besides it by
  // the direction of the normal, see post::AmbientLight, whose directions are here the world's. At most kMostClasses.
  glm::vec3 ambientLight{1};
  std::vector<post::AmbientDirection> ambientDirections;
  // In place of ambientLight; node groups of their own keep theirs, and directions are factors on it, too. If it has reflections,
  // they are the specular light of a glossy BRDF, without those factors.
  std::shared_ptr<const Environment> environment;
  double environmentRotation = 0;   // degrees around +y of the world, counter-clockwise seen from above
  double environmentIntensity = 1;  // a factor on it, 0 ... 10^6
  // Direct lights, see post/direct_light.h: those of the scene, and others.
  bool sceneLights = true;
  std::vector<SceneLight> lights;
  bool shadows = true;    // of lights that have them; only what lies in Scene::bounds casts any
  int shadowSize = 2048;  // texels a side of a shadow map, 16 ... kMostShadowSize
  glm::vec3 background{0};        // linear
  bool environmentBackground = false;  // the environment instead, which has a cube then
  post::ToneSettings tone;             // of the displayed picture alone
  std::vector<Aov> aovs = {Aov::Color};
  bool display = false;           // also the picture as sRGB bytes
  bool displacement = true;       // false: materials are flat, whatever height map they have
  float separation = 0.01f;       // of Aov::Depth2, scene units, see raster::GBuffer
};

// What direct lights needed.
struct LightStatistics {
  uint64_t lights = 0, unseen = 0;  // unseen: of those with shadows, what reaches no pixel
  uint64_t shadowMaps = 0;          // rendered
};

struct FrameTimings {  // milliseconds; 0 for what was not needed
  double gbuffer = 0, shadows = 0, direct = 0, transfer = 0, filter = 0, light = 0, downsample = 0, display = 0, frame = 0;
};

// Planes that no AOV needed are empty; O and W that are needed for the colour alone are those of open pixels where they
// cannot be seen in it, as on unlit things and, with Brdf::Lambert, on black ones. With supersampling only planes that are AOVs themselves are there; how they come
// from the sub-pixels: downsample_frame.h. The statistics are those of the sub-pixels' image.
// With TransferAlbedo::Radiance the radiance is the emission, the ambient light R_A La, and what is reflected of direct lights.
struct Frame {
  int width = 0, height = 0;            // of the planes: the crop's, or the image's
  int x = 0, y = 0;                     // where their pixel (0, 0) lies in the image
  int imageWidth = 0, imageHeight = 0;
  raster::GBuffer g;
  post::Transfer transfer;
  post::LinearColor color;
  post::LinearColor shown;              // the colour as it is displayed, where the tone settings change it
  post::DisplayImage display;
  raster::Statistics statistics;
  post::TransferStatistics transferStatistics;  // 0 where the transfer was not needed or the reference made it
  LightStatistics lightStatistics;
  FrameTimings timings;
};

// Draws scenes. Keeps scratch memory between frames; one thread at a time, any number of renderers at once.
class Renderer {
 public:
  // reference: all stages by their scalar twins, on one thread; slow, and the same bits.
  explicit Renderer(const raster::Settings& settings = {}, bool reference = false);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  // Usage: a setting is out of its range. BadInput: the scene is too large for memory.
  Result<Done> render(const Scene& scene, const FrameSettings& settings, Frame& frame);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace obscura::engine
