// In:  the bytes of an environment map's file.
// Out: the environment that was made of them before, from a folder.
#pragma once

#include <optional>
#include <string>

#include "obscura/engine/environment.h"

namespace obscura::engine {

// Where an environment is kept: by the hash of the map's bytes, the projection, the parts and the version of the method.
class EnvironmentCache {
 public:
  EnvironmentCache(const std::string& folder, raster::Span<const uint8_t> map, EnvironmentProjection projection, EnvironmentParts parts);

  // Empty if there is none, or if anything about it cannot be: a checksum, a size, a value that is negative or no number.
  std::optional<Environment> load() const;
  // A folder that cannot be written to is no error: the next run makes it all again.
  void store(const Environment& made) const;

 private:
  std::string file_, title_;
  EnvironmentParts parts_;
};

}  // namespace obscura::engine
