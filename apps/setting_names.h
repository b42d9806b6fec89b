// What settings are called on command lines and in tables.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "obscura/engine/environment_projection.h"
#include "obscura/post/brdf.h"
#include "obscura/post/quality.h"
#include "obscura/post/settings.h"
#include "obscura/post/tone_map.h"

namespace obscura::apps {

template <class T>
using Names = std::vector<std::pair<std::string, T>>;

inline const Names<post::Membership> kMembershipNames = {{"classic", post::Membership::Classic},
                                                         {"linear", post::Membership::Linear},
                                                         {"sqrt", post::Membership::Sqrt},
                                                         {"exponential", post::Membership::Exponential}};
inline const Names<post::Estimator> kEstimatorNames = {
    {"paper", post::Estimator::Paper}, {"sobol", post::Estimator::Sobol}, {"box", post::Estimator::Box}, {"lines", post::Estimator::Lines},
    {"march", post::Estimator::March}};
inline const Names<post::Quality> kQualityNames = {{"draft", post::Quality::Draft},
                                                     {"standard", post::Quality::Standard},
                                                     {"high", post::Quality::High},
                                                     {"reference", post::Quality::Reference},
                                                     {"paper", post::Quality::Paper}};
inline const Names<post::FilterGuide> kFilterGuideNames = {{"depth", post::FilterGuide::Depth},
                                                           {"plane", post::FilterGuide::Plane}};

inline const Names<post::Brdf> kBrdfNames = {{"gltf", post::Brdf::Gltf},
                                             {"lambert", post::Brdf::Lambert},
                                             {"blinn-phong", post::Brdf::BlinnPhong},
                                             {"blinn-phong-thresholded", post::Brdf::BlinnPhongThresholded}};
inline const Names<post::ToneCurve> kToneCurveNames = {
    {"none", post::ToneCurve::None}, {"reinhard", post::ToneCurve::Reinhard}, {"neutral", post::ToneCurve::Neutral}};
inline const Names<engine::EnvironmentProjection> kProjectionNames = {{"latlong", engine::EnvironmentProjection::Latlong},
                                                                      {"sphere", engine::EnvironmentProjection::Sphere},
                                                                      {"cube", engine::EnvironmentProjection::Cube},
                                                                      {"paraboloid", engine::EnvironmentProjection::Paraboloid}};

// The first if the value has none.
template <class T>
const std::string& nameOf(const Names<T>& names, T value) {
  for (const auto& [name, v] : names)
    if (v == value) return name;
  return names.front().first;
}

}  // namespace obscura::apps
