// The rasterizer: draw list and camera in, G-buffer out.
//
//   draws -> candidates (cull, occlusion) -> transform -> setup (clip) -> bins -> tiles: visibility -> resolve -> G-buffer
//   implicit surfaces -> tiles: traced into visibility and G-buffer
//
// and, where a scene has many layers, from the candidates to the tiles in rounds, front to back.
//
// One header per stage; see view.h for the conventions (handedness, pixel centres, fill rule, depth).
#pragma once

#include <memory>
#include <optional>

#include "obscura/raster/camera.h"
#include "obscura/raster/draw.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/statistics.h"
#include "obscura/raster/target.h"

namespace obscura::raster {

// None of these changes a bit of the result.
struct Settings {
  int threads = 0;               // 0: one per core
  Target target = Target::Auto;
  int tile = 64;                 // pixels a side: 16, 32 or 64
  bool skip = true;              // false: nothing is culled, every tile is rasterized (to prove that it is the same)
};

struct Timings {
  double setupMs = 0, tilesMs = 0;  // cull to bins; tiles and resolve
};

// Holds only scratch memory, which grows to what the largest frame needs and is used again. An instance serves one
// thread at a time; any number of instances may work at once.
class Rasterizer {
 public:
  explicit Rasterizer(const Settings& settings = {});
  ~Rasterizer();
  Rasterizer(Rasterizer&&) noexcept;
  Rasterizer& operator=(Rasterizer&&) noexcept;

  // width, height: of the camera's image, 1 ... kMaxImageSize. `out` becomes the window of it, without one the whole; it is
  // allocated anew unless it has the right size and just these planes already.
  // Throws std::invalid_argument, naming the value, where the list contradicts itself (an index that is out of range, spans
  // of different length, a camera without extent, a window that reaches beyond the guard band), std::bad_alloc without memory. The
  // vertex indices of a mesh that brings clusters are taken to be those that buildClusters has checked. Bad geometry never
  // throws: it is dropped and counted.
  // Where only depths are asked for (PlaneSet::depthsAlone) the way is shorter: no ids, no resolve. Windows that begin at
  // multiples of kCell pixels take less: others are cut out of a larger one.
  void render(const DrawList& list, const Camera& camera, int width, int height, const PlaneSet& planes, GBuffer& out,
              const std::optional<Window>& window = {});

  // The depth plane of render() alone, bit for bit, for shadow maps: a light's camera in, its depth map out. `depth` gets
  // this size and keeps its memory if it has it already. Throws as render() does.
  void renderDepth(const DrawList& list, const Camera& camera, int width, int height, Plane<float>& depth);

  const Statistics& statistics() const;  // of the last frame
  const Timings& timings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The same by the scalar twins: every triangle against every pixel of its box, one thread, no tiles, no culling, no
// SIMD. Short and slow; equal to Rasterizer::render bit for bit.
void renderReference(const DrawList& list, const Camera& camera, int width, int height, const PlaneSet& planes, GBuffer& out,
                     const std::optional<Window>& window = {});

// What render() throws about; the reference calls it too.
void checkArguments(const DrawList& list, const Camera& camera, int width, int height,
                    const std::optional<Window>& window = {});
void checkPlanes(const PlaneSet& planes);

}  // namespace obscura::raster
