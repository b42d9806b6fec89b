// A highlight that is thresholded beside the plain one.
#include <algorithm>
#include <cmath>

#include "obscura/apps/figure_shapes.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/glb_builder.h"
#include "obscura/apps/pictures.h"
#include "obscura/engine/plane_image.h"
#include "obscura/post/direct_light.h"

namespace obscura::apps {
namespace {

using glm::dvec2;
using glm::dvec3;
using raster::exactCos;
using raster::exactSin;

constexpr double kTau = 6.283185307179586;

// A vase, a ball and a ring on a table, smooth and glossy; black ones show their highlights alone.
GlbScene makeGlossyThings(bool black) {
  GlbBuilder b;
  const auto gloss = [&](const char* name, dvec3 color) {
    return b.addMaterial(name, black ? dvec3(0) : color);
  };
  const int red = gloss("red", {0.55, 0.05, 0.04}), green = gloss("green", {0.06, 0.26, 0.10}), blue = gloss("blue", {0.07, 0.12, 0.42});
  const int table = b.addMaterial("table", black ? dvec3(0) : dvec3(0.22, 0.20, 0.18));
  const GlbMesh vase = makeTurned("vase", 128, 96, [](double v) {
    const double t = 1 - v;
    const double belly = exactSin(kTau / 2 * t * (1.25 - 0.25 * t));
    return dvec2(0.10 + 0.42 * belly * belly + 0.22 * smoothstep(0.8, 1.0, t) + 0.18 * (1 - smoothstep(0, 0.12, t)), 1.6 * t);
  });
  const GlbMesh ring = makeTurned("ring", 128, 48, [](double v) { return dvec2(0.42 + 0.15 * exactSin(kTau * v), 0.15 + 0.15 * exactCos(kTau * v)); });
  const int vaseMesh = b.addMesh(vase, red);
  b.material(red).doubleSided = true;
  b.place(vaseMesh, {-0.45, 0, -0.25});
  b.place(b.addMesh(makeBall(0.42, 128), blue), {0.75, 0.42, 0.05});
  b.place(b.addMesh(ring, green), {0.18, 0, 0.95});
  b.place(b.addMesh(makeQuad({-30, 0, 30}, {30, 0, 30}, {30, 0, -30}, {-30, 0, -30}), table), dvec3(0));
  b.lookAt({0.5, 1.75, 4.4}, {0.12, 0.56, 0}, 0.56);
  return std::move(b.scene);
}

// A directional light from there (world space), of so many lux.
post::PunctualLight lightFrom(dvec3 towards, double lux, const raster::Camera& camera) {
  post::PunctualLight light;
  light.place = glm::vec3(glm::dmat3(camera.viewFromWorld) * unit(towards));
  light.color = glm::vec3(float(lux));
  return light;
}

// Lit by two lights without shadows, besides what the ambient light gives.
post::LinearColor lit(const engine::FrameSettings& s, engine::Frame frame, post::Brdf brdf) {
  const std::vector<post::PunctualLight> lights = {lightFrom({-0.9, 1.1, 0.9}, 2.6, s.camera), lightFrom({0.9, 0.9, 0.7}, 1.2, s.camera)};
  post::DirectLightInput in{&frame.g, post::makeProjector(s.camera, s.width, s.height), lights, brdf};
  in.add = true;
  post::directLight(in, 0, s.height, frame.color, raster::chooseTarget(raster::Target::Auto));
  return std::move(frame.color);
}

}  // namespace

FigureContent makeHighlightFigure(const FigureSettings& figure) {
  FigureStage glossy(makeGlossyThings(false), figure, 0.4), black(makeGlossyThings(true), figure, 0.4);
  for (FigureStage* stage : {&glossy, &black}) {
    engine::FrameSettings& s = stage->settings;
    s.aovs.insert(s.aovs.end(), {engine::Aov::Metallic, engine::Aov::Roughness});
    s.ambientLight = glm::vec3(stage == &black ? 0.0f : 0.25f);
    for (raster::Material& m : stage->scene().materials) m.roughness = 0.32f;
  }
  FigureContent out;
  out.columns = 2;
  out.numbers.columns = {"highlights alone", "share of the picture", "largest", "of these pixels below 0.3 of it"};
  double soft[2], largest[2];
  const struct {
    const char* name;
    post::Brdf brdf;
  } kKinds[] = {{"thresholded", post::Brdf::BlinnPhongThresholded}, {"plain", post::Brdf::BlinnPhong}};
  for (const FigureStage* stage : {&glossy, &black})
    for (int k = 0; k < 2; ++k) {
      const engine::Frame f = stage->render(stage->settings);
      const post::LinearColor color = lit(stage->settings, stage->render(stage->settings), kKinds[k].brdf);
      const engine::Image linear = engine::interleave({&color.rgb[0], &color.rgb[1], &color.rgb[2]});
      out.panels.push_back({std::string(kKinds[k].name) + (stage == &black ? ", highlights alone" : " highlight"), srgbPicture(linear, 8)});
      if (stage == &glossy) continue;
      const raster::Plane<float>& p = color.rgb[1];
      // Of the ball, which faces the lights with all of its curvature.
      const PixelTest ball = isNode(f, black.scene(), "ball 1");
      largest[k] = largestOf(p, ball);
      const PixelTest seen = [&](int x, int y) { return ball(x, y) && double(p.at(x, y)) > 0.02 * largest[k]; };
      const PixelTest faint = [&](int x, int y) { return ball(x, y) && double(p.at(x, y)) > 0.02 * largest[k] && double(p.at(x, y)) < 0.3 * largest[k]; };
      soft[k] = share(p, faint) / std::max(share(p, seen), 1e-9);
      out.numbers.rows.push_back({kKinds[k].name, number(share(p, seen)), number(largest[k]), number(soft[k])});
    }
  out.claims = {{"the thresholded highlight has a sharp edge: " + number(100 * soft[0]) + " % of its pixels are below 0.3 of the largest, of the plain one " + number(100 * soft[1]) + " %",
                 soft[0] < 0.05 && soft[1] > 0.2},
                {"its middle is even and no brighter than that of the plain one: " + number(largest[0]) + " and " + number(largest[1]), largest[0] <= largest[1]}};
  return out;
}

}  // namespace obscura::apps
