#include "obscura/apps/light_options.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/apps/cache_folder.h"
#include "obscura/apps/option_adders.h"
#include "obscura/apps/option_text.h"
#include "obscura/apps/setting_names.h"
#include "obscura/engine/extended_ambient.h"
#include "obscura/raster/parallel.h"

namespace obscura::apps {
namespace {

engine::SceneLight farLight(const char* name, const glm::dvec3& direction, const glm::vec3& color, bool shadows) {
  engine::SceneLight light;
  light.name = name;
  const double longest = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  light.direction = glm::normalize(direction / longest);
  light.color = color;
  light.shadows = shadows;
  return light;
}

// A colour and a kind, which cannot be confused.
void addAmbientLight(CLI::App& app, FrameOptions& o) {
  const auto read = [&o](const std::vector<std::string>& texts) {
    int colors = 0, kinds = 0;
    for (const std::string& text : texts) {
      const std::optional<glm::vec3> color = colorOf(text);
      if (color) o.ambientLight = color;
      else if (text == "constant") o.ambientKind = AmbientKind::Constant;
      else if (text == "extended") o.ambientKind = AmbientKind::Extended;
      else if (text == "environment") o.ambientKind = AmbientKind::Environment;
      else throw CLI::ValidationError("--ambient-light", "\"" + text + "\" is not R,G,B, #RRGGBB, constant, extended or environment");
      if (++(color ? colors : kinds) > 1)
        throw CLI::ValidationError("--ambient-light", "\"" + text + "\" is the second of its kind");
    }
  };
  app.add_option_function<std::vector<std::string>>(
         "--ambient-light", read,
         "R,G,B|#RRGGBB: the light that comes from everywhere, linear or sRGB [1,1,1; extended: what the scene emits; where "
         "nothing does, as much that it is 1 on average]. environment: that of --environment FILE, which is so with that option anyway. extended: that "
         "light, and what the scene's surfaces send each other, by the direction of normals. A colour and one of the words may be given")
      ->type_name("COLOR|constant|extended|environment")
      ->allow_extra_args(false)
      ->group("View");
}

void addAmbientVariants(CLI::App& app, FrameOptions& o) {
  const auto addNodes = [&o](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      if (!addNodeColor(text, o.ambientNodes))
        throw CLI::ValidationError("--ambient-node", "\"" + text + "\" is not NAME=COLOR");
  };
  app.add_option_function<std::vector<std::string>>(
         "--ambient-node", addNodes,
         "ambient light of the node of this name and all below it, where rooms differ; repeatable; COLOR as above [as the "
         "file's nodes say, else --ambient-light]")
      ->type_name("NAME=COLOR")
      ->allow_extra_args(false)
      ->group("View");
  addRead(app, "--ambient-classes", "4...256",
          "how many directions --ambient-light extended tells surfaces apart by: C of the paper; with more of them they send each other more alike [6]",
          [&o](const std::string& text) {
            o.ambientClasses = numberOf<int>(text);
            return o.ambientClasses && *o.ambientClasses >= engine::kLeastClasses && *o.ambientClasses <= engine::kMostClasses;
          })
      ->group("View");
  addRead(app, "--ambient-directional", "PX/NX/PY/NY/PZ/NZ",
          "factors on the ambient light by the direction of a surface: six colours, of surfaces that face +x, -x, +y, -y, +z "
          "and -z of the world; others get a mean [none]",
          [&o](const std::string& text) { return bool(o.ambientDirections = sixColorsOf(text)); })
      ->group("View");
}

void addEnvironment(CLI::App& app, FrameOptions& o) {
  const char* group = "Environment";
  EnvironmentOptions& e = o.environment;
  CLI::Option* file = app.add_option("--environment", e.file,
                                     "ambient light from a map, any image, in place of a colour of --ambient-light: .hdr, .exr, .png, ... [none]")
                          ->type_name("FILE")
                          ->group(group);
  addChoice(app, "--env-projection", kProjectionNames, e.projection, "of the map: how directions lie in it")->needs(file)->group(group);
  const auto inRange = [](double least, double most, double& value) {
    return [=, &value](const std::string& text) {
      const std::optional<double> v = numberOf<double>(text);
      if (v && *v >= least && *v <= most) value = *v;
      return v && *v >= least && *v <= most;
    };
  };
  addRead(app, "--env-rotate", "DEGREES", "turns the map around the vertical (+y), counter-clockwise seen from above [0]",
          inRange(-engine::kMostRotation, engine::kMostRotation, e.rotation))
      ->needs(file)
      ->group(group);
  app.add_option("--env-cache", e.cache,
                 "folder to keep what is made of the map in, by the hash of its file [$OBSCURA_CACHE, else $XDG_CACHE_HOME/obscura, "
                 "else ~/.cache/obscura]; none: it is made again each time")
      ->type_name("DIR|none")
      ->needs(file)
      ->group(group);
  addRead(app, "--env-intensity", "FACTOR", "on the map's radiance, 0 to 10^6 [1]", inRange(0, engine::kMostIntensity, e.intensity))
      ->needs(file)
      ->group(group);
}

void addLights(CLI::App& app, FrameOptions& o) {
  const char* group = "Lights";
  LightOptions& l = o.light;
  addChoice(app, "--lights", {{"file", true}, {"none", false}}, l.ofFile, "whether the file's lights shine; those below do in any case")->group(group);
  CLI::Option* sun = addRead(app, "--sun", "X,Y,Z", "a light from far away, with shadows: the direction to it [none]",
                             [&l](const std::string& text) {
                               l.sun = vectorOf(text);
                               const double longest = l.sun ? std::max({std::fabs(l.sun->x), std::fabs(l.sun->y), std::fabs(l.sun->z)}) : 0;
                               return longest > 1e-100 && longest < 1e100;
                             });
  sun->group(group);
  addRead(app, "--sun-light", "COLOR", "its light in lux, R,G,B linear or #RRGGBB; pi makes white as bright as ambient light of 1 [pi,pi,pi]",
          [&l](const std::string& text) {
            const std::optional<glm::vec3> color = colorOf(text);
            if (color) l.sunColor = *color;
            return color && std::max({color->x, color->y, color->z}) <= engine::kMostLight;
          })
      ->needs(sun)
      ->group(group);
  addRead(app, "--headlight", "LUX", "a white light that shines where the camera looks, without shadows, up to 10^15 [0]",
          [&l](const std::string& text) {
            const std::optional<double> lux = numberOf<double>(text);
            if (lux) l.headlight = *lux;
            return lux && *lux >= 0 && *lux <= double(engine::kMostLight);
          })
      ->group(group);
  addChoice(app, "--shadows", {{"on", true}, {"off", false}}, l.shadows, "what stands in the way of these lights casts shadows")->group(group);
  addInteger(app, "--shadow-size", 16, engine::kMostShadowSize, l.shadowSize,
             "texels a side of a shadow map [" + std::to_string(l.shadowSize) + "]")
      ->group(group);
}

}  // namespace

void addLight(CLI::App& app, FrameOptions& o) {
  addAmbientLight(app, o);
  addAmbientVariants(app, o);
  addEnvironment(app, o);
  addLights(app, o);
}

void checkLight(const FrameOptions& o) {
  if (o.environment.background && o.environment.file.empty())
    throw CLI::ValidationError("--background", "environment needs --environment FILE");
  if (o.ambientKind == AmbientKind::Environment && o.environment.file.empty())
    throw CLI::ValidationError("--ambient-light", "environment is the light of a map: name its file, --environment FILE");
  if (o.ambientKind == AmbientKind::Constant && !o.environment.file.empty())
    throw CLI::ValidationError("--ambient-light", "constant and --environment cannot be had at once: say environment or extended, or leave one out");
  if (o.ambientClasses && o.ambientKind != AmbientKind::Extended) throw CLI::ValidationError("--ambient-classes", "these are of --ambient-light extended: add that");
  if (!o.environment.file.empty() && o.ambientLight)
    throw CLI::ValidationError("--ambient-light", "a colour and --environment cannot be had at once: each is all the light that comes from outside");
}

namespace {

// The light that the scene's surfaces send each other, besides the ambient light that `frame` has.
engine::Result<engine::Done> extend(const FrameOptions& o, const engine::Scene& scene, engine::FrameSettings& frame) {
  std::vector<engine::SceneLight> lights = o.light.ofFile ? scene.lights : std::vector<engine::SceneLight>();
  lights.insert(lights.end(), frame.lights.begin(), frame.lights.end());
  const engine::BouncedLight direct(scene, lights, o.light.shadows, o.raster);
  const int classes = o.ambientClasses.value_or(6);
  raster::Parallel parallel(o.raster.threads);
  auto directions = frame.environment
                        ? engine::extendedEnvironment(scene, {*frame.environment, frame.environmentRotation, frame.environmentIntensity}, o.raster, &direct, classes, frame.ambientDirections)
                        : engine::extendedAmbient(scene, o.ambientLight ? std::optional<glm::dvec3>(*o.ambientLight) : std::nullopt, parallel, &direct, classes, frame.ambientDirections);
  if (!directions) return directions.error();
  frame.ambientLight = glm::vec3(1);
  frame.ambientDirections = std::move(*directions);
  return engine::Done{};
}

}  // namespace

engine::Result<engine::Done> resolveLight(const FrameOptions& o, const engine::Scene& scene, engine::FrameSettings& frame) {
  frame.ambientLight = o.ambientLight.value_or(glm::vec3(1));
  if (o.ambientDirections) frame.ambientDirections = engine::cubeOf(*o.ambientDirections);
  frame.sceneLights = o.light.ofFile;
  frame.shadows = o.light.shadows;
  frame.shadowSize = o.light.shadowSize;
  if (o.light.sun) frame.lights.push_back(farLight("sun", -*o.light.sun, o.light.sunColor, true));
  if (o.light.headlight > 0)
    frame.lights.push_back(farLight("headlight", -glm::transpose(glm::dmat3(frame.camera.viewFromWorld))[2], glm::vec3(float(o.light.headlight)), false));
  if (!o.environment.file.empty()) {
    engine::Result<engine::Environment> read =
        engine::readEnvironment(o.environment.file, o.environment.projection,
                                isGlossy(o.brdf)           ? engine::EnvironmentParts::Reflections
                                : o.environment.background ? engine::EnvironmentParts::Background
                                                         : engine::EnvironmentParts::Light,
                                o.raster.threads,
                                o.environment.cache ? (*o.environment.cache == "none" ? "" : *o.environment.cache) : defaultCacheFolder());
    if (!read) return read.error();
    frame.environment = std::make_shared<const engine::Environment>(std::move(*read));
    frame.environmentRotation = o.environment.rotation;
    frame.environmentIntensity = o.environment.intensity;
    frame.environmentBackground = o.environment.background;
  }
  return o.ambientKind == AmbientKind::Extended ? extend(o, scene, frame) : engine::Done{};
}

}  // namespace obscura::apps
