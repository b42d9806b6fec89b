// Containment tests instead of rays, in a section through a landscape: what is inside by height field and by depth map.
#include <algorithm>
#include <cmath>

#include "obscura/apps/demo_random.h"
#include "obscura/apps/drawing.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using engine::Image;

constexpr double kTau = 6.283185307179586;
constexpr double kWide = 4, kHigh = 3;       // of the section; the eye is far above, to the left
constexpr Ink kPaper = {255, 255, 255}, kInside = {205, 214, 224}, kSurface = {50, 60, 75}, kOpen = {0, 130, 90}, kBlocked = {205, 70, 0}, kWrong = {190, 0, 120};

double surface(double x) {
  const auto hill = [](double at, double width, double t) { return raster::exactExp(-(t - at) * (t - at) / (width * width)); };
  return 0.55 + 0.9 * hill(0.85, 0.33, x) + 1.45 * hill(2.05, 0.17, x) + 0.8 * hill(3.1, 0.3, x) + 0.08 * raster::exactSin(5 * x);
}

// The first surface that the eye meets on its way through (x, y): how far it lies before that point; 0 outside.
double depthBehind(double x, double y) {
  const double dx = -0.35, dy = 0.94;  // towards the eye
  double behind = 0;
  for (double t = 0; t < 4; t += 0.01)
    if (surface(x + t * dx) > y + t * dy) behind = t;
  return behind;
}

struct Ray {
  double crossings;  // as many times it meets the surface
  bool clear, inside;  // no hit up to its end; its end is inside
};

Ray follow(Point from, Point to) {
  Ray r{0, true, surface(to.x) > to.y};
  bool below = false;
  for (int k = 1; k <= 400; ++k) {
    const double t = k / 400.0, x = from.x + t * (to.x - from.x), y = from.y + t * (to.y - from.y);
    const bool now = surface(x) > y;
    r.crossings += now != below ? 1 : 0;
    below = now;
    r.clear &= !now;
  }
  return r;
}

}  // namespace

FigureContent makeContainmentFigure(const FigureSettings& figure) {
  const double scale = std::min(figure.width / kWide, figure.height / kHigh), line = std::max(1.5, scale / 60);
  const auto at = [&](double x, double y) { return Point{figure.width / 2.0 + (x - kWide / 2) * scale, figure.height / 2.0 + (kHigh / 2 - y) * scale}; };
  // Which points of the section are drawn as inside.
  const auto sectionOf = [&](const auto& inside) {
    Image image = blankPicture(figure.width, figure.height, kPaper);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double sx = (x + 0.5 - figure.width / 2.0) / scale + kWide / 2, sy = kHigh / 2 - (y + 0.5 - figure.height / 2.0) / scale;
        if (inside(sx, sy)) std::copy(kInside.begin(), kInside.end(), image.row<uint8_t>(y) + 3 * x);
      }
    const double edge = figure.width / scale / 2 + 0.1;
    for (double x = kWide / 2 - edge; x < kWide / 2 + edge; x += 0.02) drawSegment(image, at(x, surface(x)), at(x + 0.02, surface(x + 0.02)), line, kSurface);
    return image;
  };
  const auto heightField = [](double x, double y) { return surface(x) > y; };
  Image rays = sectionOf(heightField), field = sectionOf(heightField);
  const Image map = sectionOf([](double x, double y) { return depthBehind(x, y) > 0; });
  const Image bounded = sectionOf([](double x, double y) {
    const double d = depthBehind(x, y);
    return d > 0 && d < 0.7;
  });

  // Three rays of the long version's figure 2, from one point in the valley.
  const Point x{1.47, surface(1.47) + 0.005};
  const struct {
    Point end;
    int meets;
  } kRays[] = {{{1.30, 1.95}, 0}, {{2.02, 1.15}, 1}, {{2.65, 1.05}, 2}};
  FigureContent out;
  out.columns = 2;
  out.numbers.columns = {"ray", "meets the surface", "its end is", "the ray is"};
  bool right = true;
  for (const auto& k : kRays) {
    const Ray r = follow(x, k.end);
    const std::string name = std::to_string(out.numbers.rows.size() + 1);
    out.numbers.rows.push_back({name, number(r.crossings), r.inside ? "inside" : "outside", r.clear ? "open" : "blocked"});
    right &= r.crossings == k.meets && (k.meets < 2 ? r.inside != r.clear : r.inside == r.clear);
    const Ink ink = r.inside == r.clear ? kWrong : r.clear ? kOpen : kBlocked;
    drawSegment(rays, at(x.x, x.y), at(k.end.x, k.end.y), line, ink);
    drawDot(rays, at(k.end.x, k.end.y), 5 * line, ink);
    engine::drawText(rays, name, int(at(k.end.x, k.end.y).x + 4 * line), int(at(k.end.x, k.end.y).y - 8 * line), std::max(1, int(line)), 40);
  }
  drawDot(rays, at(x.x, x.y), 6 * line, kSurface);

  // Short rays from points all along the surface, as a frame has them.
  int tests = 0, agree = 0;
  for (double px = 0.1; px < kWide; px += 0.05)
    for (int k = 1; k < 12; ++k) {
      const double angle = kTau / 2 * k / 12 + raster::exactAtan2(surface(px + 0.01) - surface(px - 0.01), 0.02);  // above the tangent
      const Point from{px, surface(px) + 0.005};
      const Point to{from.x + 0.3 * raster::exactCos(angle), from.y + 0.3 * raster::exactSin(angle)};
      const Ray r = follow(from, to);
      ++tests;
      agree += r.clear != r.inside;
      if (int(px / 0.05) % 3 == 0) drawDot(field, at(to.x, to.y), 2.5 * line, r.clear == r.inside ? kWrong : r.inside ? kBlocked : kOpen);
    }
  out.panels = {{"rays 1, 2, 3 and their ends", std::move(rays)},
                {"test points, height field", std::move(field)},
                {"inside by the depth map", map},
                {"inside by it, up to R behind", bounded}};
  const double share = double(agree) / tests;
  out.claims = {{"a ray's end tells whether it is blocked if it meets the surface at most once (1, 2), and not if twice (3)", right},
                {"near the surface a test point tells the same as its ray for " + number(100 * share) + " % of them", share > 0.95}};
  return out;
}

}  // namespace obscura::apps
