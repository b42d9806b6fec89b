// Membership functions: how strongly a direction counts as open, by the distance of what blocks it.
#include <cmath>

#include "obscura/apps/drawing.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/setting_names.h"
#include "obscura/post/transfer_samples.h"

namespace obscura::apps {

FigureContent makeMembershipFigure(const FigureSettings& settings) {
  constexpr int kSteps = 100;
  const struct {
    post::Membership membership;
    const char* title;
  } kKinds[] = {{post::Membership::Classic, "classic: mu = 0 for d < R"},
                {post::Membership::Linear, "linear: mu = d / R"},
                {post::Membership::Sqrt, "square root: mu = sqrt(d / R)"},
                {post::Membership::Exponential, "exponential: 1 - exp(-t d)"}};
  FigureContent out;
  out.columns = 2;
  out.numbers.columns = {"d / R"};
  bool atEnds = true, grows = true, inverts = true;
  for (const auto& kind : kKinds) {
    out.numbers.columns.push_back(nameOf(kMembershipNames, kind.membership));
    std::vector<std::pair<double, double>> curve;  // d / R, mu
    for (int i = 0; i <= kSteps * 5 / 4; ++i) {
      const double d = double(i) / kSteps, mu = post::membershipOf(kind.membership, d);
      if (!curve.empty()) grows &= mu >= curve.back().second;
      // A step is drawn upright.
      if (!curve.empty() && mu - curve.back().second > 0.5) curve.emplace_back(d, curve.back().second);
      curve.emplace_back(d, mu);
      if (mu > 0 && mu < 1) inverts &= std::fabs(post::inverseMembership(kind.membership, mu) - d) < 1e-9;
    }
    atEnds &= curve.front().second == 0 && post::membershipOf(kind.membership, 1) == 1;
    out.panels.push_back({kind.title, curvePicture(curve, {"R", "1", "d", "mu"}, settings.width, settings.height)});
  }
  for (int i = 0; i <= kSteps * 5 / 4; i += 5) {
    std::vector<std::string> row = {number(double(i) / kSteps)};
    for (const auto& kind : kKinds) row.push_back(number(post::membershipOf(kind.membership, double(i) / kSteps)));
    out.numbers.rows.push_back(std::move(row));
  }
  out.claims = {{"each is 0 at d = 0 and 1 from d = R on", atEnds},
                {"none of them falls anywhere", grows},
                {"the distance drawn for mu(d) is d: samples are spread as the derivative of mu", inverts}};
  return out;
}

}  // namespace obscura::apps
