#include "obscura/engine/frame.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>
#include <utility>

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

Needs needsOf(const Scene& scene, const FrameSettings& s) {
  auto wants = [&](Aov aov) { return std::find(s.aovs.begin(), s.aovs.end(), aov) != s.aovs.end(); };
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
  return n;
}

const char* wrongSetting(const FrameSettings& s) {
  const post::AmbientSettings& t = s.transfer;
  if (t.samples < 1 || t.samples > 64) return "samples must be 1 to 64";
  if (t.steps < 1 || t.steps > 4) return "steps must be 1 to 4";
  if (!(t.radius > 0 && t.radius < 1e30f)) return "the radius must be positive and finite";
  if (!(t.bias >= 0 && t.bias < 1e30f)) return "the bias must be 0 or more and finite";
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
  post::DepthBounds bounds;
  post::TransferSums sums;

  State(const raster::Settings& s, bool ref)
      : settings(s), reference(ref), target(raster::chooseTarget(s.target)), rasterizer(s), parallel(ref ? 1 : s.threads) {}

  raster::DrawList drawList(const Scene& scene);
  post::TransferStatistics transferSums(post::TransferInput& in);

  static constexpr size_t kRowsPerTask = 8;

  // Calls body(y0, y1) for bands of rows, in parallel.
  template <class Body>
  void forRows(int height, const Body& body) {
    parallel.forRanges(size_t(height), kRowsPerTask, [&](size_t y0, size_t y1, int) { body(int(y0), int(y1)); });
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

post::TransferStatistics Renderer::State::transferSums(post::TransferInput& in) {
  const int w = in.g->width, h = in.g->height;
  sums = post::makeTransferSums(in, std::move(sums));
  if (reference) {
    post::ambientTransferRef(in, 0, h, sums);
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
  std::vector<post::TransferStatistics> found(size_t(parallel.workers()));
  parallel.forRanges(size_t(h), kRowsPerTask, [&](size_t y0, size_t y1, int worker) {
    found[size_t(worker)].add(post::ambientTransfer(in, int(y0), int(y1), sums, target));
  });
  post::TransferStatistics all;
  for (const post::TransferStatistics& f : found) all.add(f);
  return all;
}

Result<Done> Renderer::render(const Scene& scene, const FrameSettings& settings, Frame& frame) try {
  if (const char* wrong = wrongSetting(settings)) return Error{ErrorCode::Usage, wrong, "", ""};
  const raster::FloatEnvironment environment;
  State& s = *state_;
  const Needs needs = needsOf(scene, settings);
  const int w = settings.width, h = settings.height;
  frame.timings = {};
  Stopwatch total, watch;

  const raster::DrawList list = s.drawList(scene);
  if (s.reference) raster::renderReference(list, settings.camera, w, h, needs.planes, frame.g);
  else s.rasterizer.render(list, settings.camera, w, h, needs.planes, frame.g);
  frame.statistics = s.rasterizer.statistics();
  frame.timings.gbuffer = watch.lap();

  frame.width = w;
  frame.height = h;
  post::TransferInput in{&frame.g, post::makeProjector(settings.camera, w, h), settings.transfer,
                         post::transferSamples(settings.transfer)};
  frame.transferStatistics = {};
  if (needs.sums) {
    frame.transferStatistics = s.transferSums(in);
    frame.timings.transfer = watch.lap();

    frame.transfer = post::makeTransfer(w, h, needs.obscurance, needs.w, std::move(frame.transfer));
    s.forRows(h, [&](int y0, int y1) {
      s.reference ? post::depthFilterRef(in, s.sums, y0, y1, frame.transfer)
                  : post::depthFilter(in, s.sums, y0, y1, frame.transfer, s.target);
    });
    frame.timings.filter = watch.lap();
  }
  if (needs.color) {
    frame.color = post::makeLinearColor(w, h, std::move(frame.color));
    const post::LightInput li{&frame.g, &frame.transfer, settings.ambient, settings.ambientLight, settings.background};
    s.forRows(h, [&](int y0, int y1) {
      s.reference ? post::lightRef(li, y0, y1, frame.color) : post::light(li, y0, y1, frame.color, s.target);
    });
    frame.timings.light = watch.lap();
  }
  if (settings.display) {
    frame.display = post::makeDisplayImage(w, h, std::move(frame.display));
    s.forRows(h, [&](int y0, int y1) {
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
