#include "obscura/apps/truth_planes.h"

#include <algorithm>
#include <cmath>

#include "obscura/engine/plane_image.h"

namespace obscura::apps {
namespace {

using engine::Error;
using engine::ErrorCode;
using Planes = raster::Plane<float>;

engine::Layer layerOf(const TruthPlane& plane, const std::vector<Planes>& planes, const std::string& suffix) {
  const Planes& first = planes[size_t(plane.quantities[0])];
  const bool rgb = plane.quantities.size() == 3;
  std::vector<std::string> channels = {"Y"};
  if (rgb) channels = {"R", "G", "B"};
  return {plane.name + suffix, channels, rgb ? engine::interleave({&first, &first + 1, &first + 2}) : engine::interleave({&first})};
}

}  // namespace

const std::vector<TruthPlane>& truthPlanes() {
  using Q = TruthQuantity;
  static const std::vector<TruthPlane> planes = {{"classic", {Q::Classic}},
                                                 {"linear", {Q::Linear}},
                                                 {"sqrt", {Q::Sqrt}},
                                                 {"exponential", {Q::Exponential}},
                                                 {"tangent_sphere", {Q::TangentSphere}},
                                                 {"ball", {Q::Ball}},
                                                 {"horizon", {Q::Horizon}},
                                                 {"transfer", {Q::TransferR, Q::TransferG, Q::TransferB}},
                                                 {"bounce", {Q::BounceR, Q::BounceG, Q::BounceB}},
                                                 {"environment_open", {Q::OpenR, Q::OpenG, Q::OpenB}},
                                                 {"environment_shadowed", {Q::ShadowedR, Q::ShadowedG, Q::ShadowedB}},
                                                 {"environment_obscured", {Q::ObscuredR, Q::ObscuredG, Q::ObscuredB}},
                                                 {"environment_lit", {Q::LitR, Q::LitG, Q::LitB}}};
  return planes;
}

bool has(const Truth& truth, const TruthPlane& plane) { return size_t(plane.quantities[0]) < truth.value.size(); }

engine::Result<std::vector<TruthFile>> planTruthFiles(const std::vector<std::string>& outputs, const std::vector<std::string>& names,
                                                      bool environment) {
  std::vector<const TruthPlane*> chosen;
  std::string known;
  const auto& planes = truthPlanes();
  const auto end = environment ? planes.end() : std::find_if(planes.begin(), planes.end(), [](const TruthPlane& p) {
    return int(p.quantities[0]) >= kTruthQuantities;
  });
  for (auto p = planes.begin(); p != end; ++p) known += std::string(p->name) + ", ";
  for (const std::string& name : names) {
    const size_t before = chosen.size();
    for (auto p = planes.begin(); p != end; ++p)
      if ((name == "all" || name == p->name) && std::find(chosen.begin(), chosen.end(), &*p) == chosen.end()) chosen.push_back(&*p);
    const bool there = name == "all" || std::any_of(chosen.begin(), chosen.end(), [&](auto* p) { return name == p->name; });
    if (chosen.size() == before && !there) return Error{ErrorCode::Usage, "no plane \"" + name + "\"; there are " + known + "all" + (environment ? "" : ", and more with --environment"), "", ""};
  }
  std::vector<TruthFile> files;
  for (const std::string& path : outputs) {
    const auto format = engine::fileFormatOf(path);
    using engine::FileFormat;
    if (!format || (*format != FileFormat::Exr && *format != FileFormat::Npy && *format != FileFormat::Pfm))
      return Error{ErrorCode::Usage, "a truth is written as .exr, .npy or .pfm", path, ""};
    files.push_back({path, *format, chosen});
  }
  return files;
}

engine::Result<engine::Done> writeTruthFile(const TruthFile& file, const Truth& truth, const engine::Frame& frame) {
  std::vector<engine::Layer> layers;
  for (const TruthPlane* p : file.planes) {
    layers.push_back(layerOf(*p, truth.value, ""));
    layers.push_back(layerOf(*p, truth.error, "_error"));
  }
  const auto write = [&](const std::string& path, const std::vector<engine::Layer>& content) -> engine::Result<engine::Done> {
    const auto bytes = engine::encodeImage(file.format, content, path, {frame.x, frame.y, frame.imageWidth, frame.imageHeight});
    if (!bytes) return Error{ErrorCode::CannotWrite, bytes.error().message, path, ""};
    return engine::writeFileAtomically(path, {bytes->data(), bytes->size()});
  };
  if (engine::holdsLayers(file.format)) return write(file.path, layers);
  const size_t dot = file.path.rfind('.');
  for (const engine::Layer& layer : layers)
    if (const auto done = write(file.path.substr(0, dot) + "." + layer.name + file.path.substr(dot), {layer}); !done) return done;
  return engine::Done{};
}

TruthSummary summaryOf(const TruthPlane& plane, const Truth& truth, const engine::Frame& frame) {
  TruthSummary s;
  double count = 0, squares = 0;
  for (const TruthQuantity q : plane.quantities)
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) {
        if (frame.g.instance.at(x, y) == raster::kNoTriangle) continue;
        const double e = truth.error[size_t(q)].at(x, y);
        ++count;
        s.mean += truth[q].at(x, y);
        squares += e * e;
        s.maxError = std::max(s.maxError, e);
      }
  s.mean /= std::max(count, 1.0);
  s.rmsError = std::sqrt(squares / std::max(count, 1.0));
  return s;
}

}  // namespace obscura::apps
