#include "obscura/apps/outputs.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include "obscura/apps/pictures.h"

namespace obscura::apps {
namespace {

using engine::Aov;
using engine::Error;
using engine::ErrorCode;
using engine::FileFormat;
using engine::Result;

bool isId(Aov aov) { return aov == Aov::Triangle || aov == Aov::Instance || aov == Aov::Material; }

Error usage(const std::string& message, const std::string& path) { return {ErrorCode::Usage, message, path, ""}; }

std::string shownName(const std::string& path) { return path == "-" ? "standard output" : path; }

Result<FileFormat> formatOf(const std::string& path, const std::string& standardOutput) {
  const std::string name = path == "-" ? "x." + (standardOutput.empty() ? "png" : standardOutput) : path;
  const Result<FileFormat> format = engine::fileFormatOf(name);
  if (format && *format != FileFormat::Other) return format;
  return usage("not a format that can be written; there are .png, .exr, .pfm and .npy", path);
}

// "out/demo.png" -> "out/demo.depth.png"
std::string withAov(const std::string& path, Aov aov) {
  const size_t dot = path.rfind('.');
  return path.substr(0, dot) + "." + engine::infoOf(aov).name + path.substr(dot);
}

Result<engine::Done> planOne(const std::string& path, const OutputRequest& request, std::vector<Output>& out) {
  const Result<FileFormat> format = formatOf(path, request.format);
  if (!format) return format.error();
  for (Aov aov : request.aovs)
    if (*format == FileFormat::Pfm && isId(aov))
      return usage(std::string("a PFM cannot hold the ids of \"") + engine::infoOf(aov).name + "\"; write .npy or .exr",
                   path);
  if (engine::holdsLayers(*format) || request.aovs.size() == 1) {
    out.push_back({path, *format, request.aovs});
    return engine::Done{};
  }
  if (path == "-")
    return usage("only one image fits there: name one --aov, or --format exr for all as layers", shownName(path));
  for (Aov aov : request.aovs) out.push_back({withAov(path, aov), *format, {aov}});
  return engine::Done{};
}

std::string systemError() { return std::strerror(errno); }

}  // namespace

Result<std::vector<Output>> planOutputs(const OutputRequest& request) {
  std::vector<Output> out;
  for (const std::string& path : request.outputs)
    if (const auto planned = planOne(path, request, out); !planned) return planned.error();
  if (!request.picture.empty()) {
    const Result<FileFormat> format = formatOf(request.picture, request.format);
    if (!format) return format.error();
    out.push_back({request.picture, *format, {Aov::Color}});
  }
  if (!request.stages.empty()) {
    const Result<FileFormat> format = formatOf(request.stages, "png");
    if (!format) return format.error();
    if (*format != FileFormat::Png) return usage("the stages are written as .png only", request.stages);
    out.push_back({request.stages, *format, {}, true});
  }
  std::set<std::string> names;
  for (const Output& o : out)
    if (!names.insert(o.path).second) return usage("more than one output is to be written there", shownName(o.path));
  if (!request.format.empty() && names.count("-") == 0) return usage("--format is for standard output only: -o -", "");
  return out;
}

Result<engine::Done> checkWritable(const std::string& path) {
  if (path == "-") return engine::Done{};
  const auto cannot = [&](const std::string& why) {
    return Error{ErrorCode::CannotWrite, "cannot write: " + why, path, ""};
  };
  struct stat info = {};
  const bool exists = stat(path.c_str(), &info) == 0;
  if (!exists && errno != ENOENT) return cannot(systemError());
  if (exists && S_ISDIR(info.st_mode)) return cannot("it is a folder");
  if (exists && access(path.c_str(), W_OK) != 0) return cannot(systemError());
  if (exists && !S_ISREG(info.st_mode)) return engine::Done{};
  const size_t slash = path.rfind('/');
  const std::string folder = slash == path.npos ? "." : path.substr(0, slash + 1);
  if (stat(folder.c_str(), &info) != 0) return cannot(errno == ENOENT ? "there is no folder " + folder : systemError());
  // A link's file may be elsewhere; where that cannot be written, the write itself says so.
  if (access(folder.c_str(), W_OK | X_OK) != 0) return cannot(systemError());
  return engine::Done{};
}

std::vector<Aov> aovsToRender(const std::vector<Aov>& aovs, const std::vector<Output>& outputs) {
  std::set<Aov> all(aovs.begin(), aovs.end());
  all.insert(Aov::Depth);  // tells what is covered
  for (const Output& o : outputs) {
    all.insert(o.aovs.begin(), o.aovs.end());
    if (o.stages) all.insert({Aov::Normal, Aov::Albedo, Aov::Obscurance, Aov::Transfer, Aov::Color});
  }
  return {all.begin(), all.end()};
}

Result<std::vector<uint8_t>> encodeOutput(const Output& output, const engine::Frame& frame, int bits) {
  std::vector<engine::Layer> layers;
  if (output.stages) layers.push_back({"color", {"R", "G", "B"}, stagesPicture(frame)});
  for (Aov aov : output.aovs) {
    const engine::AovInfo& info = engine::infoOf(aov);
    const bool asPicture = output.format == FileFormat::Png;
    layers.push_back({info.name, info.channels, asPicture ? picture(frame, aov, bits) : planeImage(frame, aov)});
  }
  engine::Placement place;
  if (!output.stages) place = {frame.x, frame.y, frame.imageWidth, frame.imageHeight};
  return engine::encodeImage(output.format, layers, shownName(output.path), place);
}

}  // namespace obscura::apps
