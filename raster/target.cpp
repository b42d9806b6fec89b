#include "obscura/raster/target.h"

#include "obscura/raster/dispatch.h"

namespace obscura::raster {
namespace {

struct Name {
  Target target;
  const char* name;
};
constexpr Name kNames[] = {{Target::Auto, "auto"}, {Target::Scalar, "scalar"}, {Target::Ssse3, "ssse3"},
                           {Target::Sse4, "sse4"}, {Target::Avx2, "avx2"},     {Target::Avx3, "avx3"},
                           {Target::Neon, "neon"}};

// Best first.
constexpr Target kByRank[] = {Target::Avx3, Target::Avx2, Target::Sse4, Target::Ssse3, Target::Neon, Target::Scalar};

bool runsHere(Target t) {
  if (t == Target::Scalar) return ((HWY_SCALAR | HWY_EMU128) & HWY_TARGETS) != 0;
  return (hwyTarget(t) & HWY_TARGETS & hwy::SupportedTargets()) != 0;
}

}  // namespace

const char* targetName(Target target) {
  for (const Name& n : kNames)
    if (n.target == target) return n.name;
  return "?";
}

std::optional<Target> targetFromName(std::string_view name) {
  for (const Name& n : kNames)
    if (n.name == name) return n.target;
  return std::nullopt;
}

std::vector<Target> supportedTargets() {
  std::vector<Target> all;
  for (Target t : kByRank)
    if (runsHere(t)) all.push_back(t);
  return all;
}

Target chooseTarget(Target wanted) {
  if (wanted != Target::Auto && runsHere(wanted)) return wanted;
  for (Target t : kByRank)
    if (runsHere(t)) return t;
  return Target::Scalar;
}

}  // namespace obscura::raster
