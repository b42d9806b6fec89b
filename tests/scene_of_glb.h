// A made scene as a file gives it.
#pragma once

#include <utility>

#include <catch2/catch.hpp>

#include "obscura/apps/glb_writer.h"
#include "obscura/engine/gltf.h"

namespace obscura::tests {

inline engine::Scene sceneOfGlb(const apps::GlbScene& made) {
  auto scene = engine::sceneFromGltf(apps::glbFromScene(made), "made.glb");
  REQUIRE(scene.ok());
  return std::move(*scene);
}

}  // namespace obscura::tests
