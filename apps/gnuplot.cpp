#include "obscura/apps/gnuplot.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "obscura/engine/image_file.h"

namespace obscura::apps {
namespace {

std::string endingOf(const std::string& path) { return path.size() > 3 ? path.substr(path.find_last_of('.') + 1) : ""; }

// gnuplot's standard output on this script; empty if it cannot be run or fails.
std::vector<uint8_t> plotted(const std::string& script) {
  std::vector<uint8_t> out;
  std::error_code none;
  std::string name = (std::filesystem::temp_directory_path(none) / "obscura-plot-XXXXXX").string();
  const int file = none ? -1 : mkstemp(name.data());
  if (file < 0) return out;
  const bool written = write(file, script.data(), script.size()) == ssize_t(script.size());
  close(file);
  if (FILE* pipe = written ? popen(("gnuplot '" + name + "' 2> /dev/null").c_str(), "r") : nullptr) {
    uint8_t part[65536];
    while (const size_t n = std::fread(part, 1, sizeof part, pipe)) out.insert(out.end(), part, part + n);
    const int status = pclose(pipe);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) out.clear();
  }
  unlink(name.c_str());
  return out;
}

}  // namespace

std::string wrongPlotFile(const std::string& path) {
  const std::string ending = endingOf(path);
  return ending == "svg" || ending == "png" || ending == "gp" ? std::string() : "\"" + path + "\" is no .svg, .png or .gp";
}

std::string gnuplotText(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c >= ' ' ? c : ' ');
  return out + "\"";
}

std::string gnuplotLogAxis(const char* name, double least, double most) {
  char line[128];
  least = std::max(least, 1e-9) / 1.15, most = std::max(most, 1e-9) * 1.15;
  std::snprintf(line, sizeof line, "set %srange [%.6g:%.6g]\nset %stics (", name, least, most, name);
  std::string out = line;
  for (int power = -9; power <= 9; ++power)
    for (const int digit : {1, 2, 5}) {
      std::snprintf(line, sizeof line, "%s%de%d", out.back() == '(' ? "" : ", ", digit, power);
      out += line;
    }
  return out + ")\n";
}

engine::Result<engine::Done> writeGnuplot(const std::string& path, const std::function<std::string(const std::string&)>& script) {
  const std::string ending = endingOf(path), text = script(ending == "png" ? "pngcairo" : "svg");
  const std::vector<uint8_t> bytes = ending == "gp" ? std::vector<uint8_t>(text.begin(), text.end()) : plotted(text);
  if (bytes.empty())
    return engine::Error{engine::ErrorCode::CannotWrite, "gnuplot made no plot: is gnuplot-nox installed? FILE.gp is its script", path, ""};
  return engine::writeFileAtomically(path, {bytes.data(), bytes.size()});
}

}  // namespace obscura::apps
