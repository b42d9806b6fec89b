// In: figures that are made.  Out: the page that shows them, and their numbers as CSV.
#pragma once

#include <string>
#include <vector>

#include "obscura/apps/figure.h"

namespace obscura::apps {

struct MadeFigure {
  const Figure* figure = nullptr;
  FigureContent content;  // the panels are not read
};

// Of the whole page; pictures are NAME.png beside it, numbers NAME.csv.
std::string pageOf(const std::vector<MadeFigure>& figures);

// Lines end with \n; cells that hold a comma or a quote are quoted (RFC 4180).
std::string csvOf(const FigureTable& table);

}  // namespace obscura::apps
