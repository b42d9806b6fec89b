// In: the command line's options that describe a frame.  Out: what engine::Renderer takes.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/engine/camera_choice.h"
#include "obscura/engine/frame.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/result.h"
#include "obscura/engine/scene.h"
#include "obscura/post/quality.h"
#include "obscura/raster/rasterizer.h"

namespace obscura::apps {

// A frame of one scene: with its camera, and lengths that suit its size.
struct ResolvedFrame {
  engine::FrameSettings frame;  // aovs and display are the program's business
  raster::Settings raster;
  bool reference = false;
};

// Extended: see engine::extendedAmbient, engine::extendedEnvironment.
enum class AmbientKind : uint8_t { Constant, Extended, Environment };

struct EnvironmentOptions {
  std::string file;  // empty: none
  engine::EnvironmentProjection projection = engine::EnvironmentProjection::Latlong;
  double rotation = 0, intensity = 1;  // as in engine::FrameSettings
  bool background = false;
  std::optional<std::string> cache;  // folder, or "none"; empty: defaultCacheFolder()
};

struct LightOptions {
  bool ofFile = true;
  std::optional<glm::dvec3> sun;     // direction to it, world space
  glm::vec3 sunColor{3.14159265f};   // lux
  double headlight = 0;              // lux
  bool shadows = true;
  int shadowSize = engine::FrameSettings().shadowSize;
};

// The members' initial values are the options' defaults and show up in --help: a program that wants others sets them
// before addTo(). The object must outlive the parsing.
struct FrameOptions {
  int width = 800, height = 600;
  int border = 0;
  std::optional<raster::Window> crop;
  int supersample = 1;
  int scene = -1;  // of the file; -1: its default
  engine::CameraRequest camera;
  glm::vec3 background{0};                // linear
  std::optional<glm::vec3> ambientLight;  // alike; empty: 1, or what engine::extendedAmbient() chooses
  std::optional<AmbientKind> ambientKind;  // empty: Environment if there is one, else Constant
  std::optional<int> ambientClasses;      // of that; empty: 6
  std::optional<std::array<glm::vec3, 6>> ambientDirections;   // see engine::cubeOf
  std::vector<std::pair<std::string, glm::vec3>> ambientNodes;  // as in engine::LoadOptions
  EnvironmentOptions environment;
  LightOptions light;
  post::ToneSettings tone;
  bool displacement = true;
  post::Brdf brdf = post::Brdf::Gltf;
  post::Occlusion ambient = post::Occlusion::Transfer;
  post::Quality quality = post::Quality::Standard;
  post::AmbientSettings transfer;                          // but for three of the lengths below; set by `quality`, then by options of their own
  std::optional<double> radius, bias, filterThreshold;     // scene units; empty: a fraction of the scene's size
  std::optional<double> separation;                        // of the second depth layer, alike
  raster::Settings raster;
  bool reference = false;

  FrameOptions() { post::setQuality(transfer, quality); }

  // Values that cannot be are refused while parsing, with a CLI::ValidationError.
  void addTo(CLI::App& app);

  // What the scene must be loaded with.
  engine::LoadOptions load() const;

  // Usage: no such camera, or lengths that are no number in this scene. BadInput: an environment that cannot be read.
  engine::Result<ResolvedFrame> resolve(const engine::Scene& scene) const;
};

}  // namespace obscura::apps
