// How far depth and attributes may be from the truth; `obscura-bench accuracy` prints the same figures.
#include <catch2/catch.hpp>

#include "obscura/apps/accuracy.h"

using namespace obscura::apps;

namespace {

// Twice what is measured, or a little more.
struct Bound {
  const char* quantity;
  double maxUlp, rmsUlp;
};
constexpr Bound kAnywhere[] = {
    {"depth", 48, 0.75},       // the key is a float: half an ulp, and more where a plane is steep
    {"surface", 6e5, 4000},    // half of 1/256 pixel times the slope: slivers and planes seen from the edge
    {"weights", 3e4, 800},     // float planes in a cell: the narrower the triangle, the fewer bits are left
    {"texture", 6e3, 400},
    {"normal", 1e4, 400},
};
constexpr Bound kPlain[] = {
    {"depth", 48, 0.75}, {"surface", 3e4, 300}, {"weights", 500, 6}, {"texture", 300, 4}, {"normal", 300, 4},
};

}  // namespace

TEST_CASE("accuracy: depth, weights, textures and normals stay within their bounds of long double") {
  int rows = 0;
  for (const AccuracyRow& r : measureAccuracy()) {
    INFO(r.workload << ", " << r.quantity << ": max " << r.maxUlp << " ulp, rms " << r.rmsUlp << " ulp over "
                    << r.pixels);
    CHECK(r.pixels > 500);
    const bool plain = r.workload == "plain" || r.workload == "orthographic";
    for (const Bound& b : plain ? kPlain : kAnywhere) {
      if (r.quantity != b.quantity) continue;
      ++rows;
      CHECK(r.maxUlp <= b.maxUlp);
      CHECK(r.rmsUlp <= b.rmsUlp);
      CHECK(r.rmsUlp > 0);
    }
  }
  CHECK(rows == 49);
}
