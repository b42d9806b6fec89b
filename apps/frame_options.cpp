#include "obscura/apps/frame_options.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "obscura/apps/cache_folder.h"
#include "obscura/apps/option_text.h"
#include "obscura/apps/setting_names.h"
#include "obscura/engine/extended_ambient.h"
#include "obscura/raster/exact_math.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/view.h"

namespace obscura::apps {
namespace {

constexpr int kMaxThreads = 1024;

// An option whose text `read` turns into a value; false: refused, with what was expected.
template <class Read>
CLI::Option* addRead(CLI::App& app, const std::string& name, const std::string& type, const std::string& what,
                     Read read) {
  const auto set = [name, type, read](const std::string& text) {
    if (!read(text)) throw CLI::ValidationError(name, "\"" + text + "\" is not " + type);
  };
  return app.add_option_function<std::string>(name, set, what)->type_name(type);
}

template <class T>
CLI::Option* addChoice(CLI::App& app, const std::string& name, const Names<T>& names, T& value,
                       const std::string& what) {
  std::string list, current;
  for (const auto& [text, v] : names) {
    list += (list.empty() ? "" : "|") + text;
    if (v == value) current = text;
  }
  return addRead(app, name, list, what + " [" + current + "]", [names, &value](const std::string& text) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == text; });
    if (found != names.end()) value = found->second;
    return found != names.end();
  });
}

CLI::Option* addInteger(CLI::App& app, const std::string& name, int least, int most, int& value,
                        const std::string& what) {
  const std::string type = std::to_string(least) + "..." + std::to_string(most);
  return addRead(app, name, type, what, [=, &value](const std::string& text) {
    const std::optional<int> n = numberOf<int>(text);
    if (!n || *n < least || *n > most) return false;
    value = *n;
    return true;
  });
}

CLI::Option* addLength(CLI::App& app, const std::string& name, bool zero, std::optional<double>& value,
                       const std::string& what, const std::string& otherwise) {
  const std::string is = value ? shown(*value) : otherwise;
  return addRead(app, name, "LENGTH", what + ", scene units [" + is + "]", [&value, zero](const std::string& text) {
    const std::optional<double> v = numberOf<double>(text);
    if (!v || !(zero ? *v >= 0 : *v > 0)) return false;
    value = v;
    return true;
  });
}

void addVector(CLI::App& app, const std::string& name, std::optional<glm::dvec3>& value, const std::string& what) {
  addRead(app, name, "X,Y,Z", what, [&value](const std::string& text) {
    return bool(value = vectorOf(text));
  })->group("View");
}

void addMatrix(CLI::App& app, const std::string& name, std::optional<glm::dmat4>& value, const std::string& what) {
  addRead(app, name, "M0,...,M15", what, [&value](const std::string& text) {
    glm::dmat4 m;
    if (!readNumbers(text, 16, &m[0][0])) return false;
    value = m;
    return true;
  })->group("View");
}

engine::SceneLight farLight(const char* name, const glm::dvec3& direction, const glm::vec3& color, bool shadows) {
  engine::SceneLight light;
  light.name = name;
  const double longest = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  light.direction = glm::normalize(direction / longest);
  light.color = color;
  light.shadows = shadows;
  return light;
}

raster::Target instructionSet(const std::string& text) {
  const std::optional<raster::Target> wanted = raster::targetFromName(text);
  const std::vector<raster::Target> here = raster::supportedTargets();
  if (wanted && (*wanted == raster::Target::Auto || std::find(here.begin(), here.end(), *wanted) != here.end()))
    return *wanted;
  std::string names = "auto";
  for (raster::Target t : here) names += std::string(", ") + raster::targetName(t);
  throw CLI::ValidationError("--target", "\"" + text +
                                             (wanted ? "\" is not there on this machine"
                                                     : "\" is neither a point X,Y,Z nor an instruction set") +
                                             "; there are: " + names);
}

// One name for two things that cannot be confused: the point a camera looks at, and the instruction set to run on.
void addTarget(CLI::App& app, FrameOptions& o) {
  const auto read = [&o](const std::vector<std::string>& texts) {
    int points = 0, names = 0;
    for (const std::string& text : texts) {
      const std::optional<glm::dvec3> point = vectorOf(text);
      if (point) o.camera.target = point;
      else o.raster.target = instructionSet(text);
      if (++(point ? points : names) > 1)
        throw CLI::ValidationError("--target", "\"" + text + "\" is the second of its kind");
    }
  };
  app.add_option_function<std::vector<std::string>>(
         "--target", read,
         "X,Y,Z: what the camera of your own looks at [the middle of the scene]. NAME: instruction set to run on, "
         "which changes no bit: auto, scalar, ssse3, sse4, avx2, avx3 or neon [auto: the best]. Both may be given")
      ->type_name("X,Y,Z|NAME")
      ->allow_extra_args(false)
      ->group("View");
}

