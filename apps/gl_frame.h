// In:  a scene, a camera, settings.
// Out: the frame as somebody without a graphics card would have it otherwise: G-buffer, ambient transfer and depth filter as
//      shaders, on OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "obscura/apps/gl.h"
#include "obscura/engine/frame.h"

namespace obscura::apps {

struct GlTimings {
  double gbuffer = 0, transfer = 0, filter = 0;  // ms; the filter makes the picture, too
};

// The same as engine::Renderer with La = 1 and these settings: perspective camera, Estimator::Paper, one step, one layer,
// TransferAlbedo::Neighbour, interleaved, FilterGuide::Depth. Of materials base colour, its texture, alpha masks and sides.
// Differs: the albedo has 8 bits, the sums 16.
class GlFrame {
 public:
  // Throws std::runtime_error where OpenGL refuses something. The scene need not outlive it.
  GlFrame(Gl gl, const engine::Scene& scene, const engine::FrameSettings& settings);
  GlTimings render();
  std::string renderer() const;
  // The picture, linear, 8 bits a channel, top row first, RGBA.
  std::vector<uint8_t> pixels();

 private:
  struct Draw {
    unsigned vertexArray, texture;  // texture: 0 none
    int indices;
    bool culled, mirrored;
    std::array<float, 16> viewFromObject;
    std::array<float, 9> viewFromNormal;
    float baseColor[4], uvRows[6], cutoff;
  };

  unsigned program(const std::string& vertex, const std::string& fragment);
  unsigned target(unsigned internal, unsigned format, unsigned type);
  void attach(unsigned framebuffer, const std::vector<unsigned>& colors, unsigned depth);
  void upload(const engine::Scene& scene, const engine::FrameSettings& settings);
  void setUniforms(const engine::FrameSettings& settings);
  void bind(int unit, unsigned texture);
  void setDraw(const Draw& draw);

  Gl gl_;
  int width_, height_;
  std::vector<Draw> draws_;
  unsigned geometry_ = 0, transfer_ = 0, filter_ = 0;  // programs
  unsigned surface_ = 0, albedo_ = 0, sums_ = 0, picture_ = 0, noVertices_ = 0, framebuffers_[3] = {};
};

}  // namespace obscura::apps
