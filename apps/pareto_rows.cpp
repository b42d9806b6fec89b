#include "obscura/apps/pareto_rows.h"

#include <algorithm>

#include "obscura/apps/bench_measure.h"

namespace obscura::apps {
namespace {

template <class T>
T valueOf(const Names<T>& names, const std::string& name) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == name; });
  return found->second;  // the command line lets no other name through
}

}  // namespace

std::string ParetoRow::truth() const {
  return (quantity == ParetoQuantity::Obscurance ? "O " : "W ") + nameOf(kMembershipNames, settings.membership);
}

double ParetoRow::ms() const {
  std::vector<double> sums;
  for (size_t k = 0; k < transferMs.size(); ++k) sums.push_back(transferMs[k] + filterMs[k]);
  return quantile(sums, 0.5);
}

std::vector<ParetoRow> rowsOf(const ParetoSweep& sweep, const post::AmbientSettings& base) {
  std::vector<ParetoRow> rows;
  const auto withFilter = [](post::AmbientSettings s, const std::string& filter) {
    s.filter = filter != "off";
    if (s.filter) s.filterGuide = valueOf(kFilterGuideNames, filter);
    return s;
  };
  for (const std::string& quantity : sweep.quantities)
    for (const std::string& estimator : sweep.estimators)
      for (const std::string& interleave : sweep.interleave)
        for (const std::string& filter : sweep.filters)
          for (const int steps : sweep.steps)
            for (const int n : sweep.samples) {
              const bool lines = valueOf(kEstimatorNames, estimator) == post::Estimator::Lines;
              if (lines && (base.membership != post::Membership::Linear || steps != sweep.steps.front())) continue;
              ParetoRow row;
              row.method = estimator;
              row.quantity = valueOf(kParetoQuantityNames, quantity);
              row.settings = withFilter(base, filter);
              row.settings.estimator = valueOf(kEstimatorNames, estimator);
              row.settings.interleave = interleave == "on";
              row.settings.steps = steps;
              row.settings.samples = n;
              row.settings.albedo = row.quantity == ParetoQuantity::TransferNeighbour ? post::TransferAlbedo::Neighbour
                                                                                      : post::TransferAlbedo::Own;
              rows.push_back(row);
            }
  if (std::find(sweep.quantities.begin(), sweep.quantities.end(), "O") == sweep.quantities.end()) return rows;
  for (const std::string& filter : sweep.filters)
    for (const int n : sweep.rays) {
      ParetoRow row;
      row.method = "embree";
      row.settings = withFilter(base, filter);
      row.settings.samples = n;
      row.settings.albedo = post::TransferAlbedo::Own;
      rows.push_back(row);
    }
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
  if (row.quantity == ParetoQuantity::Obscurance) return {&truth.value[size_t(row.settings.membership)]};
  const raster::Plane<float>* red = &truth[TruthQuantity::TransferR];
  return {red, red + 1, red + 2};
}

}  // namespace obscura::apps
