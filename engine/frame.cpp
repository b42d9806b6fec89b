#include "obscura/engine/frame.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <utility>

#include "obscura/engine/ambient_light.h"
#include "obscura/engine/crop.h"
#include "obscura/engine/direct_lights.h"
#include "obscura/engine/downsample_frame.h"
#include "obscura/engine/draw_list.h"
#include "obscura/engine/frame_needs.h"
#include "obscura/post/asked.h"
#include "obscura/post/environment_background.h"
#include "obscura/post/environment_reflection.h"
#include "obscura/post/transfer_samples.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/stopwatch.h"
#include "obscura/raster/view.h"

namespace obscura::engine {
struct Renderer::State {
  raster::Settings settings;
  bool reference;
  raster::Target target;
  raster::Rasterizer rasterizer;
  raster::Parallel parallel;
  post::DisplayTable table;
  SceneDraws draws;
  std::vector<glm::vec3> ambientOfInstances;
  post::AmbientLight ambient;
  post::LinearColor radiance;  // of what is drawn, for the transfer that reads it
  DirectLights lights;
  post::LinearColor drawnDirect, direct;  // of what is drawn, of what is given
  raster::Plane<float> whole;  // depth of image and border, where less is drawn
  std::vector<raster::ImplicitDraw> implicits;  // of the frame
  post::DepthBounds bounds;
  raster::Plane<uint8_t> asked;
  post::TransferSums sums;
  // Of a frame with border or crop more is drawn than is given: this window, and in it the part that is given.
  raster::Window window, part;
  raster::GBuffer drawn;
  post::Transfer drawnTransfer;
  // Planes of sub-pixels are large: two stages write over what nobody reads any more, the transfer over the normals and
  // light over the sums.
  bool overNormals = false, overSums = false;
  bool more() const { return window.width > part.width || window.height > part.height; }
  Frame subpixels;  // of a supersampled frame; empty after any other

  State(const raster::Settings& s, bool ref)
      : settings(s), reference(ref), target(raster::chooseTarget(s.target)), rasterizer(s), parallel(ref ? 1 : s.threads) {}

  void rasterize(const raster::DrawList& list, const FrameSettings& s, const raster::PlaneSet& planes, const raster::Window& w,
                 raster::GBuffer& out);
  raster::Window windowToDraw(const raster::DrawList& list, const FrameSettings& s, const FrameNeeds& needs);
  std::optional<post::AskedInput> asking(const FrameSettings& s, const FrameNeeds& needs, const raster::GBuffer& g) const;
  post::TransferStatistics transferSums(post::TransferInput& in, const std::optional<post::AskedInput>& question, int firstRow, int endRow);

  static constexpr size_t kRowsPerTask = 8;

  void drawGBuffer(const raster::DrawList& list, const FrameSettings& s, const FrameNeeds& needs, Frame& out);
  void drawDirect(const Scene& scene, const raster::DrawList& list, const FrameSettings& s, const FrameNeeds& needs, Frame& out);
  void drawTransfer(const FrameSettings& s, const FrameNeeds& needs, Frame& out);
  void drawLight(const FrameSettings& s, const FrameNeeds& needs, Frame& out);
  void drawBackground(const FrameSettings& s, Frame& out);
  void drawDisplay(const FrameSettings& s, Frame& out);

