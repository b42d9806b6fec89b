// A harbour: boats at a quay with crates, barrels and a crane, warehouses behind, in the light of the sky.
#include "obscura/apps/figure_harbour_scene.h"
#include "obscura/apps/figure_sky.h"
#include "obscura/apps/figure_stage.h"

namespace obscura::apps {

FigureContent makeHarbourFigure(const FigureSettings& figure) {
  FigureStage stage(makeHarbourScene(), figure, 1.2);
  engine::FrameSettings& s = stage.settings;
  s.environment = makeSkyLight(figure);
  s.environmentBackground = true;
  s.environmentRotation = 70;
  s.tone.curve = post::ToneCurve::Neutral;
  s.tone.exposure = 1.6f;
  s.transfer.samples = 16;
  s.ambient = post::Occlusion::None;
  const engine::Frame alone = stage.render(s);
  s.ambient = post::Occlusion::Transfer;
  const engine::Frame byW = stage.render(s);
  FigureContent out;
  out.columns = 2;
  out.panels = {{"environment light alone", colorPicture(alone)},
                {"ambient transfer W", transferPicture(byW)},
                {"light x W", colorPicture(byW)},
                {"obscurance O", obscurancePicture(byW)}};
  const PixelTest seen = isSeen(byW);
  const PixelTest water = isNode(byW, stage.scene(), "water"), goods = isNode(byW, stage.scene(), "goods");
  out.numbers.columns = {"mean", "O", "W red", "W green", "W blue"};
  const auto row = [&](const char* name, const PixelTest& test) {
    out.numbers.rows.push_back({name, number(meanOf(byW.transfer.obscurance, test)), number(meanOf(byW.transfer.w[0], test)),
                                number(meanOf(byW.transfer.w[1], test)), number(meanOf(byW.transfer.w[2], test))});
  };
  row("all that is seen", seen);
  row("the water", water);
  row("crates and barrels", goods);
  const double open = meanOf(byW.transfer.w[1], water), stacked = meanOf(byW.transfer.w[1], goods);
  out.claims = {{"crates and barrels shade one another, the open water is nearly unshaded: W in green is " + number(stacked) + " and " + number(open),
                 stacked < open - 0.02 && open > 0.9}};
  return out;
}

}  // namespace obscura::apps
