// obscura render: a glTF scene in; images, digests, statistics and timings out.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/frame_options.h"
#include "obscura/apps/outputs.h"

namespace obscura::apps {

class RenderCommand {
 public:
  void addTo(CLI::App& program);  // the subcommand and its options
  int run();                      // after parsing; returns the exit code

 private:
  int render();
  engine::Result<std::vector<Output>> plan();
  engine::Result<engine::Scene> load(bool textures) const;
  engine::Result<std::vector<std::vector<uint8_t>>> encode(const std::vector<Output>& outputs,
                                                           const engine::Frame& frame) const;

  FrameOptions options_;
  OutputRequest request_;
  std::string scene_;
  std::vector<std::string> aovNames_;
  bool digest_ = false, stats_ = false, timings_ = false, json_ = false, allowEmpty_ = false, quiet_ = false;
};

}  // namespace obscura::apps
