// n = 1, 4 and 8 samples a pixel, without and with interleaved sampling and its filter.
#include "obscura/apps/figure_scenes.h"
#include "obscura/apps/figure_stage.h"

namespace obscura::apps {

FigureContent makeSamplingFigure(const FigureSettings& figure) {
  GlbScene scene = makeCarvedScene();
  scene.camera.yFov = 0.36;  // nearer
  FigureStage stage(scene, figure, 0.4);
  engine::FrameSettings& s = stage.settings;
  s.transfer.estimator = post::Estimator::Sobol;  // 64 rays in each pixel of the pattern: 1024 in a filtered one
  s.transfer.filterGuide = post::FilterGuide::Plane;
  s.transfer.samples = 64;
  const engine::Frame truth = stage.render(s);
  s.transfer.estimator = post::Estimator::Paper;
  s.transfer.filterGuide = post::FilterGuide::Depth;
  const PixelTest seen = isSeen(truth);

  FigureContent out;
  out.columns = 2;
  out.numbers.columns = {"n", "RMSE of O without interleaving", "with interleaving and filter"};
  double error[2][3];
  for (int k = 0; k < 3; ++k) {
    s.transfer.samples = k == 0 ? 1 : 4 * k;
    const std::string n = "n = " + std::to_string(s.transfer.samples);
    for (const bool interleaved : {false, true}) {
      s.transfer.interleave = s.transfer.filter = interleaved;
      const engine::Frame f = stage.render(s);
      error[interleaved][k] = rmseOf(f.transfer.obscurance, truth.transfer.obscurance, seen);
      out.panels.push_back({n + (interleaved ? ", interleaved, filtered" : ""), obscurancePicture(f)});
    }
    out.numbers.rows.push_back({std::to_string(s.transfer.samples), number(error[0][k]), number(error[1][k])});
  }
  for (int k = 0; k < 3; ++k)
    out.claims.push_back({"n = " + out.numbers.rows[size_t(k)][0] + ": interleaving with the filter has less error, " + number(error[1][k]) + " against " +
                              number(error[0][k]),
                          error[1][k] < 0.8 * error[0][k]});
  out.claims.push_back({"more samples have less error, with it and without", error[0][2] < error[0][1] && error[0][1] < error[0][0] && error[1][2] < error[1][1] &&
                                                                                   error[1][1] < error[1][0]});
  return out;
}

}  // namespace obscura::apps
