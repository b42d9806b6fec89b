// Bumped environment mapping: an armour whose normal map bends what it reflects of a sky.
#include <algorithm>
#include <cmath>

#include "obscura/apps/figure_shapes.h"
#include "obscura/apps/figure_sky.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/glb_builder.h"
#include "obscura/apps/pictures.h"

namespace obscura::apps {
namespace {

using glm::dvec2;
using glm::dvec3;
using raster::exactCos;
using raster::exactSin;

constexpr double kTau = 6.283185307179586;

// Rows of overlapping scales, hammered: a height, the same at opposite edges of the unit square.
double scales(double u, double v) {
  const auto wrapped = [](double t) { return t - std::floor(t); };
  double height = 0;
  for (int row = 0; row < 2; ++row) {  // each row is half a scale farther right, and lies over the next one
    const double x = (wrapped(u + 0.5 * row) - 0.5) * 2, y = wrapped(v - 0.5 * row);
    const double inside = 1 - x * x - std::max(0.0, y - 0.45) * std::max(0.0, y - 0.45) / 0.2;
    if (y > 0.95 || inside <= 0) continue;
    height = std::max(height, (0.35 + 0.5 * y) * smoothstep(0, 0.22, inside) + 0.12 * std::sqrt(inside));
  }
  const double a = kTau * u, b = kTau * v;
  return height + 0.05 * noise(dvec3(exactCos(a), exactSin(a), 0) * 1.5 + dvec3(exactSin(b), 0, exactCos(b)) * 2.5, 951);
}

GlbTexture makeScaleNormals() {
  constexpr int kSize = 128;
  constexpr double kDeep = 0.22, kStep = 1.0 / kSize;
  GlbTexture map{"scales", kSize, kSize, {}};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double u = (x + 0.5) * kStep, v = (y + 0.5) * kStep;
      const double du = (scales(u + kStep, v) - scales(u - kStep, v)) / (2 * kStep), dv = (scales(u, v + kStep) - scales(u, v - kStep)) / (2 * kStep);
      const dvec3 n = unit({-kDeep * du, kDeep * dv, 1});  // green is up, v is down
      for (int c = 0; c < 3; ++c) map.rgba.push_back(uint8_t((0.5 * n[c] + 0.5) * 255 + 0.5));
      map.rgba.push_back(255);
    }
  return map;
}

double between(double t, const std::vector<dvec2>& points) {  // smooth through (t, value), ascending in t
  size_t k = 1;
  while (k + 1 < points.size() && t > points[k].x) ++k;
  return mix(points[k - 1].y, points[k].y, smoothstep(points[k - 1].x, points[k].x, t));
}

// Breastplate and skirt: v from the neck to below the waist, u around, its quarter to the front.
GlbMesh makeCuirass() {
  GlbMesh mesh = makeSurface("cuirass", 160, 120, true, [](double u, double v) {
    const double half = between(v, {{0, 0.2}, {0.13, 0.56}, {0.38, 0.60}, {0.72, 0.42}, {1, 0.56}});
    double deep = between(v, {{0, 0.18}, {0.15, 0.33}, {0.38, 0.42}, {0.72, 0.31}, {1, 0.44}});
    const double s = exactSin(kTau * u), c = exactCos(kTau * u);
    if (c > 0) deep += 0.07 * c * raster::exactExp(-s * s / 0.05) * smoothstep(0.1, 0.4, v) * (1 - smoothstep(0.6, 0.75, v));  // a keel
    const double lame = v > 0.74 ? 0.035 * (1 - (v - 0.74) / 0.0867 + std::floor((v - 0.74) / 0.0867)) : 0;           // the skirt's plates
    const double out = 1 + lame;
    return dvec3(half * out * s, 0.62 - 1.45 * v, deep * out * c);
  });
  for (glm::vec2& uv : mesh.uvs) uv *= glm::vec2(16, 9);
  return mesh;
}

GlbScene makeArmour(bool bumped) {
  GlbBuilder b;
  const auto metal = [&](const char* name, dvec3 color, double roughness) {
    const int index = b.addMaterial(name, color);
    b.material(index).metallic = 1;
    b.material(index).roughness = roughness;
    return index;
  };
  const int scaly = metal("scales", {0.72, 0.73, 0.75}, 0.16), steel = metal("steel", {0.72, 0.73, 0.75}, 0.08), gold = metal("gold", {1.0, 0.74, 0.33}, 0.14);
  if (bumped) b.material(scaly).normalMap = b.addTexture(makeScaleNormals());
  const int dark = b.addMaterial("slit", dvec3(0.004)), wood = b.addMaterial("wood", {0.16, 0.09, 0.05});

  b.place(b.addMesh(makeCuirass(), scaly), dvec3(0));
  b.material(scaly).doubleSided = true;
  GlbMesh plate = makeBall(1, 64);
  for (glm::vec2& uv : plate.uvs) uv *= glm::vec2(12, 6);
  const int shoulder = b.addMesh(plate, scaly), ball = b.addMesh(makeBall(1, 64), steel), crest = b.addMesh(makeBall(1, 64), gold), slit = b.addMesh(makeBall(1, 64), dark);
  const int edge = b.addMesh(makeTurned("ring", 64, 24, [](double v) { return dvec2(1 + 0.07 * exactSin(kTau * v), 0.07 * exactCos(kTau * v)); }), gold);
  for (const double side : {-1.0, 1.0})
    for (int k = 0; k < 3; ++k) {
      const double size = 1 - 0.13 * k;
      b.place(shoulder, {side * (0.56 + 0.10 * k), 0.42 - 0.15 * k, 0}, 0, dvec3(0.24, 0.20, 0.29) * size);
      b.place(edge, {side * (0.56 + 0.10 * k), 0.38 - 0.15 * k, 0}, 0, dvec3(0.245, 0.2, 0.295) * size);
    }
  b.place(edge, {0, 0.60, 0}, 0, dvec3(0.21, 0.6, 0.19));   // gorget
  b.place(edge, {0, -0.44, 0}, 0, dvec3(0.435, 0.5, 0.325));  // belt
  b.place(edge, {0, -0.83, 0}, 0, dvec3(0.56, 0.3, 0.44));
  b.place(ball, {0, 0.92, 0}, 0, {0.235, 0.31, 0.27});      // helmet
  b.place(crest, {0, 0.98, -0.02}, 0, {0.025, 0.34, 0.31});
  b.place(slit, {0, 0.93, 0.035}, 0, {0.225, 0.022, 0.252});
  b.place(edge, {0, 0.80, 0.0}, 0, dvec3(0.225, 0.28, 0.26));
  b.place(b.addMesh(makeTurned("stand", 64, 24, [](double v) { return dvec2(v < 0.15 ? 0.45 * v / 0.15 : 0.45 + 0.25 * smoothstep(0.3, 1, v), -0.86 - 0.5 * v); }), wood), dvec3(0));
  b.lookAt({0.9, 0.45, 3.5}, {0, 0.16, 0}, 0.66);
  return std::move(b.scene);
}

}  // namespace

