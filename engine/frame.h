// In:  scene, camera, settings, and which AOVs are wanted.
// Out: the frame: every plane that these need, and nothing else.
#pragma once

#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/engine/aov.h"
#include "obscura/engine/result.h"
#include "obscura/engine/scene.h"
#include "obscura/post/depth_filter.h"
#include "obscura/post/display.h"
#include "obscura/post/light.h"
#include "obscura/raster/rasterizer.h"

namespace obscura::engine {

struct FrameSettings {
  int width = 800, height = 600;  // pixels, 1 ... raster::kMaxImageSize
  raster::Camera camera;
  post::Occlusion ambient = post::Occlusion::Transfer;
  post::AmbientSettings transfer;
  glm::vec3 ambientLight{1};      // La, linear
  glm::vec3 background{0};        // linear
  std::vector<Aov> aovs = {Aov::Color};
  bool display = false;           // also the picture as sRGB bytes
};

struct FrameTimings {  // milliseconds; 0 for what was not needed
  double gbuffer = 0, transfer = 0, filter = 0, light = 0, display = 0, frame = 0;
};

// Planes that no AOV needed are empty.
struct Frame {
  int width = 0, height = 0;
  raster::GBuffer g;
  post::Transfer transfer;
  post::LinearColor color;
  post::DisplayImage display;
  raster::Statistics statistics;
  post::TransferStatistics transferStatistics;  // 0 where the transfer was not needed or the reference made it
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
