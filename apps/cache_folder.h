// Where programs keep what took long to make, unless told otherwise.
#pragma once

#include <string>

namespace obscura::apps {

// $OBSCURA_CACHE, else $XDG_CACHE_HOME/obscura, else ~/.cache/obscura, each where the variable is an absolute path. Empty,
// which is nowhere: $OBSCURA_CACHE is "none", or no variable is set.
std::string defaultCacheFolder();

}  // namespace obscura::apps
