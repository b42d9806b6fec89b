// The post process on a test scene, from G-buffer to display bytes.
#pragma once

#include <limits>
#include <optional>

#include "obscura/post/display.h"
#include "obscura/post/transfer_samples.h"
#include "test_scene.h"

namespace obscura::tests {

struct PostFrame {
  raster::GBuffer g;
  post::DepthBounds bounds;
  post::TransferStatistics statistics;
  post::LinearColor radiance;  // where the settings ask for that W: emission and ambient light reflected once
  post::TransferInput in;
  post::TransferSums sums;
  post::Transfer transfer;
  post::LinearColor color;
  post::DisplayImage display;
};

inline post::TransferInput transferInput(const raster::GBuffer& g, const raster::Camera& camera, const post::AmbientSettings& settings) {
  return {&g, post::makeProjector(camera, g.width, g.height), settings, post::transferSamples(settings)};
}

// The passes on frame.g, with frame.in.implicits and heights; `target` empty: by the scalar twins. skip: what is known to be
// open is not sampled. With stored radiance transfer.w is made of the bounced light.
inline void runPost(PostFrame& f, const raster::Camera& camera, const post::AmbientSettings& settings,
                    std::optional<raster::Target> target, post::Occlusion occlusion = post::Occlusion::Transfer,
                    bool skip = true, const post::AmbientLight& ambient = glm::vec3(0.9f, 1, 1.3f),
                    post::Brdf brdf = post::Brdf::Lambert) {
  const int h = f.g.height;
  const bool stored = settings.albedo == post::TransferAlbedo::Radiance;
  const post::DisplayTable table;
  const raster::Span<const raster::ImplicitDraw> implicits = f.in.implicits;
  const raster::Span<const raster::HeightView> heights = f.in.heights;
  f.in = transferInput(f.g, camera, settings);
  f.in.implicits = implicits;
  f.in.heights = heights;
  if (stored) {
    f.radiance = post::makeLinearColor(f.g.width, h);
    const post::LightInput first{&f.g, nullptr, post::Occlusion::None, ambient, glm::vec3(0), nullptr, brdf, f.in.projector};
    target ? post::light(first, 0, h, f.radiance, *target) : post::lightRef(first, 0, h, f.radiance);
    f.in.radiance = &f.radiance;
  }
  f.sums = post::makeTransferSums(f.in);
  f.transfer = post::makeTransfer(f.g.width, h, {true, true, stored});
  f.color = post::makeLinearColor(f.g.width, h);
  f.display = post::makeDisplayImage(f.g.width, h);
  const post::LightInput light{&f.g, &f.transfer, occlusion, ambient, glm::vec3(0.1f, 0.2f, 0.3f), nullptr, brdf, f.in.projector};
  if (target) {
    f.bounds = post::makeDepthBounds(f.g.width, h);
    post::boundDepth(f.g, f.in.projector, 0, f.bounds.c.height(), f.bounds, *target);
    if (skip) f.in.bounds = &f.bounds;
    f.statistics = post::ambientTransfer(f.in, 0, h, f.sums, *target);
    post::depthFilter(f.in, f.sums, 0, h, f.transfer, *target);
    if (stored) post::transferOfBounced(light, 0, h, f.transfer.w, *target);
    post::light(light, 0, h, f.color, *target);
    post::display(f.color, table, 0, h, f.display, *target);
  } else {
    post::ambientTransferRef(f.in, 0, h, f.sums);
    post::depthFilterRef(f.in, f.sums, 0, h, f.transfer);
    if (stored) post::transferOfBouncedRef(light, 0, h, f.transfer.w);
    post::lightRef(light, 0, h, f.color);
    post::displayRef(f.color, table, 0, h, f.display);
  }
}

inline raster::GBuffer gbufferOf(const TestScene& s) {
  raster::Rasterizer rasterizer;
  raster::GBuffer g;
  rasterizer.render(s.list(), s.camera, s.width, s.height, kAllLayers, g);
  return g;
}

// Whatever can be in one, and what cannot.
inline raster::GBuffer hostileGBuffer(uint32_t seed) {
  Random random(seed);
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const float odd[] = {0, -0.f, inf, -inf, nan, 1e30f, 1e-40f, -1, 3e38f};
  raster::GBuffer g(random.integer(1, 70), random.integer(1, 30), kAllLayers);
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      auto value = [&](float lo, float hi) { return random.integer(0, 9) ? random.real(lo, hi) : odd[random.integer(0, 8)]; };
      g.depth.at(x, y) = random.integer(0, 3) ? value(1, 3) : inf;
      g.metallic.at(x, y) = random.integer(0, 5) ? random.real(0, 1) : -0.0f;
      g.roughness.at(x, y) = random.integer(0, 5) ? random.real(0, 1) : float(random.integer(0, 1));
      g.depth2.at(x, y) = random.integer(0, 3) ? value(1, 4) : inf;
      for (int c = 0; c < 3; ++c) {
        g.normal[c].at(x, y) = value(-1, 1);
        g.albedo[c].at(x, y) = random.real(0, 1);
        g.emissive[c].at(x, y) = value(0, 2);
      }
    }
  return g;
}

inline std::string firstDifference(const PostFrame& a, const PostFrame& b) {
  std::string d = firstDifference("numerator", a.sums.numerator, b.sums.numerator);
  if (d.empty()) d = firstDifference("obscurance", a.transfer.obscurance, b.transfer.obscurance);
  for (int c = 0; c < 3 && d.empty(); ++c) {
    d = firstDifference("denominator", a.sums.denominator[c], b.sums.denominator[c]);
    if (d.empty()) d = firstDifference("transfer", a.transfer.w[c], b.transfer.w[c]);
    if (d.empty()) d = firstDifference("bounced", a.transfer.bounced[c], b.transfer.bounced[c]);
    if (d.empty()) d = firstDifference("color", a.color.rgb[c], b.color.rgb[c]);
  }
  return d.empty() ? firstDifference("display", a.display.rgba, b.display.rgba) : d;
}

}  // namespace obscura::tests
