// What a figure of the papers is to `obscura figures`.
#pragma once

#include <string>
#include <vector>

#include "obscura/engine/stages.h"
#include "obscura/raster/rasterizer.h"

namespace obscura::apps {

struct FigureSettings {
  int width = 480, height = 360;  // of a panel, pixels
  raster::Settings raster;        // changes no bit
};

struct FigureTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // as many as there are columns
};

// What the figure argues, as a statement about its numbers.
struct FigureClaim {
  std::string text;  // with the numbers
  bool holds = false;
};

struct FigureContent {
  std::vector<engine::Labelled> panels;
  int columns = 1;  // of panels
  FigureTable numbers;
  std::vector<FigureClaim> claims;
};

struct Figure {
  const char* name;    // of its files
  const char* title;
  const char* source;  // paper and figure
  const char* look;    // what to look for, in plain words
  FigureContent (*make)(const FigureSettings& settings);  // throws FigureError, std::bad_alloc
};

// In the order of the papers.
const std::vector<Figure>& allFigures();

FigureContent makeMembershipFigure(const FigureSettings& settings);
FigureContent makeContainmentFigure(const FigureSettings& settings);
FigureContent makeTreeFigure(const FigureSettings& settings);
FigureContent makeCarvedFigure(const FigureSettings& settings);
FigureContent makeInterleavingFigure(const FigureSettings& settings);
FigureContent makeSamplingFigure(const FigureSettings& settings);
FigureContent makeSilhouettesFigure(const FigureSettings& settings);
FigureContent makeReliefFigure(const FigureSettings& settings);
FigureContent makeHarbourFigure(const FigureSettings& settings);
FigureContent makeWhiteRoomFigure(const FigureSettings& settings);
FigureContent makeSnowFigure(const FigureSettings& settings);
FigureContent makeExtendedFigure(const FigureSettings& settings);
FigureContent makeHighlightFigure(const FigureSettings& settings);
FigureContent makeProjectionsFigure(const FigureSettings& settings);
FigureContent makeArmourFigure(const FigureSettings& settings);

}  // namespace obscura::apps
