// In: the outputs and AOVs of the command line.  Out: which file gets which AOVs, and the files' bytes.
#pragma once

#include <string>
#include <vector>

#include "obscura/engine/aov.h"
#include "obscura/engine/frame.h"
#include "obscura/engine/image_file.h"
#include "obscura/engine/result.h"

namespace obscura::apps {

struct OutputRequest {
  std::vector<std::string> outputs;  // as given to -o; "-" is standard output
  std::vector<engine::Aov> aovs;     // without repetition
  std::string format;                // of "-"; empty: png
  std::string picture;               // a file for the colour alone; may be empty
  std::string stages;                // a contact sheet; may be empty
  int bits = 8;                      // of PNG channels
};

struct Output {
  std::string path;  // "-" is standard output
  engine::FileFormat format = engine::FileFormat::Png;
  std::vector<engine::Aov> aovs;  // more than one only where the format holds layers
  bool stages = false;            // the contact sheet instead
};

// Several AOVs to a format of one image become STEM.AOV.EXT. Usage: a format that obscura does not write or that cannot
// hold the AOV, two outputs of one name, several files on standard output.
engine::Result<std::vector<Output>> planOutputs(const OutputRequest& request);

// CannotWrite where a file cannot be made at this path, as far as that can be known beforehand. Changes nothing.
engine::Result<engine::Done> checkWritable(const std::string& path);

// What has to be in the frame for these outputs, `aovs` and a look at whether anything was drawn.
std::vector<engine::Aov> aovsToRender(const std::vector<engine::Aov>& aovs, const std::vector<Output>& outputs);

// The bytes of the file. Usage or CannotWrite; throws std::bad_alloc.
engine::Result<std::vector<uint8_t>> encodeOutput(const Output& output, const engine::Frame& frame, int bits);

}  // namespace obscura::apps
