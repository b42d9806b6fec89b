#include "obscura/raster/rasterizer.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "obscura/raster/cull.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/parallel.h"
#include "obscura/raster/resolve.h"
#include "obscura/raster/setup.h"
#include "obscura/raster/srgb.h"
#include "obscura/raster/tile.h"
#include "obscura/raster/transform.h"
#include "obscura/raster/view.h"

namespace obscura::raster {
namespace {

struct Worker {
  Statistics statistics;
  TransformedVertices vertices;
  TileBuffers tile;
};

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

int bitsOfTile(int tile) {
  for (int bits = kMinTileBits; bits <= kMaxTileBits; ++bits)
    if (tile == 1 << bits) return bits;
  throw std::invalid_argument("obscura raster: tile of " + std::to_string(tile) + " pixels, not 16, 32 or 64");
}

}  // namespace

struct Rasterizer::State {
  Settings settings;
  Target target;
  int tileBits;
  Parallel parallel;
  SrgbTable srgb;
  std::vector<std::unique_ptr<Worker>> workers;
  std::vector<Bins> bins;  // one per worker, contiguous for the tiles
  Statistics statistics;
  Timings timings;

  explicit State(const Settings& s)
      : settings(s), target(chooseTarget(s.target)), tileBits(bitsOfTile(s.tile)), parallel(s.threads) {}

  void setupClusters(const View& view, const std::vector<Draw>& draws, const TileGrid& grid);
  void rasterTiles(const SurfaceContext& context, const TileGrid& grid, GBuffer& out);
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

void Rasterizer::State::setupClusters(const View& view, const std::vector<Draw>& draws, const TileGrid& grid) {
  // Clusters of all visible instances, numbered through: first[k] is the number of draw k's first.
  std::vector<const Draw*> visible;
  std::vector<size_t> first;
  size_t count = 0;
  for (const Draw& draw : draws) {
    ++statistics.instances;
    statistics.triangles += draw.triangleCount;
    if (settings.skip && !sphereVisible(view, draw, draw.clusters->center, draw.clusters->radius)) {
      ++statistics.instancesCulled;
      statistics.trianglesCulled += draw.triangleCount;
      continue;
    }
    visible.push_back(&draw);
    first.push_back(count);
    count += draw.clusters->clusters.size();
  }
  statistics.clusters += count;
  for (Bins& b : bins) b.reset(grid);
  constexpr size_t kClustersPerTask = 32;
  parallel.forRanges(count, kClustersPerTask, [&](size_t begin, size_t end, int index) {
    Worker& worker = *workers[size_t(index)];
    size_t k = size_t(std::upper_bound(first.begin(), first.end(), begin) - first.begin()) - 1;
    for (size_t i = begin; i < end; ++i) {
      while (k + 1 < first.size() && i >= first[k + 1]) ++k;
      const Draw& draw = *visible[k];
      const Cluster& cluster = draw.clusters->clusters[i - first[k]];
      auto skipped = [&] {
        ++worker.statistics.clustersCulled;
        worker.statistics.trianglesCulled += cluster.triangleCount;
      };
      if (settings.skip && (!clusterFacesEye(draw, cluster) || !sphereVisible(view, draw, cluster.center, cluster.radius))) {
        skipped();
        continue;
      }
      const Clusters& all = *draw.clusters;
      transformVertices(view, draw, all.x.data() + cluster.firstVertex, all.y.data() + cluster.firstVertex,
                        all.z.data() + cluster.firstVertex, int(cluster.vertexCount), worker.vertices, target);
      if (settings.skip && worker.vertices.allCodes != 0 && !(worker.vertices.anyCode & kNeedsClip)) {
        skipped();  // all vertices on the same outer side of the window
        continue;
      }
      setupCluster(view, draw, cluster, worker.vertices, bins[size_t(index)], worker.statistics, target);
    }
  });
}

void Rasterizer::State::rasterTiles(const SurfaceContext& context, const TileGrid& grid, GBuffer& out) {
  parallel.forRanges(size_t(grid.count()), 1, [&](size_t begin, size_t end, int index) {
    Worker& worker = *workers[size_t(index)];
    for (size_t t = begin; t < end; ++t) {
      const bool covered = rasterTile(context, grid, int(t), bins, settings.skip, worker.tile, target);
      ++worker.statistics.tiles;
      worker.statistics.tilesEmpty += !covered;
      resolveTile(context, worker.tile, covered, out, target);
    }
  });
}

void Rasterizer::render(const DrawList& list, const Camera& camera, int width, int height, const PlaneSet& planes, GBuffer& out,
                        const std::optional<Window>& window) {
  checkArguments(list, camera, width, height, window);
  const FloatEnvironment environment;
  State& s = *state_;
  const auto start = std::chrono::steady_clock::now();
  const View view = makeView(camera, width, height, window);
  if (out.width != view.width || out.height != view.height || !out.has(planes)) out = GBuffer(view.width, view.height, planes);
  s.statistics = {};
  if (s.workers.empty()) {
    s.bins.resize(size_t(s.parallel.workers()));
    for (int i = 0; i < s.parallel.workers(); ++i) s.workers.push_back(std::make_unique<Worker>());
  }
  for (auto& w : s.workers) w->statistics = {};

  std::vector<Draw> draws = makeDraws(list, camera);
  std::map<const MeshView*, Clusters> made;  // of meshes that came without
  for (Draw& d : draws) {
    if (d.clusters) continue;
    auto [entry, fresh] = made.try_emplace(d.mesh);
    if (fresh) entry->second = buildClusters(d.mesh->positions, d.mesh->indices);
    d.clusters = &entry->second;
  }
  const TileGrid grid(view.width, view.height, s.tileBits);
  const SurfaceContext context{&view, draws, list.textures, s.srgb.linear};
  s.setupClusters(view, draws, grid);
  s.timings.setupMs = millisecondsSince(start);
  const auto tilesStart = std::chrono::steady_clock::now();
  s.rasterTiles(context, grid, out);
  s.timings.tilesMs = millisecondsSince(tilesStart);
  for (const auto& w : s.workers) s.statistics.add(w->statistics);
}

}  // namespace obscura::raster
