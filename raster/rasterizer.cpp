#include "obscura/raster/rasterizer.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "obscura/raster/candidates.h"
#include "obscura/raster/cull.h"
#include "obscura/raster/depth_layers.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/implicit.h"
#include "obscura/raster/occlusion.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/relief.h"
#include "obscura/raster/resolve.h"
#include "obscura/raster/setup.h"
#include "obscura/raster/srgb.h"
#include "obscura/raster/stopwatch.h"
#include "obscura/raster/tile.h"
#include "obscura/raster/transform.h"
#include "obscura/raster/view.h"

namespace obscura::raster {
namespace {

struct Worker {
  Statistics statistics;
  TransformedVertices vertices;
  TileMemory tile, behind;
  Plane<float> limit;  // of a tile
};

// Frames of fewer clusters, or whose clusters' boxes add up to less than so many images, are drawn in one round: rounds
// have a cost of their own, and little would be hidden.
constexpr size_t kFewClusters = 512;
constexpr int64_t kFewLayers = 100;
// Clusters that the first rounds look at; later ones look at twice as many each.
constexpr size_t kFirstClusters = 8192;
// Rounds that the clusters looked at are dealt out to.
constexpr size_t kRounds = 3;
// The visibility of larger images (pixels) is not kept from round to round: 8 bytes a pixel.
constexpr int64_t kMostKept = int64_t(1) << 24;

int bitsOfTile(int tile) {
  for (int bits = kMinTileBits; bits <= kMaxTileBits; ++bits)
    if (tile == 1 << bits) return bits;
  throw std::invalid_argument("obscura raster: tile of " + std::to_string(tile) + " pixels, not 16, 32 or 64");
}

// Clusters of meshes that came without.
void clusterThoseWithout(std::vector<Draw>& draws, std::map<const MeshView*, Clusters>& made) {
  for (Draw& d : draws) {
    if (d.clusters) continue;
    auto [entry, fresh] = made.try_emplace(d.mesh);
    if (fresh) entry->second = buildClusters(d.mesh->positions, d.mesh->indices);
    d.clusters = &entry->second;
  }
}

// Single-sided draws once more, to set up what faces away.
std::vector<Draw> awayDraws(const std::vector<Draw>& draws) {
  std::vector<Draw> away;
  for (const Draw& d : draws)
    if (!d.material->doubleSided) away.emplace_back(d).away = true;
  return away;
}

}  // namespace

struct Rasterizer::State {
  Settings settings;
  Target target;
  int tileBits;
  Parallel parallel;
  SrgbTable srgb;
  DrawRuns drawRuns;
  std::vector<std::unique_ptr<Worker>> workers;
  std::vector<Bins> bins, awayBins, displacedBins;  // one per worker, contiguous for the tiles
  std::vector<ImplicitDraw> implicits;
  Statistics statistics;
  Timings timings;
  TileGrid grid;
  Keep keep = Keep::Visibility;
  bool rounds = false;  // front to back; what follows belongs to them
  OcclusionMap occlusion;
  TileMemory kept;
  std::vector<uint8_t> started;  // tiles that hold something

  explicit State(const Settings& s)
      : settings(s), target(chooseTarget(s.target)), tileBits(bitsOfTile(s.tile)), parallel(s.threads) {}

