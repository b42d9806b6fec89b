#include "obscura/apps/cache_folder.h"

#include <cstdlib>

namespace obscura::apps {

std::string defaultCacheFolder() {
  const auto valueOf = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::string(value ? value : "");
  };
  const auto isAbsolute = [](const std::string& path) { return !path.empty() && path[0] == '/'; };
  if (const std::string own = valueOf("OBSCURA_CACHE"); own == "none" || isAbsolute(own)) return own == "none" ? "" : own;
  if (const std::string cache = valueOf("XDG_CACHE_HOME"); isAbsolute(cache)) return cache + "/obscura";
  const std::string home = valueOf("HOME");
  return isAbsolute(home) ? home + "/.cache/obscura" : "";
}

}  // namespace obscura::apps
