#include "obscura/apps/figures_command.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "obscura/apps/figure_page.h"
#include "obscura/apps/figure_stage.h"
#include "obscura/apps/option_text.h"
#include "obscura/apps/outputs.h"
#include "obscura/apps/progress.h"
#include "obscura/apps/report.h"
#include "obscura/apps/signals.h"
#include "obscura/engine/image_file.h"
#include "obscura/raster/parallel.h"

namespace obscura::apps {
namespace {

using engine::Done;
using engine::Error;
using engine::ErrorCode;
using engine::Result;

constexpr int kLeastPanel = 120, kLargestPanel = 2048;

constexpr const char* kFiguresExamples = R"(Examples:
  obscura figures -o figures                     all of them; look at figures/index.html
  obscura figures -o figures --only snow --size 800x600
  obscura figures --list

Each becomes NAME.png and NAME.csv; index.html shows those of this run. What a figure argues is checked
with its numbers, and printed.

Exit codes: 0 done, 1 a figure does not show what it argues, 2 usage, 3 bad input, 4 cannot write, 128+n ended by signal n.
)";

Result<Done> writeText(const std::string& path, const std::string& text) {
  return engine::writeFileAtomically(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

Result<Done> writeFiles(const std::string& stem, const FigureContent& content) {
  const engine::Image sheet = engine::contactSheet(content.panels, content.columns);
  Result<std::vector<uint8_t>> png = engine::encodeImage(engine::FileFormat::Png, {{"color", {"R", "G", "B"}, sheet}}, stem + ".png");
  if (!png) {
    Error error = png.error();
    error.code = ErrorCode::CannotWrite;
    return error;
  }
  if (const auto done = engine::writeFileAtomically(stem + ".png", *png); !done) return done;
  return writeText(stem + ".csv", csvOf(content.numbers));
}

}  // namespace

void FiguresCommand::addTo(CLI::App& program) {
  CLI::App& c = *program.add_subcommand("figures", "makes every figure of the papers, with scenes of its own");
  c.footer(kFiguresExamples);
  c.add_option("-o,--output", folder_, "folder to write to; it is made if it is not there")->type_name("DIR");
  c.add_option("--only", only_, "this figure alone, repeatable [all of them]")->type_name("NAME")->allow_extra_args(false);
  c.add_option("--size", size_, "of a panel in pixels, 120 to 2048 a side [480x360]")->type_name("WxH");
  c.add_option("--threads", settings_.raster.threads, "0: one per core; changes no bit [0]")->check(CLI::Range(0, 1024))->type_name("0...1024");
  c.add_flag("--list", list_, "prints the names and what they are, makes nothing");
  c.add_flag("--quiet", quiet_, "no progress bar");
}

Result<std::vector<const Figure*>> FiguresCommand::chosen() const {
  std::vector<const Figure*> all;
  for (const Figure& f : allFigures())
    if (only_.empty() || std::find(only_.begin(), only_.end(), f.name) != only_.end()) all.push_back(&f);
  for (const std::string& name : only_) {
    if (std::any_of(all.begin(), all.end(), [&](const Figure* f) { return f->name == name; })) continue;
    std::string known;
    for (const Figure& f : allFigures()) known += (known.empty() ? "" : ", ") + std::string(f.name);
    return Error{ErrorCode::Usage, "--only: no figure \"" + name + "\"; there are " + known, "", ""};
  }
  return all;
}

Result<Done> FiguresCommand::prepareFolder() {
  if (folder_.empty()) return Error{ErrorCode::Usage, "nothing to do: add -o DIR or --list", "", ""};
  if (mkdir(folder_.c_str(), 0777) != 0 && errno != EEXIST)
    return Error{ErrorCode::CannotWrite, std::string("cannot make the folder: ") + std::strerror(errno), folder_, ""};
  return checkWritable(folder_ + "/index.html");
}

int FiguresCommand::run() {
  int code = kDone;
  raster::withThreads(settings_.raster.threads, [&] { code = make(); });
  return code;
}

int FiguresCommand::make() {
  endCleanlyOnSignals();
  const Result<std::vector<const Figure*>> figures = chosen();
  if (!figures) return fail(figures.error());
  int &w = settings_.width, &h = settings_.height;
  if (!size_.empty() && !(readSize(size_, w, h) && std::min(w, h) >= kLeastPanel && std::max(w, h) <= kLargestPanel))
    return fail({ErrorCode::Usage, "--size: \"" + size_ + "\" is not WxH of 120 to 2048 a side", "", ""});
  if (list_) {
    for (const Figure* f : *figures) std::printf("%-12s %s (%s)\n", f->name, f->title, f->source);
    return std::fflush(stdout) == 0 ? kDone : kCannotWrite;
  }
  if (const auto ready = prepareFolder(); !ready) return fail(ready.error());

  Progress progress(int(figures->size()), quiet_);
  std::vector<MadeFigure> made;
  for (const Figure* figure : *figures) {
    progress.step(figure->name);
    made.push_back({figure, figure->make(settings_)});
    const auto written = writeFiles(folder_ + "/" + figure->name, made.back().content);
    if (!written) return progress.finish(), fail(written.error());
    made.back().content.panels.clear();
  }
  const auto written = writeText(folder_ + "/index.html", pageOf(made));
  progress.finish();
  if (!written) return fail(written.error());

  std::string wrong;
  for (const MadeFigure& m : made)
    for (const FigureClaim& claim : m.content.claims) {
      std::printf("%s: %s%s\n", m.figure->name, claim.text.c_str(), claim.holds ? "" : ": DOES NOT HOLD");
      if (!claim.holds && wrong.empty()) wrong = std::string(m.figure->name) + ": it does not hold that " + claim.text;
    }
  if (std::fflush(stdout) != 0) return fail({ErrorCode::CannotWrite, "cannot write", "standard output", ""});
  if (wrong.empty()) return kDone;
  std::fprintf(stderr, "obscura: error: %s\n", wrong.c_str());
  return kDiffers;
}

}  // namespace obscura::apps
