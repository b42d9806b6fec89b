// obscura: from a glTF scene to exact pixels. One subcommand a job.
#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

#include "obscura/apps/envmap_command.h"
#include "obscura/apps/figures_command.h"
#include "obscura/apps/render_command.h"
#include "obscura/apps/report.h"

namespace {

// Breaks descriptions between words, so that they fit beside their options on most terminals.
class WrappingFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    constexpr size_t kWidth = 80;
    std::string out, text = CLI::Formatter::make_option_desc(option);
    for (size_t end; text.size() > kWidth || text.find('\n') != text.npos; text.erase(0, end + 1)) {
      end = std::min(text.find('\n'), text.size());
      if (end > kWidth) end = std::min(text.rfind(' ', kWidth), text.size());
      out += text.substr(0, end) + "\n";
    }
    return out + text;
  }
};

template <class Command>
int runCommand(Command& command) try {
  return command.run();
} catch (const std::bad_alloc&) {
  return obscura::apps::fail(
      {obscura::engine::ErrorCode::BadInput, "not enough memory: try a smaller --size or fewer --aov", "", ""});
} catch (const std::exception& e) {  // threads that cannot be started, for instance
  return obscura::apps::fail({obscura::engine::ErrorCode::BadInput, e.what(), "", ""});
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Exact software rendering of glTF scenes: the same bytes on every machine.", "obscura"};
  app.footer("\"obscura COMMAND --help\" tells more, with examples.");
  app.require_subcommand(1);
  app.set_version_flag("--version", "obscura " OBSCURA_VERSION);
  app.formatter(std::make_shared<WrappingFormatter>());
  app.get_formatter()->column_width(36);
  obscura::apps::RenderCommand render;
  render.addTo(app);
  obscura::apps::EnvmapCommand envmap;
  envmap.addTo(app);
  obscura::apps::FiguresCommand figures;
  figures.addTo(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    const auto asked = app.get_subcommands();
    const std::string command = asked.empty() ? "render" : asked.front()->get_name();
    return obscura::apps::fail({obscura::engine::ErrorCode::Usage, std::string(e.what()) + " (see obscura " + command + " --help)", "", ""});
  }
  if (app.got_subcommand("envmap")) return runCommand(envmap);
  return app.got_subcommand("figures") ? runCommand(figures) : runCommand(render);
}
