#include "obscura/apps/irradiance_rows.h"

#include <stdexcept>

#include "obscura/apps/error_output.h"
#include "obscura/apps/painted_scene.h"

namespace obscura::apps {
namespace {

using Planes = std::vector<raster::Plane<float>>;  // R, G, B, or one for all of them

engine::Frame rendered(const engine::Scene& scene, const engine::FrameSettings& settings, engine::Renderer& renderer) {
  engine::Frame frame;
  if (const auto done = renderer.render(scene, settings, frame); !done) throw std::runtime_error(done.error().text());
  return frame;
}

// What a white, matt surface sends out of the environment's light.
Planes coefficientsLight(const TracedFrame& traced, engine::Renderer& renderer) {
  engine::Scene white = traced.scene;
  paint(white, glm::vec3(1));
  engine::FrameSettings settings = traced.resolved.frame;
  settings.aovs = {engine::Aov::Color};
  settings.brdf = post::Brdf::Lambert;
  settings.ambient = post::Occlusion::None;
  engine::Frame frame = rendered(white, settings, renderer);
  Planes out;
  for (raster::Plane<float>& plane : frame.color.rgb) out.push_back(std::move(plane));
  return out;
}

PlaneRefs threeFrom(const Truth& truth, TruthQuantity red) {
  const raster::Plane<float>* first = &truth.value[size_t(red)];
  return {first, first + 1, first + 2};
}

PlaneRefs refsOf(const Planes& planes) {
  PlaneRefs out;
  for (const auto& p : planes) out.push_back(&p);
  return out;
}

Planes product(const PlaneRefs& light, const PlaneRefs& factor, const raster::Plane<uint8_t>& seen) {
  Planes out;
  for (size_t c = 0; c < 3; ++c) {
    raster::Plane<float>& to = out.emplace_back(seen.width(), seen.height());
    for (int y = 0; y < seen.height(); ++y)
      for (int x = 0; x < seen.width(); ++x) {
        const float by = factor.empty() ? 1 : factor[std::min(c, factor.size() - 1)]->at(x, y);
        to.at(x, y) = seen.at(x, y) ? light[c]->at(x, y) * by : 0;
      }
  }
  return out;
}

double meanOver(const PlaneRefs& planes, const raster::Plane<uint8_t>& seen) {
  double sum = 0, n = 0;
  for (const auto* p : planes)
    for (int y = 0; y < seen.height(); ++y)
      for (int x = 0; x < seen.width(); ++x)
        if (seen.at(x, y)) sum += p->at(x, y), ++n;
  return n > 0 ? sum / n : 0;
}

}  // namespace

std::vector<IrradianceRow> irradianceRows() {
  using Q = TruthQuantity;
  std::vector<IrradianceRow> rows;
  const auto add = [&](LightSource light, LightFactor factor, bool traced, Q truth) { rows.push_back({light, factor, traced, truth, 0, {}}); };
  add(LightSource::Coefficients, LightFactor::One, true, Q::OpenR);
  for (const bool traced : {true, false})
    for (const LightSource light : {LightSource::Rays, LightSource::Coefficients}) add(light, LightFactor::Obscurance, traced, Q::ObscuredR);
  for (const bool traced : {true, false})
    for (const LightSource light : {LightSource::Rays, LightSource::Coefficients}) add(light, LightFactor::Transfer, traced, Q::LitR);
  for (const LightFactor factor : {LightFactor::One, LightFactor::Mu, LightFactor::Obscurance}) add(LightSource::Rays, factor, true, Q::ShadowedR);
  for (const LightFactor factor : {LightFactor::One, LightFactor::Obscurance}) add(LightSource::Coefficients, factor, false, Q::ShadowedR);
  return rows;
}

void measureIrradiance(const TracedFrame& traced, const Truth& truth, const raster::Plane<uint8_t>& seen,
                       std::vector<IrradianceRow>& rows, std::optional<size_t> map, engine::Image& image) {
  raster::Parallel parallel(traced.resolved.raster.threads);
  engine::Renderer renderer(traced.resolved.raster);
  const Planes coefficients = coefficientsLight(traced, renderer);
  engine::FrameSettings settings = traced.resolved.frame;
  settings.brdf = post::Brdf::Lambert;
  settings.aovs = {engine::Aov::Obscurance, engine::Aov::Transfer};
  const engine::Frame estimate = rendered(traced.scene, settings, renderer);

  for (size_t i = 0; i < rows.size(); ++i) {
    IrradianceRow& row = rows[i];
    const TruthQuantity byRays = row.factor == LightFactor::Mu ? TruthQuantity::ObscuredR : TruthQuantity::OpenR;
    const PlaneRefs light = row.light == LightSource::Rays ? threeFrom(truth, byRays) : refsOf(coefficients);
    PlaneRefs factor;
    if (row.factor == LightFactor::Obscurance)
      factor = {row.traced ? &truth.value[size_t(settings.transfer.membership)] : &estimate.transfer.obscurance};
    if (row.factor == LightFactor::Transfer)
      factor = row.traced ? threeFrom(truth, TruthQuantity::TransferR)
                          : PlaneRefs{&estimate.transfer.w[0], &estimate.transfer.w[1], &estimate.transfer.w[2]};
    const PlaneRefs exact = threeFrom(truth, row.truth);
    const ErrorMeter meter(exact, seen, parallel);
    const Planes value = product(light, factor, seen);
    row.mean = meanOver(exact, seen);
    row.error = meter.measure(refsOf(value));
    if (map == i) image = meter.map(refsOf(value), kMapScale * (row.mean > 0 ? row.mean : 1));
  }
}

}  // namespace obscura::apps
