// The rows of obscura-bench irradiance: an environment's diffuse light as frames have it, and what each ingredient errs by.
#pragma once

#include <string>
#include <vector>

#include "obscura/apps/error_measures.h"
#include "obscura/apps/scene_truth.h"
#include "obscura/apps/setting_names.h"

namespace obscura::apps {

// What arrives where nothing occludes: by rays (Open of environment_truth.h), or by nine coefficients as in a frame.
enum class LightSource : uint8_t { Rays, Coefficients };
// What it is multiplied by; Mu: nothing, as each direction is by its own mu (Obscured).
enum class LightFactor : uint8_t { One, Mu, Obscurance, Transfer };

inline const Names<LightSource> kLightSourceNames = {{"rays", LightSource::Rays}, {"nine", LightSource::Coefficients}};
inline const Names<LightFactor> kLightFactorNames = {
    {"1", LightFactor::One}, {"mu", LightFactor::Mu}, {"O", LightFactor::Obscurance}, {"W", LightFactor::Transfer}};
inline const Names<TruthQuantity> kLightTruthNames = {{"open", TruthQuantity::OpenR},
                                                      {"obscured", TruthQuantity::ObscuredR},
                                                      {"lit", TruthQuantity::LitR},
                                                      {"shadowed", TruthQuantity::ShadowedR}};

struct IrradianceRow {
  LightSource light = LightSource::Rays;
  LightFactor factor = LightFactor::One;
  bool traced = true;  // O and W by the truth's rays; else by the depth map
  TruthQuantity truth = TruthQuantity::OpenR;
  double mean = 0;     // of the truth
  ErrorMeasures error;

  bool hasSource() const { return factor == LightFactor::Obscurance || factor == LightFactor::Transfer; }
  std::string source() const { return !hasSource() ? "" : traced ? "rays" : "depth map"; }
};

// Each against what it aims at; what is to be a shadow against real shadows, too.
std::vector<IrradianceRow> irradianceRows();

// Measures all of them. The scene has no lights (removeLights()), the frame an environment, the truth its planes. map: of this row,
// into `image`, with a quarter of the truth's mean in full colour. Throws std::runtime_error.
void measureIrradiance(const TracedFrame& traced, const Truth& truth, const raster::Plane<uint8_t>& seen,
                       std::vector<IrradianceRow>& rows, std::optional<size_t> map, engine::Image& image);

}  // namespace obscura::apps
