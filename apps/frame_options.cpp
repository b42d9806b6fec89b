#include "obscura/apps/frame_options.h"

#include <algorithm>
#include <vector>

#include "obscura/apps/light_options.h"
#include "obscura/apps/option_adders.h"
#include "obscura/apps/option_text.h"
#include "obscura/apps/setting_names.h"
#include "obscura/raster/exact_math.h"
#include "obscura/raster/view.h"

namespace obscura::apps {
namespace {

constexpr int kMaxThreads = 1024;

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
  // Before the options that it chooses for: CLI11 hands values on in the order of the options, so that these have the last word.
  addRead(app, "--quality", "draft|standard|high|reference|paper",
          "how much time estimator, samples, steps, layers and filter guide may take: rays marched with (n, m) of (1, 2), (4, 3), "
          "(8, 8), or (16, 8) in two layers; or the papers' shader, n = 8; options of your own go on top [" +
              nameOf(kQualityNames, o.quality) + "]",
          [&o](const std::string& text) {
            for (const auto& [name, quality] : kQualityNames)
              if (name == text) return post::setQuality(o.transfer, o.quality = quality), true;
            return false;
          })
      ->group(group);
  addInteger(app, "--samples", 1, 64, o.transfer.samples,
             "n, rays per pixel [" + std::to_string(o.transfer.samples) + "]")
      ->group(group);
  addInteger(app, "--steps", 1, post::kMaxSteps, o.transfer.steps,
             "m, test points per ray [" + std::to_string(o.transfer.steps) + "]")
      ->group(group);
  addLength(app, "--radius", false, o.radius, "R, how far occluders reach",
            fraction(engine::kDefaultRadius, "the scene's size (the diagonal of its bounds)"))->group(group);
  addChoice(app, "--membership", kMembershipNames, o.transfer.membership, "how open a direction is by the distance of its occluder")->group(group);
  addLength(app, "--bias", true, o.bias, "how deep behind a surface counts as inside; to march: how far above the tangent plane what stops a ray stands",
            fraction(engine::kDefaultBias, "R"))
      ->group(group);
  addChoice(app, "--silhouette-bound", onOff, o.transfer.silhouetteBound,
            "what lies R or more before a test point does not block it; off: it does, and casts false silhouettes")
      ->group(group);
  addChoice(app, "--estimator", kEstimatorNames, o.transfer.estimator,
            "where the rays come from: one set for all pixels, a Sobol net dealt to a 4x4 pattern, or one that suits its box; "
            "rays through the eye, tested all along (linear membership); or the box's, marched through the depth map")
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
    checkLight(*this);
    if (std::max(width, height) <= raster::kMaxImageSize / supersample) return;
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    throw CLI::ValidationError("--supersample", size(width, height) + " pixels times " + std::to_string(supersample) +
                                                    " are " + size(width * supersample, height * supersample) +
                                                    " sub-pixels; there can be " +
                                                    std::to_string(raster::kMaxImageSize) +
                                                    " a side: choose a smaller --size or --supersample");
  });
  addView(app, *this);
  addLight(app, *this);
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
  out.frame.background = background;
  out.frame.tone = tone;
  if (const auto done = resolveLight(*this, in, out.frame); !done) return done.error();
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
