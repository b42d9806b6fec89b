#include "obscura/apps/render_command.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "obscura/apps/progress.h"
#include "obscura/apps/report.h"
#include "obscura/apps/signals.h"
#include "obscura/engine/gltf.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/stopwatch.h"

namespace obscura::apps {
namespace {

using engine::Aov;
using engine::Error;
using engine::ErrorCode;
using engine::Result;
using Bytes = std::vector<uint8_t>;

constexpr const char* kExamples = R"(Examples:
  obscura render scene.glb -o image.png
  obscura render scene.glb --size 1920x1080 --samples 16 --picture image.png -o planes.exr --aov all
  obscura render scene.glb --aov depth,normal -o planes.npy     writes planes.depth.npy and planes.normal.npy
  obscura render scene.glb --eye 3,2,5 --target 0,1,0 --fov 60 -o - | display
  obscura render scene.glb --digest --timings

Exit codes: 0 done, 2 usage, 3 bad input (also: nothing to be seen), 4 cannot write, 128+n ended by signal n.
)";

std::string aovHelp() {
  std::string s = "what to write and to digest, comma separated or repeated; all: every one [color]";
  for (const engine::AovInfo& info : engine::allAovs()) {
    const std::string name = info.name;
    s += "\n  " + name + std::string(name.size() < 12 ? 12 - name.size() : 1, ' ') + info.what;
  }
  return s;
}

// CLI::IsMember without the list that it adds to --help.
std::function<std::string(const std::string&)> oneOf(std::vector<std::string> names) {
  return [names = std::move(names)](const std::string& text) {
    if (std::find(names.begin(), names.end(), text) != names.end()) return std::string();
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return "\"" + text + "\" is none of " + list;
  };
}

Result<std::vector<Aov>> aovsOf(const std::vector<std::string>& names) {
  std::vector<Aov> aovs;
  const auto add = [&](Aov aov) {
    if (std::find(aovs.begin(), aovs.end(), aov) == aovs.end()) aovs.push_back(aov);
  };
  for (const std::string& name : names) {
    if (name == "all") {
      for (const engine::AovInfo& info : engine::allAovs()) add(info.aov);
      continue;
    }
    const std::optional<Aov> aov = engine::aovFromName(name);
    if (!aov) {
      std::string known;
      for (const engine::AovInfo& info : engine::allAovs()) known += std::string(info.name) + ", ";
      return Error{ErrorCode::Usage, "no AOV \"" + name + "\"; there are " + known + "all", "", ""};
    }
    add(*aov);
  }
  return aovs;
}

bool needsTextures(const std::vector<Aov>& aovs) {
  return std::any_of(aovs.begin(), aovs.end(), [](Aov aov) {
    return aov != Aov::Depth && aov != Aov::Position && aov != Aov::Triangle && aov != Aov::Instance &&
           aov != Aov::Material && aov != Aov::Depth2 && aov != Aov::DepthBack;
  });
}

bool isEmpty(const raster::Plane<float>& depth) {
  constexpr float kNothing = std::numeric_limits<float>::infinity();
  for (int y = 0; y < depth.height(); ++y)
    if (std::any_of(depth.row(y), depth.row(y) + depth.width(), [](float z) { return z < kNothing; })) return false;
  return true;
}

Error nothingVisible(const engine::Scene& scene, bool crop, const std::string& file) {
  if (crop)
    return {ErrorCode::BadInput, "nothing is visible in this crop: choose another, or accept it with --allow-empty", file, ""};
  const auto point = [](const glm::dvec3& p) {
    char text[96];
    std::snprintf(text, sizeof text, "%.3g,%.3g,%.3g", p.x, p.y, p.z);
    return std::string(text);
  };
  const std::string where =
      scene.bounds.empty ? "" : " (the scene spans " + point(scene.bounds.min) + " to " + point(scene.bounds.max) + ")";
  return {ErrorCode::BadInput,
          "nothing is visible from this camera: choose another --camera, or --eye and --target" + where +
              ", or accept it with --allow-empty",
          file, ""};
}

int print(const std::string& text, FILE* stream) {
  if (std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0) return kDone;
  return fail({ErrorCode::CannotWrite, std::string("cannot write: ") + std::strerror(errno), "standard output", ""});
}

}  // namespace

