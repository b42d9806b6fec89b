// The four ways in which an environment map holds all directions.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/apps/figure_sky.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/pictures.h"
#include "obscura/apps/setting_names.h"

namespace obscura::apps {
namespace {

using engine::EnvironmentMap;
using engine::EnvironmentProjection;
using engine::EnvironmentProjector;

struct SolidAngles {
  double sum = 0, least = std::numeric_limits<double>::infinity(), largest = 0;  // of texels whose centre is shown
};

SolidAngles solidAnglesOf(const EnvironmentProjector& p) {
  SolidAngles all;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const double angle = p.solidAngle(x, y);
      all.sum += angle * p.panels();
      // A texel that the circle cuts is smaller than it would be.
      if (!p.shows(x, y) || !p.shows(std::max(x - 1, 0), y) || !p.shows(std::min(x + 1, p.width - 1), y)) continue;
      all.least = std::min(all.least, angle);
      all.largest = std::max(all.largest, angle);
    }
  return all;
}

// Black where a map shows what another place of it shows, too.
engine::Image pictureOf(const EnvironmentMap& map) {
  engine::Image image = srgbPicture(engine::imageOfEnvironment(map), 8);
  const EnvironmentProjector& p = map.projector();
  for (int panel = 0; panel < p.panels(); ++panel)
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x)
        if (!p.shows(x, y)) std::fill_n(image.row<uint8_t>(p.originOf(panel).y + y) + 3 * (p.originOf(panel).x + x), 3, uint8_t{0});
  return image;
}

}  // namespace

FigureContent makeProjectionsFigure(const FigureSettings& figure) {
  const struct {
    EnvironmentProjection projection;
    const char* title;
    double side;  // of a panel of the map, of the picture's width
  } kMaps[] = {{EnvironmentProjection::Latlong, "latitude-longitude", 0.5},
               {EnvironmentProjection::Sphere, "sphere map", 0.75},
               {EnvironmentProjection::Cube, "cube map", 0.25},
               {EnvironmentProjection::Paraboloid, "dual paraboloid", 0.5}};
  raster::Parallel parallel(figure.raster.threads);
  const EnvironmentMap sky = makeSky(std::max(8, figure.width / 2), figure.raster.threads);
  FigureContent out;
  out.columns = 2;
  out.numbers.columns = {"projection", "image", "texels that show something", "largest / least solid angle", "there and back: RMSE of displayed values"};
  bool whole = true;
  double worst = 0;
  for (const auto& m : kMaps) {
    const int side = std::max(4, int(figure.width * m.side));
    const bool wide = m.projection == EnvironmentProjection::Latlong;
    const EnvironmentMap shown = engine::convertEnvironment(sky, {m.projection, wide ? 2 * side : side, side}, parallel);
    out.panels.push_back({m.title, pictureOf(shown)});
    // Compared at as many texels as the sky has.
    const EnvironmentProjector same = engine::projectorOfTexels(m.projection, engine::usedTexels(sky.projector()));
    const double lost = engine::compareEnvironments(sky, engine::convertEnvironment(sky, same, parallel), parallel).clamped;
    const SolidAngles angles = solidAnglesOf(same);
    whole &= std::fabs(angles.sum / 12.566370614359172 - 1) < 2e-3;
    worst = std::max(worst, lost);
    out.numbers.rows.push_back({nameOf(kProjectionNames, m.projection), std::to_string(same.imageWidth()) + " x " + std::to_string(same.imageHeight()),
                                std::to_string(int(engine::usedTexels(same))), number(angles.largest / angles.least), number(lost)});
  }
  out.claims = {{"each shows all directions: the solid angles of its texels add up to 4 pi", whole},
                {"any one becomes any other: there and back at as many texels loses at most " + number(worst), worst < 0.06}};
  return out;
}

}  // namespace obscura::apps