// A colour and a kind, which cannot be confused.
void addAmbientLight(CLI::App& app, FrameOptions& o) {
  const auto read = [&o](const std::vector<std::string>& texts) {
    int colors = 0, kinds = 0;
    for (const std::string& text : texts) {
      const std::optional<glm::vec3> color = colorOf(text);
      if (color) o.ambientLight = color;
      else if (text == "extended" || text == "constant") o.ambientExtended = text == "extended";
      else throw CLI::ValidationError("--ambient-light", "\"" + text + "\" is not R,G,B, #RRGGBB, constant or extended");
      if (++(color ? colors : kinds) > 1)
        throw CLI::ValidationError("--ambient-light", "\"" + text + "\" is the second of its kind");
    }
  };
  app.add_option_function<std::vector<std::string>>(
         "--ambient-light", read,
         "R,G,B|#RRGGBB: the light that comes from everywhere, linear or sRGB [1,1,1; extended: what the scene emits; where "
         "nothing does, as much that it is 1 on average]. extended: and what the scene's surfaces send each other, by the direction of normals. Both may be given")
      ->type_name("COLOR|constant|extended")
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
                                     "light from a map, any image, in place of --ambient-light: .hdr, .exr, .png, ... [none]")
                          ->type_name("FILE")
                          ->excludes("--ambient-light")
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

void addDisplay(CLI::App& app, FrameOptions& o) {
  const char* group = "Display (of pictures: PNG and the digest display; the AOV color stays as it is)";
  addRead(app, "--exposure", "STOPS", "brighter by so many powers of two, -64 to 64 [0]",
          [&o](const std::string& text) {
            const std::optional<double> stops = numberOf<double>(text);
            if (!stops || !(*stops >= -64 && *stops <= 64)) return false;
            o.tone.exposure = float(raster::exactPow(2, *stops));
            return true;
          })
      ->group(group);
  addChoice(app, "--tonemap", kToneCurveNames, o.tone.curve, "how bright colours are brought into a screen's range: cut off, or by a curve")
      ->group(group);
}

void addView(CLI::App& app, FrameOptions& o) {
  const std::string size = std::to_string(o.width) + "x" + std::to_string(o.height);
  addRead(app, "--size", "WxH",
          "of the image in pixels, up to " + std::to_string(raster::kMaxImageSize) + " a side [" + size + "]",
          [&o](const std::string& text) { return readSize(text, o.width, o.height); })
      ->group("View");
  addRead(app, "--crop", "X,Y,WxH",
          "only this part of the image: W x H pixels, the first X from the left and Y from the top; each has the bits "
          "that it has in the whole image [all of it]",
          [&o](const std::string& text) { return bool(o.crop = cropOf(text)); })
      ->group("View");
  addInteger(app, "--border", 0, raster::kMaxImageSize / 2, o.border,
             "pixels around the image that are not in it but occlude what is [" + std::to_string(o.border) + "]")
      ->type_name("PIXELS")
      ->group("View");
  addChoice(app, "--supersample", {{"1", 1}, {"2", 2}, {"4", 4}}, o.supersample,
            "antialiasing: sub-pixels a side of a pixel. color, albedo, emissive, metallic, roughness, obscurance and transfer are "
            "their means, in linear light; depth, normal, position and ids those of the nearest one")
      ->group("View");
  app.add_option(
         "--camera", o.camera.name,
         "camera of the file, by its name, its node's name or its index [the first; without one: a view of everything]")
      ->type_name("NAME|INDEX")
      ->group("View");
  addVector(app, "--eye", o.camera.eye, "a camera of your own: where it is");
  addTarget(app, o);
  addVector(app, "--up", o.camera.up, "what is up for it [0,1,0]");
  addRead(app, "--fov", "DEGREES", "vertical field of view, between 0 and 180; replaces the file camera's, too [45]",
          [&o](const std::string& text) {
            o.camera.yFovDegrees = numberOf<double>(text);
            return o.camera.yFovDegrees && *o.camera.yFovDegrees > 0 && *o.camera.yFovDegrees < 180;
          })->group("View");
  addMatrix(app, "--view-matrix", o.camera.view,
            "instead of all other cameras, with --projection-matrix: from world to view space, which looks along -z; 16 "
            "numbers, column by column as in glTF");
  addMatrix(app, "--projection-matrix", o.camera.projection,
            "from view to clip space as in OpenGL, alike; perspective or orthographic, off-centre or not");
  addInteger(app, "--scene", 0, 1 << 30, o.scene, "which of the file's scenes [the default one]")
      ->type_name("INDEX")
      ->group("View");
  addRead(app, "--background", "R,G,B|#RRGGBB|environment",
          "what is where nothing is seen: a colour, R,G,B linear or #RRGGBB sRGB, or the environment [" + shown(o.background) + "]",
          [&o](const std::string& text) {
            const std::optional<glm::vec3> color = colorOf(text);
            o.environment.background = text == "environment";
            if (color) o.background = *color;
            return color || o.environment.background;
          })
      ->group("View");
  addChoice(app, "--displacement", {{"on", true}, {"off", false}}, o.displacement,
            "height maps of materials move what is seen; off: these surfaces are flat")
      ->group("View");
  addLength(app, "--separation", false, o.separation, "how far behind what is seen the AOV depth2 and the second layer begin",
            shown(engine::kDefaultSeparation) + " x R, with --layers 2 " + shown(engine::kLayerSeparation) + " x R")->group("View");
  addChoice(app, "--brdf", kBrdfNames, o.brdf,
            "how surfaces reflect: by metallic and roughness as glTF says; all alike from everywhere; or by Blinn-Phong's "
            "highlights, smooth or cut off sharply")
      ->group("View");
  addAmbientLight(app, o);
  addAmbientVariants(app, o);
}

