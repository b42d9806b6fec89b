// The constant and the extended ambient term, in the room of its paper.
#include "obscura/apps/figure_shapes.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/glb_builder.h"
#include "obscura/engine/ambient_light.h"
#include "obscura/engine/extended_ambient.h"

namespace obscura::apps {
namespace {

using engine::Frame;
using glm::dvec3;

// A grey cubic room without its near wall's back: red on the left, green on the right, a white sphere in the middle, a square
// lamp at the ceiling.
GlbScene makeRoom() {
  GlbBuilder b;
  const int grey = b.addMaterial("grey", dvec3(0.45)), red = b.addMaterial("red", {0.75, 0.05, 0.06});
  const int green = b.addMaterial("green", {0.05, 0.75, 0.06}), white = b.addMaterial("white", dvec3(0.9));
  const int lamp = b.addMaterial("lamp", dvec3(0));
  b.material(lamp).emissive = dvec3(14);
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
    b.addGroup(wall.name, b.addMesh(makeQuad(wall.corners[0], wall.corners[1], wall.corners[2], wall.corners[3]), wall.material));
  b.addGroup("sphere", b.addMesh(makeBall(0.9, 96), white));
  b.lookAt({0, 0.1, 5.7}, {0, 0.0, 0}, 0.80);
  return std::move(b.scene);
}

// What the surfaces send each other after the lamp's light has been reflected once, as if it arrived everywhere alike: the
// unshot power of a progressive solution, whose direct part is not the ambient term's.
std::array<glm::vec3, 6> reflectedLight(const engine::Scene& scene, int threads) {
  raster::Parallel parallel(threads);
  const std::array<dvec3, 6> cube = engine::cubeDirections();
  std::vector<engine::AmbientClass> classes = engine::ambientClasses(scene, {cube.begin(), cube.end()}, parallel);
  for (engine::AmbientClass& c : classes) c.emitted = dvec3(0);
  const std::vector<glm::vec3> incoming = engine::incomingLight(classes, dvec3(1));
  std::array<glm::vec3, 6> reflected;
  for (size_t k = 0; k < 6; ++k) reflected[k] = incoming[k] - glm::vec3(1);
  return reflected;
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
  s.tone.exposure = 0.6f;
  const std::array<glm::vec3, 6> colors = reflectedLight(stage.scene(), figure.raster.threads);
  glm::vec3 mean(0);
  for (const glm::vec3& c : colors) mean += c / 6.0f;
  const struct {
    const char* label;
    bool extended;
    post::Occlusion occlusion;
  } kPanels[] = {{"constant ambient term", false, post::Occlusion::None},
                 {"extended ambient term", true, post::Occlusion::None},
                 {"constant ambient term x W", false, post::Occlusion::Transfer},
                 {"extended ambient term x W", true, post::Occlusion::Transfer}};
  FigureContent out;
  out.columns = 2;
  out.numbers.columns = {"white sphere", "left red", "left green", "right red", "right green"};
  for (const auto& panel : kPanels) {
    s.ambientDirections.reset();
    s.ambientLight = glm::vec3((mean.x + mean.y + mean.z) / 3);  // as bright, grey
    if (panel.extended) s.ambientDirections = colors, s.ambientLight = glm::vec3(1);
    s.ambient = panel.occlusion;
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