void RenderCommand::addTo(CLI::App& program) {
  CLI::App& c = *program.add_subcommand("render", "renders a glTF scene with the ambient transfer function");
  c.footer(kExamples);
  c.add_option("SCENE", scene_, "a .gltf or .glb file")->required()->type_name("");

  const char* output = "Output";
  c.add_option("-o,--output", request_.outputs,
               "file to write, repeatable: .png, .exr (all AOVs as layers), .pfm or .npy ([H,W,C], float32 or uint32). "
               "Several AOVs to a format of one image become STEM.AOV.EXT. - is standard output")
      ->type_name("FILE")->allow_extra_args(false)->group(output);
  c.add_option("--aov", aovNames_, aovHelp())
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(output);
  c.add_option("--picture", request_.picture, "the colour alone to this file, whatever --aov says")
      ->type_name("FILE")
      ->group(output);
  c.add_option("--stages", request_.stages, "a PNG that shows depth, normal, albedo, O, W and the result side by side")
      ->type_name("FILE")->group(output);
  c.add_option("--bits", request_.bits,
               "of PNG channels [8]. color, albedo and emissive are sRGB-encoded; obscurance, transfer, metallic and roughness linear "
               "(1 is white); normals n/2 + 1/2; depth, position and ids false colours, always of 8 bits")
      ->check(oneOf({"8", "16"}))->type_name("8|16")->group(output);
  c.add_option("--format", request_.format, "of standard output [png]")
      ->check(oneOf({"png", "exr", "pfm", "npy"}))->type_name("png|exr|pfm|npy")->group(output);
  c.add_flag("--allow-empty", allowEmpty_, "an image in which nothing is seen is a warning, not an error")
      ->group(output);

  const char* report = "Report (on standard output; on standard error if an image goes there)";
  c.add_flag(
       "--digest", digest_,
       "a line NAME WxHxC TYPE HASH for each AOV, XXH3-128 of its values; after color also display, its sRGB bytes")
      ->group(report);
  c.add_flag("--stats", stats_, "what was drawn and what could be skipped")->group(report);
  c.add_flag("--timings", timings_, "milliseconds of each stage")->group(report);
  c.add_flag("--json", json_, "one JSON object of those three, or of all three if none is named")->group(report);
  c.add_flag("--quiet", quiet_, "no progress bar")->group(report);

  options_.addTo(c);
}

Result<std::vector<Output>> RenderCommand::plan() {
  const auto usage = [](const char* message) { return Error{ErrorCode::Usage, message, "", ""}; };
  if (json_ && !digest_ && !stats_ && !timings_) digest_ = timings_ = true, stats_ = !options_.reference;
  if (request_.outputs.empty() && request_.picture.empty() && request_.stages.empty() && !digest_ && !stats_ &&
      !timings_)
    return usage("nothing to do: add -o FILE, --stages FILE, --digest, --stats or --timings");
  if (stats_ && options_.reference) return usage("--reference counts no statistics: leave out --stats");
  if (aovNames_.empty()) aovNames_ = {"color"};
  Result<std::vector<Aov>> aovs = aovsOf(aovNames_);
  if (!aovs) return aovs.error();
  request_.aovs = *aovs;
  return planOutputs(request_);
}

Result<engine::Scene> RenderCommand::load(bool textures) const {
  engine::LoadOptions options = options_.load();
  options.textures = textures;
  return engine::sceneFromGltf(scene_, options);
}

