// What W argues with: the corner of a white room, and snow.
#include <algorithm>
#include <cmath>

#include "obscura/apps/figure_shapes.h"
#include "obscura/apps/figure_sky.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/glb_builder.h"

namespace obscura::apps {
namespace {

using engine::Frame;
using glm::dvec3;
using post::Occlusion;

GlbScene makeWhiteRoom(double albedo) {
  GlbBuilder b;
  const int paint = b.addMaterial("paint", dvec3(albedo));
  const int walls = b.addMesh(makeQuad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}), paint);
  const int left = b.addMesh(makeQuad({0, 0, 4}, {0, 0, 0}, {0, 4, 0}, {0, 4, 4}), paint);
  const int floor = b.addMesh(makeQuad({0, 0, 4}, {4, 0, 4}, {4, 0, 0}, {0, 0, 0}), paint);
  for (const int mesh : {walls, left, floor}) b.place(mesh, dvec3(0));
  b.place(b.addMesh(makeBox({0.45, 0.45, 0.45}), paint), {0.95, 0.45, 0.75}, 0.4);
  b.place(b.addMesh(makeBall(0.35, 48), paint), {0.55, 0.35, 1.75});
  b.lookAt({3.7, 2.3, 3.9}, {0.35, 0.75, 0.35}, 0.62);
  return std::move(b.scene);
}

// Rolling ground with bumps, a ski track and footprints.
double snowHeight(double x, double z) {
  double y = 0.25 * noise({x * 0.35, 0, z * 0.35}, 801) + 0.3 * noise({x * 1.2, 0, z * 1.2}, 811) + 0.03 * noise({x * 4, 0, z * 4}, 812);
  const double middle = -0.5 + 0.35 * z + 0.5 * noise({0, 0, z * 0.4}, 821);
  for (const double side : {-0.11, 0.11}) y -= 0.09 * (1 - smoothstep(0.03, 0.06, std::fabs(x - middle - side)));
  for (int k = 0; k < 14; ++k) {
    const double fx = 1.5 - 0.12 * k + (k & 1 ? 0.13 : -0.13), fz = 2.6 - 0.42 * k;
    const double dx = (x - fx) / 0.09, dz = (z - fz) / 0.16;
    y -= 0.14 * (1 - smoothstep(0.7, 1.1, std::sqrt(dx * dx + dz * dz)));
  }
  return y;
}

GlbScene makeSlope(dvec3 albedo) {
  GlbBuilder b;
  const int ground = b.addMaterial("ground", albedo);
  // Finer towards the eye.
  const GlbMesh slope = makeSurface("slope", 260, 260, false, [](double u, double v) {
    const double z = 4 - 14 * (1 - v) * (1 - 0.55 * v), x = (u - 0.5) * (3.5 + 1.0 * (4 - z));
    return dvec3(x, snowHeight(x, z), z);
  });
  b.place(b.addMesh(slope, ground), dvec3(0));
  b.lookAt({0.3, 2.1, 4.6}, {0.1, 0.0, -0.4}, 0.62);
  return std::move(b.scene);
}

Frame renderWith(FigureStage& stage, Occlusion occlusion) {
  stage.settings.ambient = occlusion;
  return stage.render(stage.settings);
}

}  // namespace

FigureContent makeWhiteRoomFigure(const FigureSettings& figure) {
  constexpr double kAlbedos[] = {0, 0.5, 0.8, 0.95, 1};
  FigureContent out;
  out.columns = 3;
  out.numbers.columns = {"albedo", "mean O", "least O", "mean W", "least W"};
  std::vector<double> least;
  const auto sky = makeSkyLight(figure);
  for (const double albedo : kAlbedos) {
    FigureStage stage(makeWhiteRoom(albedo), figure, 0.8);
    engine::FrameSettings& s = stage.settings;
    s.transfer.samples = 48;
    s.environment = sky;
    s.environmentRotation = -30;
    s.environmentIntensity = 0.9;
    const Frame f = renderWith(stage, Occlusion::Transfer);
    const PixelTest seen = isSeen(f);
    const raster::Plane<float>&o = f.transfer.obscurance, &w = f.transfer.w[0];
    out.numbers.rows.push_back({number(albedo), number(meanOf(o, seen)), number(leastOf(o, seen)), number(meanOf(w, seen)), number(leastOf(w, seen))});
    least.push_back(leastOf(w, seen));
    if (albedo == 0.5) out.panels.push_back({"grey room, albedo 0.5: W", transferPicture(f)});
    if (albedo == 0.8) out.panels.push_back({"light grey room, albedo 0.8: W", transferPicture(f)});
    if (albedo != 1) continue;
    out.panels.insert(out.panels.begin(), {{"obscurance O", obscurancePicture(f)},
                                           {"white room: light x O", colorPicture(renderWith(stage, Occlusion::Obscurance))},
                                           {"white room: light x W", colorPicture(f)}});
    out.panels.push_back({"white room, albedo 1: W", transferPicture(f)});
    out.claims.push_back({"the corner of the white room is not darkened: W is 1 in every pixel, O falls to " + number(leastOf(o, seen)),
                          leastOf(w, seen) == 1 && leastOf(o, seen) < 0.6});
  }
  out.claims.push_back({"the whiter the room, the less its corner is darkened", std::is_sorted(least.begin(), least.end())});
  return out;
}

FigureContent makeSnowFigure(const FigureSettings& figure) {
  FigureStage snow(makeSlope(dvec3(0.95)), figure, 0.6), earth(makeSlope({0.20, 0.13, 0.08}), figure, 0.6);
  for (FigureStage* s : {&snow, &earth}) {  // fog: the same light from everywhere
    s->settings.transfer.samples = 32;
    s->settings.background = glm::vec3(0.95f);
  }
  earth.settings.tone.exposure = 2;
  const Frame bare = renderWith(earth, Occlusion::Transfer), dimmed = renderWith(snow, Occlusion::Obscurance), white = renderWith(snow, Occlusion::Transfer);
  const PixelTest seen = isSeen(white);
  FigureContent out;
  out.columns = 2;
  out.panels = {{"earth: light x W", colorPicture(bare)},
                {"snow: light x O", colorPicture(dimmed)},
                {"obscurance O", obscurancePicture(white)},
                {"snow: light x W", colorPicture(white)}};
  const auto contrast = [&](const raster::Plane<float>& p) { return deviationOf(p, seen) / meanOf(p, seen); };
  const double o = contrast(white.transfer.obscurance), ofSnow = contrast(white.transfer.w[0]), ofEarth = contrast(bare.transfer.w[0]);
  out.numbers.columns = {"", "mean", "contrast: deviation / mean"};
  out.numbers.rows = {{"O", number(meanOf(white.transfer.obscurance, seen)), number(o)},
                      {"W of earth", number(meanOf(bare.transfer.w[0], seen)), number(ofEarth)},
                      {"W of snow", number(meanOf(white.transfer.w[0], seen)), number(ofSnow)}};
  out.claims = {{"snow loses its bumps: the contrast of W is " + number(ofSnow) + ", that of O " + number(o), ofSnow < o / 6},
                {"earth keeps them: the contrast of its W is " + number(ofEarth), ofEarth > 0.7 * o}};
  return out;
}

}  // namespace obscura::apps