  void render(const DrawList& list, const View& view, const Camera& camera, const PlaneSet& planes, GBuffer& out);
  void beginFrame(const View& view, const PlaneSet& planes, GBuffer& out);
  void drawVisible(const SurfaceContext& context, bool mayHide);
  void startRounds();
  void setupClusters(const View& view, Span<const Candidate> candidates, bool again, std::vector<Bins>& into);
  void setupAway(const View& view, const std::vector<Draw>& draws);
  void drawRound(const SurfaceContext& context);
  void finishTiles(const SurfaceContext& context, const PlaneSet& planes, GBuffer& out);
  TileBuffers drawDisplaced(const SurfaceContext& context, const TileBuffers& tile, int index, Worker& worker);
  void drawLayer(const SurfaceContext& context, const TileBuffers& first, bool covered, int index, LayerBehind layer,
                 float separation, Worker& worker, Plane<float>& out);
  const OcclusionMap* seen() const { return drawn ? &occlusion : nullptr; }
  bool drawn = false;  // a round was: the map says something
};

Rasterizer::Rasterizer(const Settings& settings) {
  const FloatEnvironment environment;
  state_ = std::make_unique<State>(settings);
}
Rasterizer::~Rasterizer() = default;
Rasterizer::Rasterizer(Rasterizer&&) noexcept = default;
Rasterizer& Rasterizer::operator=(Rasterizer&&) noexcept = default;
const Statistics& Rasterizer::statistics() const { return state_->statistics; }
const Timings& Rasterizer::timings() const { return state_->timings; }

void Rasterizer::State::startRounds() {
  rounds = true;
  occlusion.reset(grid.width, grid.height);
  kept.reserve(size_t(grid.count()), grid.tileBits);
  started.assign(size_t(grid.count()), 0);
}

// again: more has been drawn since the candidates were found.
void Rasterizer::State::setupClusters(const View& view, Span<const Candidate> candidates, bool again, std::vector<Bins>& into) {
  for (Bins& b : into) b.reset(grid);
  constexpr size_t kClustersPerTask = 32;
  parallel.forRanges(candidates.size(), kClustersPerTask, [&](size_t begin, size_t end, int index) {
    Worker& worker = *workers[size_t(index)];
    const auto leaveOut = [&](uint64_t Statistics::*what, const Cluster& cluster) {
      ++(worker.statistics.*what);
      worker.statistics.trianglesCulled += cluster.triangleCount;
    };
    for (size_t i = begin; i < end; ++i) {
      const Draw& draw = *candidates[i].draw;
      const Cluster& cluster = *candidates[i].cluster;
      if (again && occlusion.hides(screenBound(view, viewSphere(draw, cluster.center, cluster.radius)))) {
        leaveOut(&Statistics::clustersHidden, cluster);
        continue;
      }
      const Clusters& all = *draw.clusters;
      TransformedVertices& v = worker.vertices;
      transformVertices(view, draw, all.x.data() + cluster.firstVertex, all.y.data() + cluster.firstVertex,
                        all.z.data() + cluster.firstVertex, int(cluster.vertexCount), v, target);
      if (settings.skip && !(v.anyCode & kNeedsClip)) {
        const ScreenBound bound = boundOf(view, v);
        const bool misses = v.allCodes != 0 || bound.x0 > bound.x1 || bound.y0 > bound.y1;
        if (misses || (drawn && occlusion.hides(bound))) {
          leaveOut(misses ? &Statistics::clustersCulled : &Statistics::clustersHidden, cluster);
          continue;
        }
      }
      setupCluster(view, draw, cluster, v, seen(), into[size_t(index)], worker.statistics, target);
    }
  });
}

// What faces away, for GBuffer::depthBack; not counted.
void Rasterizer::State::setupAway(const View& view, const std::vector<Draw>& draws) {
  Statistics uncounted;
  const std::vector<const Draw*> visible = visibleInstances(view, draws, settings.skip, uncounted);
  setupClusters(view, findCandidates(view, visible, {settings.skip, nullptr}, parallel, uncounted).clusters, false, awayBins);
  for (auto& w : workers) w->statistics = {};
}

bool anyOf(Span<const Bins> bins, int tile) {
  return std::any_of(bins.begin(), bins.end(), [&](const Bins& b) { return !b.empty(tile); });
}

// The bins into the tiles that are kept, and these into the map.
void Rasterizer::State::drawRound(const SurfaceContext& context) {
  Stopwatch watch;
  parallel.forRanges(size_t(grid.count()), 1, [&](size_t begin, size_t end, int) {
    for (size_t t = begin; t < end; ++t) {
      if (!anyOf(bins, int(t))) continue;
      TileBuffers tile = placeTile(grid, int(t), kept, t);
      if (!std::exchange(started[t], 1)) clearTile(keep, tile, target);
      rasterTile(context, int(t), bins, keep, tile, target);
      occlusion.update(tile, target);
    }
  });
  drawn = true;
  timings.tilesMs += watch.lap();
}

// What is displaced, into the visibility of a tile. Returns where worker.behind keeps how far it sinks.
TileBuffers Rasterizer::State::drawDisplaced(const SurfaceContext& context, const TileBuffers& tile, int index, Worker& worker) {
  worker.behind.reserve(1, grid.tileBits);
  TileBuffers displaced = placeTile(grid, index, worker.behind, 0);
  clearTile(Keep::Visibility, displaced, target);
  rasterTile(context, index, displacedBins, Keep::Visibility, displaced, target);
  sinkTile(context, displaced, tile, target);
  return displaced;
}

// A layer behind the first of a tile.
void Rasterizer::State::drawLayer(const SurfaceContext& context, const TileBuffers& first, bool covered, int index, LayerBehind layer,
                                  float separation, Worker& worker, Plane<float>& out) {
  const std::vector<Bins>& from = layer == LayerBehind::Back ? awayBins : bins;
  worker.behind.reserve(1, grid.tileBits);
  TileBuffers tile = placeTile(grid, index, worker.behind, 0);
  const bool traced = touchesImplicits(*context.view, implicits, tile, settings.skip);
  const bool flat = layer == LayerBehind::Second && anyOf(displacedBins, index);
  const bool more = anyOf(from, index) || flat || traced || !settings.skip;
  if (more) {
    worker.limit.resize(1 << (2 * grid.tileBits), 1);
    tile.limit = worker.limit.row(0);
    limitTile(*context.view, first, covered, layer, separation, tile, target);
    clearTile(Keep::KeyWithinLimit, tile, target);
    rasterTile(context, index, from, Keep::KeyWithinLimit, tile, target);
    if (flat) rasterTile(context, index, displacedBins, Keep::KeyWithinLimit, tile, target);
    if (traced) drawImplicitsBehind(*context.view, implicits, tile, layer == LayerBehind::Back, settings.skip, target);
  }
  storeTileDepth(*context.view, tile, more, out, target);
}

// What the bins still hold, the planes, then what implicit surfaces show before them.
void Rasterizer::State::finishTiles(const SurfaceContext& context, const PlaneSet& planes, GBuffer& out) {
  parallel.forRanges(size_t(grid.count()), 1, [&](size_t begin, size_t end, int index) {
    Worker& worker = *workers[size_t(index)];
    if (!rounds) worker.tile.reserve(1, grid.tileBits);
    for (size_t t = begin; t < end; ++t) {
      TileBuffers tile = rounds ? placeTile(grid, int(t), kept, t) : placeTile(grid, int(t), worker.tile, 0);
      const bool holds = rounds && started[t], more = anyOf(bins, int(t)) || !settings.skip;
      const bool traced = touchesImplicits(*context.view, implicits, tile, settings.skip);
      const bool sinks = anyOf(displacedBins, int(t));
      bool covered = holds || more || sinks;
      if ((more || sinks || traced) && !holds) clearTile(keep, tile, target);
      if (more) rasterTile(context, int(t), bins, keep, tile, target);
      TileBuffers displaced;
      if (sinks) displaced = drawDisplaced(context, tile, int(t), worker);
      if (keep == Keep::Visibility) resolveTile(context, tile, covered, out, target);
      if (planes.relief) clearRelief(tile, out);
      if (sinks) storeRelief(context, tile, displaced, out, target);
      if (traced) drawImplicits(*context.view, implicits, tile, settings.skip, out, target);
      covered |= traced;
      ++worker.statistics.tiles;
      worker.statistics.tilesEmpty += !covered;
      if (keep != Keep::Visibility && planes.depth) storeTileDepth(*context.view, tile, covered, out.depth, target);
      if (planes.depth2) drawLayer(context, tile, covered, int(t), LayerBehind::Second, planes.separation, worker, out.depth2);
      if (planes.depthBack) drawLayer(context, tile, covered, int(t), LayerBehind::Back, 0, worker, out.depthBack);
    }
  });
}

void Rasterizer::render(const DrawList& list, const Camera& camera, int width, int height, const PlaneSet& planes, GBuffer& out,
                        const std::optional<Window>& window) {
  checkArguments(list, camera, width, height, window);
  checkPlanes(planes);
  const FloatEnvironment environment;
  const Window wanted = window.value_or(Window{0, 0, width, height});
  // Cells are those of the whole image: their weight planes are what attributes are computed from.
  const int left = wanted.x & (kCell - 1), top = wanted.y & (kCell - 1);
  const Window drawn{wanted.x - left, wanted.y - top, wanted.width + left, wanted.height + top};
  const View view = makeView(camera, width, height, drawn);
  if (left == 0 && top == 0) return state_->render(list, view, camera, planes, out);
  GBuffer whole;
  state_->render(list, view, camera, planes, whole);
  cutOut(whole, {left, top, wanted.width, wanted.height}, out);
}

// All that is visible into bins, and but for the last round into tiles; what is displaced into bins of its own.
void Rasterizer::State::drawVisible(const SurfaceContext& context, bool mayHide) {
  const View& view = *context.view;
  const int64_t pixels = int64_t(view.width) * view.height;
  std::vector<const Draw*> visible = visibleInstances(view, context.draws, settings.skip, statistics);
  const auto flatEnd = std::stable_partition(visible.begin(), visible.end(), [](const Draw* d) { return !isDisplaced(*d); });
  const std::vector<const Draw*> displaced(flatEnd, visible.end());
  visible.erase(flatEnd, visible.end());
  size_t look = mayHide ? kFirstClusters : std::numeric_limits<size_t>::max();
  for (size_t from = 0, to = 0; from < visible.size(); from = to, look *= 2) {
    for (size_t count = 0; to < visible.size() && (to == from || count + visible[to]->clusters->clusters.size() <= look); ++to)
      count += visible[to]->clusters->clusters.size();
    if (from > 0) drawRound(context);
    Candidates found = findCandidates(view, {visible.data() + from, to - from}, {settings.skip, seen()}, parallel, statistics);
    const bool deep = found.clusters.size() >= kFewClusters && found.boxes >= kFewLayers * pixels;
    if (mayHide && !rounds && (deep || to < visible.size())) startRounds();
    Candidate* rest = found.clusters.data();
    size_t count = found.clusters.size();
    for (size_t parts = rounds ? kRounds : 1; parts > 0; --parts) {
      if (parts < kRounds && rounds) drawRound(context);
      const size_t front = nearestFirst(rest, count, parts);
      setupClusters(view, {rest, front}, parts < kRounds && rounds, bins);
      rest += front;
      count -= front;
    }
  }
  // Nothing displaced hides others, as it lies behind its triangles; but what hides these hides it, too.
  if (!displaced.empty())
    setupClusters(view, findCandidates(view, displaced, {settings.skip, seen()}, parallel, statistics).clusters, false, displacedBins);
}

void Rasterizer::State::beginFrame(const View& view, const PlaneSet& planes, GBuffer& out) {
  if (out.width != view.width || out.height != view.height || !out.has(planes)) out = GBuffer(view.width, view.height, planes);
  grid = TileGrid(view.width, view.height, tileBits);
  keep = planes.depthsAlone() ? Keep::Key : Keep::Visibility;
  rounds = drawn = false;
  statistics = {};
  timings = {};
  while (workers.size() < size_t(parallel.workers())) workers.push_back(std::make_unique<Worker>());
  for (auto& w : workers) w->statistics = {};
  for (std::vector<Bins>* list : {&bins, &awayBins, &displacedBins}) {
    list->resize(workers.size());
    for (Bins& b : *list) b.reset(grid);
  }
}

void Rasterizer::State::render(const DrawList& list, const View& view, const Camera& camera, const PlaneSet& planes, GBuffer& out) {
  Stopwatch watch;
  beginFrame(view, planes, out);
  std::vector<Draw> draws = makeDraws(list, camera);
  std::map<const MeshView*, Clusters> made;
  clusterThoseWithout(draws, made);
  drawRuns.find(draws);
  implicits = makeImplicitDraws(list, camera);
  const SurfaceContext context{&view, draws, &drawRuns, list.textures, srgb.linear, list.heights};
  if (std::any_of(draws.begin(), draws.end(), isDisplaced)) keep = Keep::Visibility;  // what is displaced is known by its id
  if (planes.depthBack) setupAway(view, awayDraws(draws));
  // What lies behind the first layer must not be hidden by it.
  drawVisible(context, settings.skip && !planes.depth2 && !planes.depthBack && int64_t(view.width) * view.height <= kMostKept);
  timings.setupMs = watch.lap() - timings.tilesMs;
  finishTiles(context, planes, out);
  timings.tilesMs += watch.lap();
  for (const auto& w : workers) statistics.add(w->statistics);
}

void Rasterizer::renderDepth(const DrawList& list, const Camera& camera, int width, int height, Plane<float>& depth) {
  struct Lent {  // given back even if render() throws
    Plane<float>& plane;
    GBuffer g;
    explicit Lent(Plane<float>& p) : plane(p) {
      g.width = p.width();
      g.height = p.height();
      g.depth = std::move(p);
    }
    ~Lent() { plane = std::move(g.depth); }
  } lent(depth);
  PlaneSet planes;
  planes.depth = true;
  render(list, camera, width, height, planes, lent.g);
}

}  // namespace obscura::raster
