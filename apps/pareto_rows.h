// The rows of obscura-bench pareto: which methods and settings there are, and what was measured of each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "obscura/apps/error_measures.h"
#include "obscura/apps/peer_methods.h"
#include "obscura/apps/setting_names.h"
#include "obscura/apps/truth.h"

namespace obscura::apps {

// Method: what a method of other people estimates, each its own (peer_methods.h).
enum class ParetoQuantity : uint8_t { Obscurance, Method, TransferOwn, TransferNeighbour };
constexpr int kParetoQuantities = 4;
inline const Names<ParetoQuantity> kParetoQuantityNames = {{"O", ParetoQuantity::Obscurance},
                                                           {"method", ParetoQuantity::Method},
                                                           {"W-own", ParetoQuantity::TransferOwn},
                                                           {"W-neighbour", ParetoQuantity::TransferNeighbour}};

struct ParetoRow {
  std::string method;  // an estimator's name, a peer's, or "embree"
  ParetoQuantity quantity = ParetoQuantity::Obscurance;
  post::AmbientSettings settings;  // embree: samples are rays
  std::optional<PeerSettings> peer;

  // Measured.
  std::vector<double> transferMs, filterMs;  // one per frame
  std::string digest;
  ErrorMeasures error;
  bool front = false;  // no row of the same truth is both faster and nearer

  bool embree() const { return method == "embree"; }
  std::string filter() const { return settings.filter ? nameOf(kFilterGuideNames, settings.filterGuide) : "off"; }
  bool transfer() const { return quantity == ParetoQuantity::TransferOwn || quantity == ParetoQuantity::TransferNeighbour; }
  int steps() const { return peer ? peer->steps : settings.steps; }
  std::string truth() const;  // what it is compared with: "O linear", "W linear", a plane of the truth
  double ms() const;          // median of transfer + filter
};

// What is swept; every combination that makes sense is a row. Line samples are of the linear membership alone and know no
// steps; ssao and vao have none, either. Peers have rows for what they aim at, and, where the membership is linear, for O.
struct ParetoSweep {
  std::vector<int> samples = {1, 2, 4, 8, 16, 32}, steps = {1}, rays = {1, 2, 4, 8, 16, 32, 64};
  std::vector<std::string> estimators = {"paper", "sobol", "box", "lines"};  // of kEstimatorNames
  std::vector<std::string> peers = {"ssao", "hbao", "vao", "gtao"};          // of kPeerMethodNames
  std::vector<int> peerSteps = {4};
  std::vector<std::string> filters = {"off", "depth", "plane"};
  std::vector<std::string> interleave = {"on"}, silhouetteBound = {"on"};
  std::vector<int> layers = {1};
  std::vector<std::string> quantities = {"O", "method", "W-own", "W-neighbour"};
};

// base: lengths, membership and what is not swept.
std::vector<ParetoRow> rowsOf(const ParetoSweep& sweep, const post::AmbientSettings& base);

// Marks the rows that no other of the same truth beats in both time and RMSE.
void markFront(std::vector<ParetoRow>& rows);

// The planes of the truth that a row aims at.
PlaneRefs truthPlanesOf(const ParetoRow& row, const Truth& truth);

}  // namespace obscura::apps
