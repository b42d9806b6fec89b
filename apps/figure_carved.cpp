// Environment light alone, times O, times W: a tree with stones, and a carved object.
#include "obscura/apps/demo_scene.h"
#include "obscura/apps/figure_scenes.h"
#include "obscura/apps/figure_sky.h"
#include "obscura/apps/figure_stage.h"

namespace obscura::apps {
namespace {

using engine::Frame;
using post::Occlusion;

struct Modulated {
  Frame alone, byO, byW;
};

// The same view in the light of the sky.
Modulated modulate(FigureStage& stage, const FigureSettings& figure) {
  engine::FrameSettings& s = stage.settings;
  s.environment = makeSkyLight(figure);
  s.environmentBackground = true;
  s.environmentRotation = 60;
  s.tone.exposure = 1.5f;
  s.tone.curve = post::ToneCurve::Neutral;
  Modulated out;
  const std::pair<Occlusion, Frame*> kinds[] = {{Occlusion::None, &out.alone}, {Occlusion::Obscurance, &out.byO}, {Occlusion::Transfer, &out.byW}};
  for (const auto& [occlusion, frame] : kinds) {
    s.ambient = occlusion;
    *frame = stage.render(s);
  }
  return out;
}

void addMeans(FigureContent& out, const Modulated& m) {
  out.numbers.columns = {"mean over the object", "red", "green", "blue"};
  const PixelTest seen = isSeen(m.byW);
  const auto add = [&](const char* name, const raster::Plane<float>* const (&planes)[3]) {
    out.numbers.rows.push_back({name, number(meanOf(*planes[0], seen)), number(meanOf(*planes[1], seen)), number(meanOf(*planes[2], seen))});
  };
  const raster::Plane<float>& o = m.byW.transfer.obscurance;
  add("albedo", {&m.byW.g.albedo[0], &m.byW.g.albedo[1], &m.byW.g.albedo[2]});
  add("O", {&o, &o, &o});
  add("W", {&m.byW.transfer.w[0], &m.byW.transfer.w[1], &m.byW.transfer.w[2]});
  add("environment light alone", {&m.alone.color.rgb[0], &m.alone.color.rgb[1], &m.alone.color.rgb[2]});
  add("light x O", {&m.byO.color.rgb[0], &m.byO.color.rgb[1], &m.byO.color.rgb[2]});
  add("light x W", {&m.byW.color.rgb[0], &m.byW.color.rgb[1], &m.byW.color.rgb[2]});
}

// W between O and 1 in every pixel.
bool liesBetween(const Frame& f) {
  const raster::Plane<float>& o = f.transfer.obscurance;
  for (const raster::Plane<float>& w : f.transfer.w)
    for (int y = 0; y < w.height(); ++y)
      for (int x = 0; x < w.width(); ++x)
        if (!(w.at(x, y) >= o.at(x, y) && w.at(x, y) <= 1)) return false;
  return true;
}

}  // namespace

FigureContent makeTreeFigure(const FigureSettings& figure) {
  FigureStage stage(makeDemoScene(), figure, 1.4);
  stage.settings.transfer.samples = 10;
  const Modulated m = modulate(stage, figure);
  FigureContent out;
  out.columns = 3;
  out.panels = {{"environment light alone", colorPicture(m.alone)}, {"obscurance O", obscurancePicture(m.byO)}, {"light x O", colorPicture(m.byO)}};
  addMeans(out, m);
  const double alone = meanOf(m.alone.color.rgb[1], isSeen(m.alone)), dimmed = meanOf(m.byO.color.rgb[1], isSeen(m.byO));
  out.claims = {{"O dims what is seen: its mean green falls from " + number(alone) + " to " + number(dimmed), dimmed < 0.95 * alone},
                {"O is never above 1, W never below O nor above 1", liesBetween(m.byW)}};
  return out;
}

FigureContent makeCarvedFigure(const FigureSettings& figure) {
  FigureStage stage(makeCarvedScene(), figure, 0.45);
  stage.settings.transfer.samples = 16;
  const Modulated m = modulate(stage, figure);
  FigureContent out;
  out.columns = 3;
  raster::Plane<float> back(figure.width, figure.height);
  for (int y = 0; y < figure.height; ++y)
    for (int x = 0; x < figure.width; ++x) back.at(x, y) = m.byW.transfer.w[0].at(x, y) - m.byW.transfer.obscurance.at(x, y);
  out.panels = {{"environment light alone", colorPicture(m.alone)},
                {"light x O", colorPicture(m.byO)},
                {"light x W", colorPicture(m.byW)},
                {"obscurance O", obscurancePicture(m.byO)},
                {"ambient transfer W", transferPicture(m.byW)},
                {"W - O in red, times 4", greyPicture(back, 0.25f)}};
  addMeans(out, m);
  const PixelTest seen = isSeen(m.byW);
  const double o = meanOf(m.byW.transfer.obscurance, seen), red = meanOf(m.byW.transfer.w[0], seen), blue = meanOf(m.byW.transfer.w[2], seen);
  const raster::Plane<float>(&a)[3] = m.byW.g.albedo;
  const bool albedo = leastOf(a[0], seen) == meanOf(a[0], seen) && number(meanOf(a[0], seen)) == "0.6" && number(meanOf(a[2], seen)) == "0.3";
  out.claims = {{"the albedo is (0.6, 0.3, 0.3) everywhere", albedo},
                {"W takes back a part of the darkening, more of it in red: 1 - O is " + number(1 - o) + ", 1 - W is " + number(1 - red) + " in red and " +
                     number(1 - blue) + " in blue",
                 1 - red < 0.7 * (1 - o) && 1 - blue < 0.9 * (1 - o) && red > blue},
                {"W lies between O and 1 in every pixel", liesBetween(m.byW)}};
  return out;
}

}  // namespace obscura::apps
