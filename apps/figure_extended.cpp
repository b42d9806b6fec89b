// The constant and the extended ambient term, in the room of its paper.
#include "obscura/apps/figure_shapes.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/glb_builder.h"
#include "obscura/engine/bounced_light.h"
#include "obscura/engine/extended_ambient.h"

namespace obscura::apps {
namespace {

using engine::Frame;
using glm::dvec3;

// A rectangle of 128 triangles, so that each has the lamp's light of its own place.
GlbMesh makeWall(const dvec3 (&corners)[4]) {
  return makeSurface("wall", 8, 8, false, [&](double u, double v) { return mix(mix(corners[3], corners[2], u), mix(corners[0], corners[1], u), v); });
}

// A grey cubic room without its near wall's back: red on the left, green on the right, a white sphere in the middle, a square
// lamp at the ceiling.
GlbScene makeRoom() {
  GlbBuilder b;
  const int grey = b.addMaterial("grey", dvec3(0.45)), red = b.addMaterial("red", {0.75, 0.05, 0.06});
  const int green = b.addMaterial("green", {0.05, 0.75, 0.06}), white = b.addMaterial("white", dvec3(0.9));
  const int lamp = b.addMaterial("lamp", dvec3(0));
  b.material(lamp).emissive = dvec3(1);
  const struct {
    const char* name;
    int material;
    dvec3 corners[4];
  } kWalls[] = {{"red wall", red, {{-2, -2, 2}, {-2, -2, -2}, {-2, 2, -2}, {-2, 2, 2}}},
                {"green wall", green, {{2, -2, -2}, {2, -2, 2}, {2, 2, 2}, {2, 2, -2}}},
                {"floor", grey, {{-2, -2, 2}, {2, -2, 2}, {2, -2, -2}, {-2, -2, -2}}},
                {"ceiling", grey, {{-2, 2, -2}, {2, 2, -2}, {2, 2, 2}, {-2, 2, 2}}},
                {"back wall", grey, {{-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}}},
                {"front wall", grey, {{2, -2, 2}, {-2, -2, 2}, {-2, 2, 2}, {2, 2, 2}}},  // turned away from the eye, unseen
                {"lamp", lamp, {{-0.6, 1.99, -0.6}, {0.6, 1.99, -0.6}, {0.6, 1.99, 0.6}, {-0.6, 1.99, 0.6}}}};
  for (const auto& wall : kWalls)
    b.addGroup(wall.name, b.addMesh(makeWall(wall.corners), wall.material));
  b.addGroup("sphere", b.addMesh(makeBall(0.8, 96), white));
  b.lookAt({0, 0.1, 5.7}, {0, 0.0, 0}, 0.80);
  return std::move(b.scene);
}

// Just below the lamp, in its place.
engine::SceneLight lampLight() {
  engine::SceneLight light;
  light.kind = post::LightKind::Spot;
  light.position = {0, 1.9, 0};
  light.direction = {0, -1, 0};
  light.innerCone = 0.9;
  light.outerCone = 1.4;
  light.color = glm::vec3(25);  // candela
  return light;
}

// The light that the surfaces send each other, from what the lamp's light leaves on them at its first reflection.
std::vector<post::AmbientDirection> reflectedLight(const engine::Scene& scene, const FigureSettings& figure) {
  const std::vector<engine::SceneLight> lights = {lampLight()};
  const engine::BouncedLight direct(scene, lights, true, figure.raster);
  raster::Parallel parallel(figure.raster.threads);
  const auto colors = engine::extendedAmbient(scene, std::nullopt, parallel, &direct);
  if (!colors) throw FigureError(colors.error().text());
  return *colors;
}

struct Side {
  double red, green;
};

// Mean light of the sphere where its normal points to the left (-1) or right (+1) by more than half.
Side sideOf(const Frame& f, const engine::Scene& scene, float direction) {
  const PixelTest sphere = isNode(f, scene, "sphere");
  const PixelTest side = [&](int x, int y) { return sphere(x, y) && f.g.normal[0].at(x, y) * direction > 0.5f; };
  return {meanOf(f.color.rgb[0], side), meanOf(f.color.rgb[1], side)};
}

}  // namespace

FigureContent makeExtendedFigure(const FigureSettings& figure) {
  FigureStage stage(makeRoom(), figure, 0.9);
  engine::FrameSettings& s = stage.settings;
  s.transfer.samples = 32;
  s.tone.curve = post::ToneCurve::Neutral;
  const std::vector<post::AmbientDirection> colors = reflectedLight(stage.scene(), figure);
  glm::vec3 mean(0);
  for (const post::AmbientDirection& k : colors) mean += k.color / 6.0f;
  const struct {
    const char* label;
    bool extended;
    post::Occlusion occlusion;
  } kPanels[] = {{"constant ambient term", false, post::Occlusion::None},
                 {"extended ambient term", true, post::Occlusion::None},
                 {"lamp + constant x W", false, post::Occlusion::Transfer},
                 {"lamp + extended x W", true, post::Occlusion::Transfer}};
  FigureContent out;
  out.columns = 2;
  out.numbers.columns = {"white sphere", "left red", "left green", "right red", "right green"};
  for (const auto& panel : kPanels) {
    s.ambientDirections.clear();
    s.ambientLight = glm::vec3((mean.x + mean.y + mean.z) / 3);  // as bright, grey
    if (panel.extended) s.ambientDirections = colors, s.ambientLight = glm::vec3(1);
    s.ambient = panel.occlusion;
    s.lights.clear();
    s.tone.exposure = panel.occlusion == post::Occlusion::None ? 2.5f : 1.3f;
    if (panel.occlusion == post::Occlusion::Transfer) s.lights = {lampLight()};
    const Frame f = stage.render(s);
    const Side left = sideOf(f, stage.scene(), -1), right = sideOf(f, stage.scene(), 1);
    out.panels.push_back({panel.label, colorPicture(f)});
    out.numbers.rows.push_back({panel.label, number(left.red), number(left.green), number(right.red), number(right.green)});
    if (panel.occlusion == post::Occlusion::Transfer) continue;
    if (!panel.extended) {
      out.claims.push_back({"with the constant term both sides of the sphere have the same grey", left.red == left.green && left.red == right.red && left.red == right.green});
      continue;
    }
    out.claims.push_back({"with the extended one the side that faces the red wall is reddish, red / green = " + number(left.red / left.green), left.red > 1.1 * left.green});
    out.claims.push_back({"the one that faces the green wall is greenish, green / red = " + number(right.green / right.red), right.green > 1.1 * right.red});
  }
  return out;
}

}  // namespace obscura::apps