void addAmbient(CLI::App& app, FrameOptions& o) {
  using post::Occlusion;
  using post::TransferAlbedo;
  const char* group = "Ambient transfer";
  const Names<bool> onOff = {{"on", true}, {"off", false}};
  const auto fraction = [](double f, const char* of) { return shown(f) + " x " + of; };
  addChoice(app, "--ambient",
            {{"off", Occlusion::None}, {"obscurance", Occlusion::Obscurance}, {"transfer", Occlusion::Transfer}},
            o.ambient, "what dims the ambient light: nothing, O or W")
      ->group(group);
  addChoice(app, "--albedo", {{"own", TransferAlbedo::Own}, {"neighbour", TransferAlbedo::Neighbour},
                              {"radiance", TransferAlbedo::Radiance}},
            o.transfer.albedo,
            "what W takes from what occludes: the pixel's own albedo, that of the occluder, or the radiance that the frame "
            "holds there (emission; ambient light and direct lights, reflected once)")
      ->group(group);
  addInteger(app, "--samples", 1, 64, o.transfer.samples,
             "n, rays per pixel [" + std::to_string(o.transfer.samples) + "]")
      ->group(group);
  addInteger(app, "--steps", 1, 4, o.transfer.steps,
             "m, test points per ray [" + std::to_string(o.transfer.steps) + "]")
      ->group(group);
  addLength(app, "--radius", false, o.radius, "R, how far occluders reach",
            fraction(engine::kDefaultRadius, "the scene's size (the diagonal of its bounds)"))->group(group);
  addChoice(app, "--membership", kMembershipNames, o.transfer.membership, "how open a direction is by the distance of its occluder")->group(group);
  addLength(app, "--bias", true, o.bias, "how deep behind a surface counts as inside",
            fraction(engine::kDefaultBias, "R"))
      ->group(group);
  addChoice(app, "--silhouette-bound", onOff, o.transfer.silhouetteBound,
            "what lies R or more before a test point does not block it; off: it does, and casts false silhouettes")
      ->group(group);
  addChoice(app, "--estimator", kEstimatorNames, o.transfer.estimator,
            "where the rays come from: one set for all pixels, a Sobol net dealt to a 4x4 pattern, or one that suits its box; "
            "or rays through the eye, tested all along (linear membership)")
      ->group(group);
  addChoice(app, "--layers", {{"1", 1}, {"2", 2}}, o.transfer.layers,
            "of depth that occlude: what is seen, or also what is next behind it")
      ->group(group);
  addChoice(app, "--interleave", onOff, o.transfer.interleave, "other rays in each pixel of a 4x4 pattern")
      ->group(group);
  addChoice(app, "--filter", onOff, o.transfer.filter, "4x4 box over pixels of nearly the same depth")->group(group);
  addChoice(app, "--filter-guide", kFilterGuideNames, o.transfer.filterGuide,
            "which pixels the filter adds up: those of nearly the same depth, or of the same plane and normal")
      ->group(group);
  addLength(app, "--filter-threshold", false, o.filterThreshold, "difference of depth that the filter stops at",
            fraction(engine::kDefaultFilterThreshold, "R"))->group(group);
}

void addExecution(CLI::App& app, FrameOptions& o) {
  const char* group = "Execution (changes no bit of the result; see also --target NAME)";
  addInteger(app, "--threads", 0, kMaxThreads, o.raster.threads,
             "0: one per core [" + std::to_string(o.raster.threads) + "]")
      ->group(group);
  addChoice(app, "--tile", {{"16", 16}, {"32", 32}, {"64", 64}}, o.raster.tile, "pixels a side of a tile")
      ->group(group);
  app.add_flag_callback(
         "--no-skip", [&o] { o.raster.skip = false; }, "cull nothing, rasterize every tile, follow every ray")
      ->group(group);
  app.add_flag("--reference", o.reference,
               "everything by the short scalar code that the fast one is checked against; slow")
      ->group(group);
}

}  // namespace