  // Calls body(y0, y1) for bands of the rows first ... end - 1, in parallel.
  template <class Body>
  void forRows(int first, int end, const Body& body) {
    parallel.forRanges(size_t(end - first), kRowsPerTask,
                       [&](size_t y0, size_t y1, int) { body(first + int(y0), first + int(y1)); });
  }
};

Renderer::Renderer(const raster::Settings& settings, bool reference) {
  const raster::FloatEnvironment environment;
  state_ = std::make_unique<State>(settings, reference);
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::State::rasterize(const raster::DrawList& list, const FrameSettings& s, const raster::PlaneSet& planes,
                                const raster::Window& w, raster::GBuffer& out) {
  if (reference) raster::renderReference(list, s.camera, s.width, s.height, planes, out, w);
  else rasterizer.render(list, s.camera, s.width, s.height, planes, out, w);
}

// A crop needs as much around it as the transfer's samples reach, and how far that is, the depth in it tells.
raster::Window Renderer::State::windowToDraw(const raster::DrawList& list, const FrameSettings& s, const FrameNeeds& needs) {
  if (!needs.sums) return outputWindow(s);
  if (!s.crop) return wholeWindow(s);
  raster::PlaneSet onlyDepth;
  onlyDepth.depth = true;
  raster::GBuffer g;
  rasterize(list, s, onlyDepth, filteredWindow(s), g);
  return transferWindow(s, nearestDepth(g.depth));
}

void Renderer::State::drawGBuffer(const raster::DrawList& list, const FrameSettings& s, const FrameNeeds& needs, Frame& out) {
  const raster::Window output = outputWindow(s);
  window = windowToDraw(list, s, needs);
  part = {output.x - window.x, output.y - window.y, output.width, output.height};
  rasterize(list, s, needs.planes, window, more() ? drawn : out.g);
  implicits = raster::makeImplicitDraws(list, s.camera);
  out.statistics = rasterizer.statistics();
  out.width = output.width, out.height = output.height;
  out.x = output.x, out.y = output.y;
  out.imageWidth = s.width, out.imageHeight = s.height;
}

// What may be left out as nobody reads it: around a crop, and where nothing is reflected. Empty where there is no such.
std::optional<post::AskedInput> Renderer::State::asking(const FrameSettings& s, const FrameNeeds& needs, const raster::GBuffer& g) const {
  if (reference || !settings.skip || !(needs.onlyLit || window.width > filteredWindow(s).width)) return std::nullopt;
  post::AskedInput question{&g, part, s.transfer.filter, needs.onlyLit, {}};
  if (!needs.radiance && !ambient.adds()) question.ambient = ambient.instances;
  question.glossy = isGlossy(needs.brdf);
  return question;
}

// Of the rows first ... end - 1.
post::TransferStatistics Renderer::State::transferSums(post::TransferInput& in, const std::optional<post::AskedInput>& question,
                                                       int firstRow, int endRow) {
  const int w = in.g->width, h = in.g->height;
  sums = post::makeTransferSums(in, std::move(sums));
  if (reference) {
    post::ambientTransferRef(in, firstRow, endRow, sums);
    return {};
  }
  if (settings.skip) {
    bounds = post::makeDepthBounds(w, h, std::move(bounds));
    constexpr size_t kCellRowsPerTask = 4;
    parallel.forRanges(size_t(bounds.c.height()), kCellRowsPerTask, [&](size_t row0, size_t row1, int) {
      post::boundDepth(*in.g, in.projector, int(row0), int(row1), bounds, target);
    });
    in.bounds = &bounds;
  }
  if (question) {
    asked.resize(post::segmentsOf(w), h);
    in.asked = &asked;
  }
  std::vector<post::TransferStatistics> found(size_t(parallel.workers()));
  parallel.forRanges(size_t(endRow - firstRow), kRowsPerTask, [&](size_t begin, size_t end, int worker) {
    const int y0 = firstRow + int(begin), y1 = firstRow + int(end);
    if (question) post::askedPixels(*question, y0, y1, asked);
    found[size_t(worker)].add(post::ambientTransfer(in, y0, y1, sums, target));
  });
  post::TransferStatistics all;
  for (const post::TransferStatistics& f : found) all.add(f);
  return all;
}

// What is reflected of direct lights: of all that is drawn where the transfer reads it.
void Renderer::State::drawDirect(const Scene& scene, const raster::DrawList& list, const FrameSettings& s, const FrameNeeds& needs, Frame& out) {
  const raster::GBuffer& g = more() ? drawn : out.g;
  post::LinearColor& to = more() ? drawnDirect : direct;
  to = post::makeLinearColor(g.width, g.height, std::move(to));
  const raster::Window all = wholeWindow(s);
  const bool missing = hasShadows(scene, s) && (window.width < all.width || window.height < all.height);
  if (missing) {
    raster::PlaneSet onlyDepth;
    onlyDepth.depth = true;
    raster::GBuffer depth;
    rasterize(list, s, onlyDepth, all, depth);
    whole = std::move(depth.depth);
  }
  const bool everywhere = needs.radiance;
  const int firstRow = everywhere ? 0 : part.y, endRow = everywhere ? g.height : part.y + part.height;
  const DirectLights::Input in{scene, s, list, g, post::makeProjector(s.camera, s.width, s.height, window), firstRow, endRow,
                               missing ? whole : g.depth, post::makeProjector(s.camera, s.width, s.height, missing ? all : window),
                               reference, settings.skip, target};
  out.lightStatistics = lights.draw(in, rasterizer, parallel, to, out.timings);
  for (int c = 0; c < 3 && more(); ++c) raster::cutOut(drawnDirect.rgb[c], part, direct.rgb[c]);
}

// O and W of the part that is given, and the G-buffer cut down to it.
void Renderer::State::drawTransfer(const FrameSettings& s, const FrameNeeds& needs, Frame& out) {
  raster::Stopwatch watch;
  raster::GBuffer& g = more() ? drawn : out.g;
  if (needs.sums) {
    post::TransferInput in{&g, post::makeProjector(s.camera, s.width, s.height, window), s.transfer, post::transferSamples(s.transfer)};
    if (!needs.albedo && !needs.radiance) in.settings.albedo = post::TransferAlbedo::Own;  // for O, which reads none
    in.implicits = implicits;
    in.heights = draws.heights();
    if (needs.radiance) {
      radiance = post::makeLinearColor(g.width, g.height, std::move(radiance));
      const post::LightInput first{&g, nullptr, post::Occlusion::None, ambient, glm::vec3(0), needs.direct ? &(more() ? drawnDirect : direct) : nullptr,
                                   needs.brdf, in.projector};
      forRows(0, g.height, [&](int y0, int y1) {
        reference ? post::lightRef(first, y0, y1, radiance) : post::light(first, y0, y1, radiance, target);
      });
      in.radiance = &radiance;
    }
    const raster::Window filtered = filteredWindow(s);
    const int firstRow = filtered.y - window.y, endRow = firstRow + filtered.height;
    out.transferStatistics = transferSums(in, asking(s, needs, g), firstRow, endRow);
    out.timings.transfer = watch.lap();

    post::Transfer& transfer = more() ? drawnTransfer : out.transfer;
    for (int c = 0; overNormals && c < 3; ++c) transfer.w[c] = std::exchange(g.normal[c], {});
    transfer = post::makeTransfer(g.width, g.height, needs.transfer, std::move(transfer));
    forRows(part.y, part.y + part.height, [&](int y0, int y1) {
      reference ? post::depthFilterRef(in, sums, y0, y1, transfer) : post::depthFilter(in, sums, y0, y1, transfer, target);
    });
    if (more()) cutOut(transfer, part, out.transfer);
  }
  if (more()) cutOut(g, part, out.g);
  out.timings.filter = watch.lap();
}

void Renderer::State::drawLight(const FrameSettings& s, const FrameNeeds& needs, Frame& out) {
  const post::Projector projector = post::makeProjector(s.camera, s.width, s.height, outputWindow(s));
  post::LightInput in{&out.g, &out.transfer, needs.occlusion, ambient, s.background, needs.direct ? &direct : nullptr, needs.brdf, projector};
  post::ReflectionInput mirrors;
  if (needs.reflections) {
    mirrors = {&out.g, needs.occlusion == post::Occlusion::None ? nullptr : &out.transfer.obscurance, projector, environmentViewOf(s), ambient.instances};
    in.reflected = &out.color;
  }
  if (needs.color) {
    for (int c = 0; overSums && c < 3; ++c) out.color.rgb[c] = std::exchange(sums.denominator[c], {});
    out.color = post::makeLinearColor(out.width, out.height, std::move(out.color));
    forRows(0, out.height, [&](int y0, int y1) {
      if (needs.reflections)
        reference ? post::environmentReflectionRef(mirrors, y0, y1, out.color) : post::environmentReflection(mirrors, y0, y1, out.color, target);
      reference ? post::lightRef(in, y0, y1, out.color) : post::light(in, y0, y1, out.color, target);
    });
  }
  if (needs.color && s.environmentBackground) drawBackground(s, out);
  if (needs.radiance && needs.transfer.w)
    forRows(0, out.height, [&](int y0, int y1) {
      reference ? post::transferOfBouncedRef(in, y0, y1, out.transfer.w)
                : post::transferOfBounced(in, y0, y1, out.transfer.w, target);
    });
}

void Renderer::State::drawBackground(const FrameSettings& s, Frame& out) {
  const post::BackgroundInput in{&out.g, post::makeProjector(s.camera, s.width, s.height, outputWindow(s)), environmentViewOf(s)};
  forRows(0, out.height, [&](int y0, int y1) {
    reference ? post::environmentBackgroundRef(in, y0, y1, out.color) : post::environmentBackground(in, y0, y1, out.color, target);
  });
}

void Renderer::State::drawDisplay(const FrameSettings& s, Frame& out) {
  const bool plain = s.tone.changesNothing();
  out.shown = plain ? post::LinearColor() : post::makeLinearColor(out.width, out.height, std::move(out.shown));
  out.display = post::makeDisplayImage(out.width, out.height, std::move(out.display));
  const post::LinearColor& from = plain ? out.color : out.shown;
  forRows(0, out.height, [&](int y0, int y1) {
    if (!plain) reference ? post::toneMapRef(out.color, s.tone, y0, y1, out.shown) : post::toneMap(out.color, s.tone, y0, y1, out.shown, target);
    reference ? post::displayRef(from, table, y0, y1, out.display) : post::display(from, table, y0, y1, out.display, target);
  });
}

// The same frame, of sub-pixels.
FrameSettings subpixels(FrameSettings s) {
  s.width *= s.supersample, s.height *= s.supersample, s.border *= s.supersample;
  if (s.crop)
    for (int* v : {&s.crop->x, &s.crop->y, &s.crop->width, &s.crop->height}) *v *= s.supersample;
  return s;
}

Result<Done> Renderer::render(const Scene& scene, const FrameSettings& settings, Frame& frame) try {
  if (const char* wrong = wrongSetting(settings)) return Error{ErrorCode::Usage, wrong, "", ""};
  if (const char* wrong = wrongLights(scene, settings)) return Error{ErrorCode::Usage, wrong, "", ""};
  if (const std::string wrong = wrongCrop(settings); !wrong.empty()) return Error{ErrorCode::Usage, wrong, "", ""};
  const FrameSettings full = subpixels(settings);
  if (const std::string wrong = wrongCrop(full); !wrong.empty()) return Error{ErrorCode::Usage, "of sub-pixels: " + wrong, "", ""};
  const raster::FloatEnvironment environment;
  State& s = *state_;
  const bool supersampled = settings.supersample > 1;
  if (!supersampled) s.subpixels = {};
  Frame& drawn = supersampled ? s.subpixels : frame;
  const FrameNeeds needs = needsOf(scene, settings);
  FrameTimings timings;
  raster::Stopwatch total, watch;

  const bool normalIsAov = std::find(settings.aovs.begin(), settings.aovs.end(), Aov::Normal) != settings.aovs.end();
  const bool normalIsRead = (settings.transfer.filter && settings.transfer.filterGuide == post::FilterGuide::Plane) ||
                            lightsByNormal(settings) || isGlossy(needs.brdf);
  s.overNormals = supersampled && needs.transfer.w && !normalIsAov && !normalIsRead;
  s.overSums = supersampled;
  if (needs.color || needs.radiance) s.ambient = ambientLightOf(scene, settings, s.ambientOfInstances);
  drawn.timings = {};
  drawn.transferStatistics = {};
  drawn.lightStatistics = {};
  const raster::DrawList list = s.draws.of(scene, full.displacement);
  s.drawGBuffer(list, full, needs, drawn);
  timings.gbuffer = watch.lap();
  if (needs.direct) s.drawDirect(scene, list, full, needs, drawn);
  timings.shadows = drawn.timings.shadows;
  timings.direct = drawn.timings.direct;
  s.drawTransfer(full, needs, drawn);
  timings.transfer = drawn.timings.transfer;
  timings.filter = drawn.timings.filter;
  watch.lap();
  if (needs.color || needs.radiance) {
    s.drawLight(full, needs, drawn);
    timings.light = watch.lap();
  }
  if (supersampled) {
    downsampleFrame(drawn, settings, s.parallel, s.reference ? std::nullopt : std::optional(s.target), frame);
    frame.statistics = drawn.statistics;
    frame.transferStatistics = drawn.transferStatistics;
    frame.lightStatistics = drawn.lightStatistics;
    for (int c = 0; c < 3; ++c) {  // the next frame needs them where they were
      if (s.overSums && needs.color) s.sums.denominator[c] = std::exchange(drawn.color.rgb[c], {});
      if (s.overNormals) (s.more() ? s.drawn : drawn.g).normal[c] = std::exchange((s.more() ? s.drawnTransfer : drawn.transfer).w[c], {});
    }
    timings.downsample = watch.lap();
  }
  if (!settings.display) frame.shown = {};
  if (settings.display) {
    s.drawDisplay(settings, frame);
    timings.display = watch.lap();
  }
  timings.frame = total.lap();
  frame.timings = timings;
  return Done{};
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::BadInput, "not enough memory for this frame", "", ""};
} catch (const std::invalid_argument& e) {
  return Error{ErrorCode::Usage, e.what(), "", ""};
}

}  // namespace obscura::engine
