#include "obscura/apps/albedo_rows.h"

#include <algorithm>
#include <stdexcept>

#include "obscura/apps/option_text.h"

namespace obscura::apps {

std::vector<AlbedoRow> albedoRows(size_t albedos) {
  std::vector<AlbedoRow> rows;
  for (size_t a = 0; a < albedos; ++a)
    for (const bool traced : {true, false})
      for (const auto& [name, model] : kTransferModelNames) rows.push_back({a, traced, model, {}, false});
  return rows;
}

void markNearest(std::vector<AlbedoRow>& rows) {
  for (AlbedoRow& row : rows)
    row.nearest = std::none_of(rows.begin(), rows.end(), [&](const AlbedoRow& other) {
      return other.albedo == row.albedo && other.traced == row.traced && other.error.rmse < row.error.rmse - 1e-5;
    });
}

std::optional<Albedo> albedoOf(const std::string& text) {
  if (text == kSceneAlbedo) return Albedo{text, std::nullopt};
  const std::optional<double> value = numberOf<double>(text);
  if (!value || !(*value >= 0 && *value <= 1)) return std::nullopt;
  return Albedo{text, float(*value)};
}

std::vector<AlbedoPass> albedoPasses(const std::vector<Albedo>& albedos) {
  std::vector<AlbedoPass> passes;
  AlbedoPass grey;
  const auto end = [&] {
    if (!grey.parts.empty()) passes.push_back(std::move(grey));
    grey = {};
  };
  for (size_t a = 0; a < albedos.size(); ++a) {
    if (!albedos[a].value) {
      passes.push_back({std::nullopt, {{a, {0, 1, 2}}}});
      continue;
    }
    const size_t channel = grey.parts.size();
    if (!grey.paint) grey.paint = glm::vec3(*albedos[a].value);
    for (size_t c = channel; c < 3; ++c) (*grey.paint)[int(c)] = *albedos[a].value;
    grey.parts.push_back({a, {channel}});
    if (grey.parts.size() == 3) end();
  }
  end();
  return passes;
}

TransferPlanes tracedTransfer(TransferModel model, const Truth& truth, const TracedFrame& traced) {
  const engine::Frame& frame = traced.frame;
  const raster::Plane<float>& o = truth.value[size_t(traced.resolved.frame.transfer.membership)];
  TransferPlanes out(3);
  for (size_t c = 0; c < 3; ++c) {
    out[c] = raster::Plane<float>(frame.width, frame.height);
    const raster::Plane<float>& bounce = truth.value[size_t(TruthQuantity::BounceR) + c];
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) {
        const double open = o.at(x, y), back = bounce.at(x, y);
        const auto recursive = [open](double returned) { return returned < 1 ? open / (1 - returned) : 1; };
        double w = open;
        if (model == TransferModel::Own) w = recursive(double(frame.g.albedo[c].at(x, y)) * (1 - open));
        if (model == TransferModel::Neighbour) w = recursive(back);
        if (model == TransferModel::Radiance) w = open + back;
        out[c].at(x, y) = float(w);
      }
  }
  return out;
}

TransferPlanes estimatedTransfer(TransferModel model, const TracedFrame& traced, engine::Renderer& renderer) {
  engine::FrameSettings settings = traced.resolved.frame;
  const bool obscurance = model == TransferModel::Obscurance;
  settings.aovs = {obscurance ? engine::Aov::Obscurance : engine::Aov::Transfer};
  settings.brdf = post::Brdf::Lambert;  // R_A is the albedo
  settings.sceneLights = false;
  settings.transfer.albedo = model == TransferModel::Neighbour  ? post::TransferAlbedo::Neighbour
                             : model == TransferModel::Radiance ? post::TransferAlbedo::Radiance
                                                                : post::TransferAlbedo::Own;
  engine::Frame frame;
  if (const auto done = renderer.render(traced.scene, settings, frame); !done) throw std::runtime_error(done.error().text());
  TransferPlanes out;
  if (obscurance) out.push_back(std::move(frame.transfer.obscurance));
  for (int c = 0; c < 3 && !obscurance; ++c) out.push_back(std::move(frame.transfer.w[c]));
  return out;
}

}  // namespace obscura::apps