// All files, before the first is written. A failure of any is a file that cannot be written.
Result<std::vector<Bytes>> RenderCommand::encode(const std::vector<Output>& outputs, const engine::Frame& frame) const {
  std::vector<Bytes> files(outputs.size());
  std::vector<std::optional<Error>> errors(outputs.size());
  raster::Parallel(options_.raster.threads).forRanges(outputs.size(), 1, [&](size_t begin, size_t end, int) {
    for (size_t i = begin; i < end; ++i) {
      Result<Bytes> file = encodeOutput(outputs[i], frame, request_.bits);
      if (file) files[i] = std::move(*file);
      else errors[i] = file.error();
    }
  });
  for (std::optional<Error>& error : errors) {
    if (!error) continue;
    error->code = ErrorCode::CannotWrite;
    return *error;
  }
  return files;
}

int RenderCommand::run() {
  int code = kDone;
  raster::withThreads(options_.raster.threads, [&] { code = render(); });
  return code;
}

int RenderCommand::render() {
  endCleanlyOnSignals();
  const Result<std::vector<Output>> outputs = plan();
  if (!outputs) return fail(outputs.error());
  for (const Output& o : *outputs)
    if (const auto writable = checkWritable(o.path); !writable) return fail(writable.error());

  const std::vector<Aov> aovs = aovsToRender(request_.aovs, *outputs);
  Progress progress(3, quiet_);
  const auto failed = [&](const Error& error) {
    progress.finish();
    return fail(error);
  };
  RunTimings run;
  raster::Stopwatch watch;

  progress.step("loading");
  const Result<engine::Scene> scene = load(needsTextures(aovs));
  if (!scene) return failed(scene.error());
  progress.clear();
  for (const std::string& warning : scene->warnings) printWarning(warning);
  run.load = watch.lap();

  progress.step("rendering");
  Result<ResolvedFrame> resolved = options_.resolve(*scene);
  if (!resolved) return failed(resolved.error());
  run.environment = watch.lap();
  progress.clear();
  if (resolved->frame.environment && resolved->frame.environment->clamped > 0)
    printWarning(options_.environment.file + ": " + std::to_string(resolved->frame.environment->clamped) +
                 " values are negative, no numbers or too large: clamped");
  resolved->frame.aovs = aovs;
  resolved->frame.display = std::find(aovs.begin(), aovs.end(), Aov::Color) != aovs.end();
  engine::Renderer renderer(resolved->raster, resolved->reference);
  engine::Frame frame;
  if (const auto done = renderer.render(*scene, resolved->frame, frame); !done) return failed(done.error());
  if (isEmpty(frame.g.depth)) {
    if (!allowEmpty_) return failed(nothingVisible(*scene, options_.crop.has_value(), scene_));
    progress.clear();
    printWarning(options_.crop ? "nothing is visible in this crop" : "nothing is visible from this camera");
  }

  progress.step("writing");
  watch.lap();
  const Result<std::vector<Bytes>> files = encode(*outputs, frame);
  if (!files) return failed(files.error());
  run.encode = watch.lap();
  Report report;
  if (digest_) report.digests = digestLines(frame, request_.aovs, options_.raster.threads);
  run.digest = watch.lap();
  for (size_t i = 0; i < files->size(); ++i)
    if (const auto done = engine::writeFileAtomically((*outputs)[i].path, (*files)[i]); !done)
      return failed(done.error());
  run.write = watch.lap();

  progress.finish();
  if (stats_) report.statistics = &frame.statistics, report.transfer = &frame.transferStatistics, report.lights = &frame.lightStatistics;
  if (timings_) report.frame = &frame.timings, report.run = &run;
  const bool imageOnStdout =
      std::any_of(outputs->begin(), outputs->end(), [](const Output& o) { return o.path == "-"; });
  return print(json_ ? jsonOf(report) : textOf(report), imageOnStdout ? stderr : stdout);
}

}  // namespace obscura::apps
