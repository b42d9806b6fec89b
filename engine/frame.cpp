#include "obscura/engine/frame.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>
#include <utility>

#include "obscura/engine/crop.h"
#include "obscura/post/transfer_samples.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/parallel.h"

namespace obscura::engine {
namespace {

// What the wanted AOVs add up to.
struct Needs {
  raster::PlaneSet planes;
  bool color = false, sums = false, obscurance = false, w = false;
};

bool emits(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const raster::Material& m) {
    return m.unlit || m.emissive.x > 0 || m.emissive.y > 0 || m.emissive.z > 0;
  });
}

bool wants(const FrameSettings& s, Aov aov) { return std::find(s.aovs.begin(), s.aovs.end(), aov) != s.aovs.end(); }

Needs needsOf(const Scene& scene, const FrameSettings& s) {
  const auto wants = [&](Aov aov) { return engine::wants(s, aov); };
  Needs n;
  n.color = wants(Aov::Color) || s.display;
  n.obscurance = wants(Aov::Obscurance) || (n.color && s.ambient == post::Occlusion::Obscurance);
  n.w = wants(Aov::Transfer) || (n.color && s.ambient == post::Occlusion::Transfer);
  n.sums = n.obscurance || n.w;
  n.planes.depth = wants(Aov::Depth) || n.sums || n.color;
  n.planes.normal = wants(Aov::Normal) || n.sums;
  n.planes.albedo = wants(Aov::Albedo) || n.w || n.color;
  n.planes.emissive = wants(Aov::Emissive) || (n.color && emits(scene));
  n.planes.position = wants(Aov::Position);
  n.planes.triangle = wants(Aov::Triangle);
  n.planes.instance = wants(Aov::Instance);
  n.planes.material = wants(Aov::Material);
  n.planes.depth2 = wants(Aov::Depth2);
  n.planes.depthBack = wants(Aov::DepthBack);
  n.planes.separation = s.separation;
  return n;
}

const char* wrongSetting(const FrameSettings& s) {
  const post::AmbientSettings& t = s.transfer;
  if (t.samples < 1 || t.samples > 64) return "samples must be 1 to 64";
  if (t.steps < 1 || t.steps > 4) return "steps must be 1 to 4";
  if (!(t.radius > 0 && t.radius < 1e30f)) return "the radius must be positive and finite";
  if (!(t.bias >= 0 && t.bias < 1e30f)) return "the bias must be 0 or more and finite";
  if (wants(s, Aov::Depth2) && !(s.separation > 0 && s.separation < 1e30f)) return "the separation must be positive and finite";
  if (!(t.filterThreshold > 0)) return "the filter threshold must be positive";
  for (int c = 0; c < 3; ++c)
    if (!(s.ambientLight[c] >= 0 && s.ambientLight[c] < 1e30f) || !(s.background[c] >= 0 && s.background[c] < 1e30f))
      return "colours must be 0 or more and finite";
  return nullptr;
}

struct Stopwatch {
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  double lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(last, now)).count();
  }
};

}  // namespace

struct Renderer::State {
  raster::Settings settings;
  bool reference;
  raster::Target target;
  raster::Rasterizer rasterizer;
  raster::Parallel parallel;
  post::DisplayTable table;
  std::vector<raster::MeshView> meshes;
  std::vector<raster::Instance> instances;
  std::vector<raster::TextureView> textures;
  post::TransferSums sums;
  raster::GBuffer drawn;         // of a frame with border or crop, as are its O and W: more than is given
  post::Transfer drawnTransfer;

  State(const raster::Settings& s, bool ref)
      : settings(s), reference(ref), target(raster::chooseTarget(s.target)), rasterizer(s), parallel(ref ? 1 : s.threads) {}

  raster::DrawList drawList(const Scene& scene);
  void rasterize(const raster::DrawList& list, const FrameSettings& s, const raster::PlaneSet& planes, const raster::Window& w,
                 raster::GBuffer& out);
  raster::Window windowToDraw(const raster::DrawList& list, const FrameSettings& s, const Needs& needs);

