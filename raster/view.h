// In: camera, image size, draw list.  Out: the constants of the frame and of each instance, in float.
//
// Conventions of the rasterizer:
//   view space    right-handed, x right, y up, looking along -z; zView = -z > 0 in front of the eye
//   image         x to the right, y downwards, row 0 on top; the centre of pixel (x, y) is (x + 1/2, y + 1/2)
//   sub-pixels    positions snap to 1/256 pixel ("Sub" in names), counted from the centre of the image
//   winding       counter-clockwise seen from outside; a mirroring instance keeps its outside
//   depth key     affine in the image and nearer = larger: 1 / zView (perspective), -zView (orthographic)
//   fill rule     top-left: a pixel centre on an edge belongs to the triangle whose top or left edge it is
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "obscura/raster/camera.h"
#include "obscura/raster/draw.h"

namespace obscura::raster {

constexpr int kSubBits = 8;                       // 1/256 pixel
constexpr int32_t kSub = 1 << kSubBits;
constexpr int32_t kGuardSub = 1 << 21;            // |x|, |y| of any vertex that is rasterized: 8192 pixels
constexpr int kMaxImageSize = 16384;              // pixels a side; a window reaches no farther from the centre, either
static_assert(kMaxImageSize / 2 * kSub <= kGuardSub, "image and window lie inside the guard band");

struct View {
  int left = 0, top = 0;                          // first pixel of the window, in the whole image
  int width = 0, height = 0;                      // of the window
  bool perspective = true;
  // xSub = xView / zView * xScaleSub + xShiftSub  (orthographic: without the division); y points down.
  float xScaleSub = 0, yScaleSub = 0, xShiftSub = 0, yShiftSub = 0;
  float zNear = 0, zFar = 0;                      // zFar is the largest float where the camera has none: infinity lies beyond
  int32_t xFirstSub = 0, yFirstSub = 0;           // upper left corner of the window, from the centre of the whole image
  int32_t xLastSub = 0, yLastSub = 0;             // its lower right corner

  // Centre of a pixel of the window, relative to the centre of the image.
  int32_t xCenterSub(int x) const { return x * kSub + kSub / 2 + xFirstSub; }
  int32_t yCenterSub(int y) const { return y * kSub + kSub / 2 + yFirstSub; }
};

// One instance as this frame sees it.
struct Draw {
  const MeshView* mesh = nullptr;
  const Material* material = nullptr;
  const Clusters* clusters = nullptr;  // the mesh's, or made for this frame
  float viewFromObject[3][4];          // rows; applied as ((m0 x + m1 y) + m2 z) + m3
  float normalToView[3][3];            // rows of the inverse transpose, up to scale
  float eye[4];                        // the eye in object space, (x, y, z, 1), or the direction to it, (x, y, z, 0)
  bool invertible = false;             // false (flattened): eye and normalToView are meaningless
  bool mirrored = false;               // negative determinant
  bool away = false;                   // setup takes the triangles that face away instead, see setup.h
  float maxScale = 0;                  // no direction is stretched more than this (upper bound)
  uint32_t firstTriangle = 0;          // id of the mesh's triangle 0
  uint32_t triangleCount = 0;
  uint32_t instance = 0;               // index into DrawList::instances
  uint32_t materialIndex = 0;
};

// width, height: of the whole image, which alone decides about scale and shift. Without a window all of it is drawn.
View makeView(const Camera& camera, int width, int height, const std::optional<Window>& window = {});

// Instances without triangles are left out; the order, and so the ids, stay.
std::vector<Draw> makeDraws(const DrawList& list, const Camera& camera);

}  // namespace obscura::raster