void FrameOptions::addTo(CLI::App& app) {
  app.parse_complete_callback([this] {
    if (environment.background && environment.file.empty())
      throw CLI::ValidationError("--background", "environment needs --environment FILE");
    if (ambientExtended && (ambientDirections || !environment.file.empty()))
      throw CLI::ValidationError("--ambient-light", std::string("extended and ") + (ambientDirections ? "--ambient-directional" : "--environment") +
                                                        " cannot be had at once: both say what comes from where");
    if (std::max(width, height) <= raster::kMaxImageSize / supersample) return;
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    throw CLI::ValidationError("--supersample", size(width, height) + " pixels times " + std::to_string(supersample) +
                                                    " are " + size(width * supersample, height * supersample) +
                                                    " sub-pixels; there can be " +
                                                    std::to_string(raster::kMaxImageSize) +
                                                    " a side: choose a smaller --size or --supersample");
  });
  addView(app, *this);
  addEnvironment(app, *this);
  addLights(app, *this);
  addDisplay(app, *this);
  addAmbient(app, *this);
  addExecution(app, *this);
}

engine::LoadOptions FrameOptions::load() const {
  engine::LoadOptions options;
  options.scene = scene;
  options.ambient = ambientNodes;
  return options;
}

engine::Result<ResolvedFrame> FrameOptions::resolve(const engine::Scene& in) const {
  ResolvedFrame out;
  engine::Result<raster::Camera> chosen = engine::chooseCamera(in, camera, width, height);
  if (!chosen) return chosen.error();
  const double r = radius.value_or(engine::kDefaultRadius * engine::sceneSize(in));
  out.frame.width = width;
  out.frame.height = height;
  out.frame.border = border;
  out.frame.crop = crop;
  out.frame.supersample = supersample;
  out.frame.camera = *chosen;
  out.frame.brdf = brdf;
  out.frame.ambient = ambient;
  out.frame.ambientLight = ambientLight.value_or(glm::vec3(1));
  out.frame.ambientDirections = ambientDirections;
  out.frame.sceneLights = light.ofFile;
  out.frame.shadows = light.shadows;
  out.frame.shadowSize = light.shadowSize;
  if (light.sun) out.frame.lights.push_back(farLight("sun", -*light.sun, light.sunColor, true));
  if (light.headlight > 0)
    out.frame.lights.push_back(farLight("headlight", -glm::transpose(glm::dmat3(chosen->viewFromWorld))[2], glm::vec3(float(light.headlight)), false));
  if (ambientExtended) {
    raster::Parallel parallel(raster.threads);
    std::vector<engine::SceneLight> lights = light.ofFile ? in.lights : std::vector<engine::SceneLight>();
    lights.insert(lights.end(), out.frame.lights.begin(), out.frame.lights.end());
    const engine::BouncedLight direct(in, lights, light.shadows, raster);
    const auto colors = engine::extendedAmbient(in, ambientLight ? std::optional<glm::dvec3>(*ambientLight) : std::nullopt, parallel, &direct);
    if (!colors) return colors.error();
    out.frame.ambientLight = glm::vec3(1);
    out.frame.ambientDirections = *colors;
  }
  out.frame.background = background;
  out.frame.tone = tone;
  if (!environment.file.empty()) {
    engine::Result<engine::Environment> read =
        engine::readEnvironment(environment.file, environment.projection,
                                isGlossy(brdf)           ? engine::EnvironmentParts::Reflections
                                : environment.background ? engine::EnvironmentParts::Background
                                                         : engine::EnvironmentParts::Light,
                                raster.threads,
                                environment.cache ? (*environment.cache == "none" ? "" : *environment.cache) : defaultCacheFolder());
    if (!read) return read.error();
    out.frame.environment = std::make_shared<const engine::Environment>(std::move(*read));
    out.frame.environmentRotation = environment.rotation;
    out.frame.environmentIntensity = environment.intensity;
    out.frame.environmentBackground = environment.background;
  }
  out.frame.transfer = transfer;
  out.frame.transfer.radius = float(r);
  out.frame.transfer.bias = float(bias.value_or(engine::kDefaultBias * r));
  out.frame.transfer.filterThreshold = float(filterThreshold.value_or(engine::kDefaultFilterThreshold * r));
  out.frame.displacement = displacement;
  out.frame.separation = float(separation.value_or((transfer.layers == 2 ? engine::kLayerSeparation : engine::kDefaultSeparation) * r));
  out.raster = raster;
  out.reference = reference;
  return out;
}

}  // namespace obscura::apps
