// A made scene as a file gives it.
#pragma once

#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "obscura/apps/glb_writer.h"
#include "obscura/engine/gltf.h"
#include "temporary_folder.h"

namespace obscura::tests {

inline engine::Scene sceneOfGlb(const apps::GlbScene& made) {
  const TemporaryFolder folder;
  const std::vector<uint8_t> glb = apps::glbFromScene(made);
  std::ofstream(folder / "scene.glb", std::ios::binary).write(reinterpret_cast<const char*>(glb.data()), std::streamsize(glb.size()));
  auto scene = engine::sceneFromGltf(folder / "scene.glb");
  REQUIRE(scene.ok());
  return std::move(*scene);
}

}  // namespace obscura::tests
