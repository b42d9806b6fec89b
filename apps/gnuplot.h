// In: a script for gnuplot.  Out: its plot in a file.
#pragma once

#include <functional>
#include <string>

#include "obscura/engine/result.h"

namespace obscura::apps {

// For CLI11: empty, or why it is no name that writeGnuplot() takes.
std::string wrongPlotFile(const std::string& path);

std::string gnuplotText(const std::string& text);  // in double quotes

// Of a logarithmic axis, "x" or "y", that ends a little beyond the points, with a number at 1, 2 and 5 of every power of ten.
std::string gnuplotLogAxis(const char* name, double least, double most);

// script(terminal): begins with "set terminal " + terminal. The ending of `path` decides: .svg, .png, or .gp for the script
// itself. CannotWrite: also where gnuplot is not there.
engine::Result<engine::Done> writeGnuplot(const std::string& path, const std::function<std::string(const std::string&)>& script);

}  // namespace obscura::apps
