#include "obscura/apps/pareto_rows.h"

#include <algorithm>
#include <iterator>

#include "obscura/apps/bench_measure.h"
#include "obscura/apps/truth_planes.h"

namespace obscura::apps {
namespace {

template <class T>
T valueOf(const Names<T>& names, const std::string& name) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == name; });
  return found->second;  // the command line lets no other name through
}

TruthQuantity truthOfPeer(PeerMethod method) {
  switch (method) {
    case PeerMethod::Ssao: return TruthQuantity::Ball;
    case PeerMethod::Hbao: return TruthQuantity::Horizon;
    case PeerMethod::Vao: return TruthQuantity::TangentSphere;
    case PeerMethod::Gtao: break;
  }
  return TruthQuantity::Classic;
}

bool hasSteps(PeerMethod method) { return method == PeerMethod::Hbao || method == PeerMethod::Gtao; }

}  // namespace

std::string ParetoRow::truth() const {
  if (quantity == ParetoQuantity::Method) {
    for (const TruthPlane& plane : truthPlanes())
      if (plane.quantities[0] == truthOfPeer(peer->method)) return plane.name;
  }
  return (quantity == ParetoQuantity::Obscurance ? "O " : "W ") + nameOf(kMembershipNames, settings.membership);
}

double ParetoRow::ms() const {
  std::vector<double> sums;
  for (size_t k = 0; k < transferMs.size(); ++k) sums.push_back(transferMs[k] + filterMs[k]);
  return quantile(sums, 0.5);
}

namespace {

using Rows = std::vector<ParetoRow>;

// Each row once with every value.
template <class T, class Set>
void multiply(Rows& rows, const std::vector<T>& values, const Set& set) {
  Rows all;
  for (const ParetoRow& row : rows)
    for (const T& value : values) set(all.emplace_back(row), value);
  rows = std::move(all);
}

void setFilter(ParetoRow& row, const std::string& filter) {
  row.settings.filter = filter != "off";
  if (row.settings.filter) row.settings.filterGuide = valueOf(kFilterGuideNames, filter);
}

void setSamples(ParetoRow& row, int n) { row.settings.samples = n; }

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

Rows estimatorRows(const ParetoSweep& sweep, const ParetoRow& base) {
  Rows rows = {base};
  std::vector<std::string> quantities;
  std::remove_copy(sweep.quantities.begin(), sweep.quantities.end(), std::back_inserter(quantities), "method");
  multiply(rows, quantities, [](ParetoRow& row, const std::string& name) {
    row.quantity = valueOf(kParetoQuantityNames, name);
    if (row.quantity == ParetoQuantity::TransferNeighbour) row.settings.albedo = post::TransferAlbedo::Neighbour;
  });
  multiply(rows, sweep.estimators, [](ParetoRow& row, const std::string& name) {
    row.method = name;
    row.settings.estimator = valueOf(kEstimatorNames, name);
  });
  multiply(rows, sweep.layers, [](ParetoRow& row, int layers) { row.settings.layers = layers; });
  multiply(rows, sweep.silhouetteBound, [](ParetoRow& row, const std::string& on) { row.settings.silhouetteBound = on == "on"; });
  multiply(rows, sweep.interleave, [](ParetoRow& row, const std::string& on) { row.settings.interleave = on == "on"; });
  multiply(rows, sweep.filters, setFilter);
  multiply(rows, sweep.steps, [](ParetoRow& row, int steps) { row.settings.steps = steps; });
  multiply(rows, sweep.samples, setSamples);
  rows.erase(std::remove_if(rows.begin(), rows.end(), [&](const ParetoRow& row) {
    if (row.settings.estimator != post::Estimator::Lines) return false;
    return row.settings.membership != post::Membership::Linear || row.settings.steps != sweep.steps.front();
  }), rows.end());
  return rows;
}

Rows peerRows(const ParetoSweep& sweep, const ParetoRow& base) {
  Rows rows = {base};
  std::vector<std::string> quantities;
  for (const char* name : {"O", "method"})
    if (contains(sweep.quantities, name) && (base.settings.membership == post::Membership::Linear || name[0] != 'O'))
      quantities.push_back(name);
  multiply(rows, quantities, [](ParetoRow& row, const std::string& name) { row.quantity = valueOf(kParetoQuantityNames, name); });
  multiply(rows, sweep.peers, [](ParetoRow& row, const std::string& name) {
    row.method = name;
    row.peer = PeerSettings{valueOf(kPeerMethodNames, name), row.quantity == ParetoQuantity::Method ? PeerAim::Own : PeerAim::Obscurance};
  });
  multiply(rows, sweep.interleave, [](ParetoRow& row, const std::string& on) { row.settings.interleave = on == "on"; });
  multiply(rows, sweep.filters, setFilter);
  multiply(rows, sweep.peerSteps, [](ParetoRow& row, int steps) { row.peer->steps = steps; });
  multiply(rows, sweep.samples, setSamples);
  rows.erase(std::remove_if(rows.begin(), rows.end(), [&](const ParetoRow& row) {
    return !hasSteps(row.peer->method) && row.peer->steps != sweep.peerSteps.front();
  }), rows.end());
  for (ParetoRow& row : rows)
    if (!hasSteps(row.peer->method)) row.peer->steps = 1;
  return rows;
}

}  // namespace

Rows rowsOf(const ParetoSweep& sweep, const post::AmbientSettings& settings) {
  ParetoRow base;
  base.settings = settings;
  base.settings.albedo = post::TransferAlbedo::Own;
  Rows rows = estimatorRows(sweep, base);
  for (ParetoRow& row : peerRows(sweep, base)) rows.push_back(std::move(row));
  if (!contains(sweep.quantities, "O")) return rows;
  Rows embree = {base};
  embree[0].method = "embree";
  multiply(embree, sweep.filters, setFilter);
  multiply(embree, sweep.rays, setSamples);
  for (ParetoRow& row : embree) rows.push_back(std::move(row));
  return rows;
}

void markFront(std::vector<ParetoRow>& rows) {
  for (ParetoRow& row : rows)
    row.front = std::none_of(rows.begin(), rows.end(), [&](const ParetoRow& other) {
      const bool noWorse = other.ms() <= row.ms() && other.error.rmse <= row.error.rmse;
      return other.truth() == row.truth() && noWorse && (other.ms() < row.ms() || other.error.rmse < row.error.rmse);
    });
}

PlaneRefs truthPlanesOf(const ParetoRow& row, const Truth& truth) {
  if (row.quantity == ParetoQuantity::Method) return {&truth[truthOfPeer(row.peer->method)]};
  if (row.quantity == ParetoQuantity::Obscurance) return {&truth.value[size_t(row.settings.membership)]};
  const raster::Plane<float>* red = &truth[TruthQuantity::TransferR];
  return {red, red + 1, red + 2};
}

}  // namespace obscura::apps
