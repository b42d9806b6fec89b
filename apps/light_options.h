// In: the command line's options of light: ambient, from an environment, from lights.  Out: those of a frame's settings.
#pragma once

#include "obscura/apps/frame_options.h"

namespace obscura::apps {

void addLight(CLI::App& app, FrameOptions& options);

// What cannot be had at once; throws CLI::ValidationError.
void checkLight(const FrameOptions& options);

// Into `frame`, which has its camera. BadInput: an environment that cannot be read, or light beyond what floats hold.
engine::Result<engine::Done> resolveLight(const FrameOptions& options, const engine::Scene& scene, engine::FrameSettings& frame);

}  // namespace obscura::apps