  // Calls body(y0, y1) for bands of the rows first ... end - 1, in parallel.
  template <class Body>
  void forRows(int first, int end, const Body& body) {
    constexpr size_t kRowsPerTask = 8;
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

raster::DrawList Renderer::State::drawList(const Scene& scene) {
  meshes.clear();
  instances.clear();
  textures.clear();
  for (const Mesh& m : scene.meshes) meshes.push_back(m.view());
  for (const Instance& i : scene.instances) instances.push_back({&meshes[i.mesh], scene.meshes[i.mesh].material, i.worldFromObject});
  for (const Texture& t : scene.textures) textures.push_back(t.view);
  return {instances, scene.materials, textures};
}

void Renderer::State::rasterize(const raster::DrawList& list, const FrameSettings& s, const raster::PlaneSet& planes,
                                const raster::Window& w, raster::GBuffer& out) {
  if (reference) raster::renderReference(list, s.camera, s.width, s.height, planes, out, w);
  else rasterizer.render(list, s.camera, s.width, s.height, planes, out, w);
}

// A crop needs as much around it as the transfer's samples reach, and how far that is, the depth in it tells.
raster::Window Renderer::State::windowToDraw(const raster::DrawList& list, const FrameSettings& s, const Needs& needs) {
  if (!needs.sums) return outputWindow(s);
  if (!s.crop) return wholeWindow(s);
  raster::PlaneSet onlyDepth;
  onlyDepth.depth = true;
  raster::GBuffer g;
  rasterize(list, s, onlyDepth, filteredWindow(s), g);
  return transferWindow(s, nearestDepth(g.depth));
}

Result<Done> Renderer::render(const Scene& scene, const FrameSettings& settings, Frame& frame) try {
  if (const char* wrong = wrongSetting(settings)) return Error{ErrorCode::Usage, wrong, "", ""};
  if (const std::string wrong = wrongCrop(settings); !wrong.empty()) return Error{ErrorCode::Usage, wrong, "", ""};
  const raster::FloatEnvironment environment;
  State& s = *state_;
  const Needs needs = needsOf(scene, settings);
  const raster::Window output = outputWindow(settings);
  const int w = output.width, h = output.height;
  frame.timings = {};
  Stopwatch total, watch;

  const raster::DrawList list = s.drawList(scene);
  const raster::Window drawn = s.windowToDraw(list, settings, needs);
  const raster::Window part{output.x - drawn.x, output.y - drawn.y, w, h};  // the output in what is drawn
  const bool more = drawn.width > w || drawn.height > h;
  raster::GBuffer& g = more ? s.drawn : frame.g;
  s.rasterize(list, settings, needs.planes, drawn, g);
  frame.statistics = s.rasterizer.statistics();
  frame.timings.gbuffer = watch.lap();

  frame.width = w;
  frame.height = h;
  frame.x = output.x, frame.y = output.y;
  frame.imageWidth = settings.width, frame.imageHeight = settings.height;
  post::TransferInput in{&g, post::makeProjector(settings.camera, settings.width, settings.height, drawn),
                         settings.transfer, post::transferSamples(settings.transfer)};
  if (!needs.w) in.settings.albedo = post::TransferAlbedo::Own;  // O needs no neighbour's albedo, and there is none
  if (needs.sums) {
    s.sums = post::makeTransferSums(in, std::move(s.sums));
    const raster::Window filtered = filteredWindow(settings);
    s.forRows(filtered.y - drawn.y, filtered.y + filtered.height - drawn.y, [&](int y0, int y1) {
      s.reference ? post::ambientTransferRef(in, y0, y1, s.sums) : post::ambientTransfer(in, y0, y1, s.sums, s.target);
    });
    frame.timings.transfer = watch.lap();

    post::Transfer& transfer = more ? s.drawnTransfer : frame.transfer;
    transfer = post::makeTransfer(g.width, g.height, needs.obscurance, needs.w, std::move(transfer));
    s.forRows(part.y, part.y + h, [&](int y0, int y1) {
      s.reference ? post::depthFilterRef(in, s.sums, y0, y1, transfer) : post::depthFilter(in, s.sums, y0, y1, transfer, s.target);
    });
    if (more) cutOut(transfer, part, frame.transfer);
    frame.timings.filter = watch.lap();
  }
  if (more) cutOut(g, part, frame.g);
  if (needs.color) {
    frame.color = post::makeLinearColor(w, h, std::move(frame.color));
    const post::LightInput li{&frame.g, &frame.transfer, settings.ambient, settings.ambientLight, settings.background};
    s.forRows(0, h, [&](int y0, int y1) {
      s.reference ? post::lightRef(li, y0, y1, frame.color) : post::light(li, y0, y1, frame.color, s.target);
    });
    frame.timings.light = watch.lap();
  }
  if (settings.display) {
    frame.display = post::makeDisplayImage(w, h, std::move(frame.display));
    s.forRows(0, h, [&](int y0, int y1) {
      s.reference ? post::displayRef(frame.color, s.table, y0, y1, frame.display)
                  : post::display(frame.color, s.table, y0, y1, frame.display, s.target);
    });
    frame.timings.display = watch.lap();
  }
  frame.timings.frame = total.lap();
  return Done{};
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::BadInput, "not enough memory for this frame", "", ""};
} catch (const std::invalid_argument& e) {
  return Error{ErrorCode::Usage, e.what(), "", ""};
}

}  // namespace obscura::engine
