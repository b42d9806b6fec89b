// In:  depth; an environment and how the camera sees it.
// Out: linear colour: where nothing was drawn, the radiance that arrives from there.
#pragma once

#include "obscura/post/environment_cube.h"
#include "obscura/post/linear_color.h"
#include "obscura/post/projector.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/target.h"

namespace obscura::post {

struct BackgroundInput {
  const raster::GBuffer* g = nullptr;  // depth
  Projector projector;                 // the direction of a pixel's centre: (x, y, -1); orthographic: all along the view axis
  EnvironmentView environment;
};

// Pixels of finite depth are left as they are.
void environmentBackground(const BackgroundInput& in, int y0, int y1, LinearColor& out, raster::Target target);
void environmentBackgroundRef(const BackgroundInput& in, int y0, int y1, LinearColor& out);  // the scalar twin

}  // namespace obscura::post
