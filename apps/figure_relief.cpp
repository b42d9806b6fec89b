// Height field against depth map: what each of the two containment tests knows of a displaced surface with a block on it.
#include <limits>

#include "obscura/apps/demo_surfaces.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/post/depth_filter.h"
#include "obscura/post/transfer_samples.h"

namespace obscura::apps {
namespace {

using raster::Plane;

// O by the tests that are asked for.
Plane<float> obscuranceBy(const raster::GBuffer& g, const engine::Scene& scene, const engine::FrameSettings& s, bool depthMap, bool heightField) {
  std::vector<raster::HeightView> heights;
  for (const engine::HeightMap& h : scene.heightMaps) heights.push_back(h.view);
  post::TransferInput in{&g, post::makeProjector(s.camera, s.width, s.height, raster::Window{0, 0, s.width, s.height}), s.transfer,
                         post::transferSamples(s.transfer)};
  in.settings.albedo = post::TransferAlbedo::Own;  // for O, which reads none
  if (heightField) in.heights = heights;
  if (!depthMap) in.settings.bias = 1e30f;  // so far behind it nothing lies
  post::TransferSums sums = post::makeTransferSums(in);
  const raster::Target target = raster::chooseTarget(raster::Target::Auto);
  post::ambientTransfer(in, 0, g.height, sums, target);
  post::Transfer out = post::makeTransfer(g.width, g.height, {true, false, false});
  post::depthFilter(in, sums, 0, g.height, out, target);
  return std::move(out.obscurance);
}

}  // namespace

FigureContent makeReliefFigure(const FigureSettings& figure) {
  GlbScene made = makeReliefScene();
  made.nodes.back().scale = glm::dvec3(0.4);  // the block
  made.nodes.back().translation.y = 0.2;
  made.camera.eye = {1.0, 1.25, 2.6};
  made.camera.target = {0.3, -0.02, 0.1};
  FigureStage stage(made, figure, 0.3);
  engine::FrameSettings& s = stage.settings;
  s.transfer.samples = 32;
  s.background = glm::vec3(0.5f, 0.6f, 0.7f);
  const engine::Frame shaded = stage.render(s);
  const raster::GBuffer& g = shaded.g;
  const engine::Scene& scene = stage.scene();
  const Plane<float> depth = obscuranceBy(g, scene, s, true, false), height = obscuranceBy(g, scene, s, false, true),
                     both = obscuranceBy(g, scene, s, true, true);
  s.displacement = false;
  const engine::Frame flat = stage.render(s);

  const PixelTest floor = isNode(shaded, scene, "floor"), block = isNode(shaded, scene, "block");
  FigureContent out;
  out.columns = 3;
  out.panels = {{"flat: O", obscurancePicture(flat)},
                {"displaced: O by depth map", greyPicture(depth)},
                {"O by height field", greyPicture(height)},
                {"O by both", greyPicture(both)},
                {"displaced, light x W", colorPicture(shaded)},
                {"flat, light x W", colorPicture(flat)}};
  out.numbers.columns = {"mean O", "floor", "block"};
  const auto row = [&](const char* name, const Plane<float>& o) { out.numbers.rows.push_back({name, number(meanOf(o, floor)), number(meanOf(o, block))}); };
  row("depth map alone", depth);
  row("height field alone", height);
  row("both", both);
  bool product = true;
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) product &= both.at(x, y) <= depth.at(x, y) && both.at(x, y) <= height.at(x, y);
  out.claims = {{"the height field knows nothing of the block, which the depth map sees: O of the block is " + number(meanOf(height, block)) + " and " +
                     number(meanOf(depth, block)),
                 meanOf(height, block) > 0.999 && meanOf(depth, block) < 0.99},
                {"each knows shadows that the other does not: of the floor O is " + number(meanOf(height, floor)) + ", " + number(meanOf(depth, floor)) +
                     " and by both " + number(meanOf(both, floor)),
                 meanOf(both, floor) < meanOf(height, floor) && meanOf(both, floor) < meanOf(depth, floor)},
                {"their product is open nowhere where one of them is not", product}};
  return out;
}

}  // namespace obscura::apps
