// False silhouettes: a door that is far from the corridor behind it must not darken it.
#include <algorithm>

#include "obscura/apps/figure_scenes.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/engine/ambient_directions.h"

namespace obscura::apps {

FigureContent makeSilhouettesFigure(const FigureSettings& figure) {
  constexpr double kRadius = 0.7;
  FigureStage stage(makeCorridorScene(true), figure, kRadius), empty(makeCorridorScene(false), figure, kRadius);
  for (FigureStage* s : {&stage, &empty}) {
    s->settings.transfer.samples = 24;
    // Most comes from above, the least from the left.
    s->settings.ambientDirections = engine::cubeOf({glm::vec3(0.9f, 0.85f, 0.8f), glm::vec3(0.6f), glm::vec3(1.0f), glm::vec3(0.65f), glm::vec3(0.85f), glm::vec3(0.7f)});
  }
  const engine::Frame truth = empty.render(empty.settings);
  const engine::Frame with = stage.render(stage.settings);
  stage.settings.transfer.silhouetteBound = false;
  const engine::Frame without = stage.render(stage.settings);

  // The corridor, as far as the door leaves it to be seen: there the door is much farther away than R.
  const PixelTest behind = [&](int x, int y) { return with.g.depth.at(x, y) == truth.g.depth.at(x, y) && with.g.depth.at(x, y) > 5.6f; };
  // How much darker it is than without a door. (It may also be brighter: what the door hides occludes nothing.)
  const auto darkening = [&](const engine::Frame& f) {
    raster::Plane<float> lost(figure.width, figure.height);
    for (int y = 0; y < figure.height; ++y)
      for (int x = 0; x < figure.width; ++x) lost.at(x, y) = std::max(0.0f, truth.transfer.obscurance.at(x, y) - f.transfer.obscurance.at(x, y));
    return meanOf(lost, behind);
  };
  const double wrong = darkening(without), right = darkening(with);
  FigureContent out;
  out.columns = 2;
  out.panels = {{"O without the bound", obscurancePicture(without)},
                {"O with the bound", obscurancePicture(with)},
                {"image without the bound", colorPicture(without)},
                {"image with the bound", colorPicture(with)}};
  out.numbers.columns = {"O of the corridor", "mean", "mean of what it is darker than without a door"};
  const auto row = [&](const char* name, const engine::Frame& f) {
    out.numbers.rows.push_back({name, number(meanOf(f.transfer.obscurance, behind)), number(darkening(f))});
  };
  row("without the bound", without);
  row("with the bound", with);
  row("no door", truth);
  out.claims = {{"the bound removes the shadow of the door from the corridor: it is darker by " + number(right) + " instead of " + number(wrong), right < wrong / 10}};
  return out;
}

}  // namespace obscura::apps
