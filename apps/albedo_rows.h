// The rows of obscura-bench albedo: which W are compared with the recursive one, for which albedo, and how they are found.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "obscura/apps/error_measures.h"
#include "obscura/apps/scene_truth.h"
#include "obscura/apps/setting_names.h"

namespace obscura::apps {

// What takes the place of the recursive W, the long paper's equation 4; B is TruthQuantity::Bounce.
enum class TransferModel : uint8_t {
  Obscurance,  // O: nothing comes back from what occludes
  Own,         // O / (1 - a (1 - O)), a the pixel's own albedo: the short paper's equation 4
  Neighbour,   // O / (1 - B): equation 6
  Radiance     // O + B: section 4.1, as if all of La reached what occludes, and nothing came back to it
};
inline const Names<TransferModel> kTransferModelNames = {{"O", TransferModel::Obscurance},
                                                         {"own", TransferModel::Own},
                                                         {"neighbour", TransferModel::Neighbour},
                                                         {"radiance", TransferModel::Radiance}};

struct AlbedoRow {
  size_t albedo = 0;  // of the list
  bool traced = false;  // O and B by the truth's rays, so that the model alone errs; else by the depth map, as in a frame
  TransferModel model = TransferModel::Obscurance;
  ErrorMeasures error;
  bool nearest = false;  // no other of the same albedo and source has an RMSE that is smaller by 10^-5
};

// For each albedo every model, by rays and then by the depth map.
std::vector<AlbedoRow> albedoRows(size_t albedos);
void markNearest(std::vector<AlbedoRow>& rows);

constexpr char kSceneAlbedo[] = "scene";  // its own colours

// "scene", or a number from 0 to 1 that every surface has. Empty: neither.
struct Albedo {
  std::string name;
  std::optional<float> value;
};
std::optional<Albedo> albedoOf(const std::string& text);

// W has no channel that depends on another one: three grey worlds are traced as one, in red, green and blue.
struct AlbedoPass {
  std::optional<glm::vec3> paint;  // empty: the scene's own colours
  struct Part {
    size_t albedo;
    std::vector<size_t> channels;
  };
  std::vector<Part> parts;
};
std::vector<AlbedoPass> albedoPasses(const std::vector<Albedo>& albedos);

using TransferPlanes = std::vector<raster::Plane<float>>;  // R, G, B, or one for all of them

// From the rays' O and B and the albedo of the G-buffer. 0 / 0 is 1, as in the closed white room. Where empty: 1.
TransferPlanes tracedTransfer(TransferModel model, const Truth& truth, const TracedFrame& traced);

// By the estimator that the frame's settings name. Throws std::runtime_error.
TransferPlanes estimatedTransfer(TransferModel model, const TracedFrame& traced, engine::Renderer& renderer);

}  // namespace obscura::apps