FigureContent makeArmourFigure(const FigureSettings& figure) {
  FigureStage smooth(makeArmour(false), figure, 0.15), bumped(makeArmour(true), figure, 0.15);
  const auto sky = makeSkyLight(figure, engine::EnvironmentParts::Reflections);
  for (FigureStage* stage : {&smooth, &bumped}) {
    engine::FrameSettings& s = stage->settings;
    s.environment = sky;
    s.environmentBackground = true;
    s.environmentRotation = 15;
    s.brdf = post::Brdf::Gltf;
    s.supersample = 2;
    s.tone.curve = post::ToneCurve::Neutral;
  }
  const engine::Frame plain = smooth.render(smooth.settings), bent = bumped.render(bumped.settings);
  bumped.settings.environmentRotation += 90;
  const engine::Frame turned = bumped.render(bumped.settings);

  const auto metal = [&](const engine::Frame& f) { return isNode(f, bumped.scene(), "cuirass 0"); };  // of either stage: the same nodes
  FigureContent out;
  out.columns = 2;
  out.panels = {{"environment mapping, smooth", colorPicture(plain)},
                {"the same, normal mapped", colorPicture(bent)},
                {"normals", picture(bent, engine::Aov::Normal, 8)},
                {"the sky turned by 90 degrees", colorPicture(turned)}};
  const auto contrast = [&](const engine::Frame& f) { return deviationOf(f.color.rgb[1], metal(f)) / meanOf(f.color.rgb[1], metal(f)); };
  const double before = localContrastOf(plain.color.rgb[1], metal(plain)), after = localContrastOf(bent.color.rgb[1], metal(bent));
  out.numbers.columns = {"breastplate, green", "mean", "deviation / mean", "mean step from pixel to pixel / mean"};
  out.numbers.rows = {{"smooth", number(meanOf(plain.color.rgb[1], metal(plain))), number(contrast(plain)), number(before)},
                      {"normal mapped", number(meanOf(bent.color.rgb[1], metal(bent))), number(contrast(bent)), number(after)}};
  out.claims = {{"bumps bend what is reflected: from pixel to pixel the breastplate changes by " + number(after) + " of its mean instead of " + number(before),
                 after > 2 * before},
                {"it is the environment that is seen: with the sky turned by 90 degrees it is another picture, RMSE " +
                     number(rmseOf(bent.color.rgb[1], turned.color.rgb[1], metal(bent))),
                 rmseOf(bent.color.rgb[1], turned.color.rgb[1], metal(bent)) > 0.05}};
  return out;
}

}  // namespace obscura::apps
