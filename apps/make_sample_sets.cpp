// obscura-make-sample-sets > post/sample_sets.cpp : writes the constants of the ambient transfer pass as C++.
#include <cstdio>
#include <string>

#include "obscura/post/make_dealt_seed.h"
#include "obscura/post/make_sample_set.h"
#include "obscura/post/sample_sets.h"
#include "obscura/raster/exact_math.h"

namespace {

using namespace obscura;

// Prints the elements of a list, as many as fit into a line of 120 columns.
class Wrapped {
 public:
  void add(const std::string& element) {
    if (column_ == 0 || column_ + element.size() + 2 > 120) {
      std::fputs(column_ == 0 ? "    " : "\n    ", stdout);
      column_ = 4;
    } else {
      std::fputs(" ", stdout);
      ++column_;
    }
    std::printf("%s,", element.c_str());
    column_ += element.size() + 1;
  }
  void end() { std::puts("\n};"); }

 private:
  size_t column_ = 0;
};

std::string floatLiteral(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%af", double(float(value)) + 0.0);  // every bit; no -0
  return text;
}

constexpr const char* kHead =
    R"(// Made by obscura-make-sample-sets: change post/make_sample_set.cpp and run it again, not this file.
#include "obscura/post/sample_sets.h"

#include "obscura/post/dealt_samples.h"

namespace obscura::post {
namespace {

struct Sample {
  uint16_t x;      // xi_x = x / 65536
  uint8_t y, z;    // xi_y = (y + 1/2) / n, xi_z = (z + 1/2) / n
};

constexpr int firstOfSet(int n) { return n * (n - 1) / 2; }
constexpr int kSampleCount = firstOfSet(kMaxSamples + 1);

// The sets of 1, 2, ... points, one after the other.
constexpr Sample kSamples[kSampleCount] = {)";

constexpr const char* kMiddle = R"(
struct Points {
  glm::vec3 xi[kSampleCount];
};

constexpr Points pointsFromSamples() {
  Points points{};
  for (int n = 1; n <= kMaxSamples; ++n)
    for (int i = firstOfSet(n); i < firstOfSet(n + 1); ++i) {
      points.xi[i].x = float(kSamples[i].x) / 65536.0f;
      points.xi[i].y = float(2 * kSamples[i].y + 1) / float(2 * n);
      points.xi[i].z = float(2 * kSamples[i].z + 1) / float(2 * n);
    }
  return points;
}

constexpr Points kPoints = pointsFromSamples();
)";

constexpr const char* kTail = R"(
}  // namespace

raster::Span<const glm::vec3> sampleSet(int n) {
  if (n < 1 || n > kMaxSamples) return {};
  return {kPoints.xi + firstOfSet(n), size_t(n)};
}

const std::array<uint8_t, 16>& rotationOrder() { return kRotationOrder; }
const std::array<glm::vec2, 16>& rotations() { return kRotations; }

uint32_t boxSeed(int n) { return kBoxSeeds[n - 1]; }

}  // namespace obscura::post)";

}  // namespace

int main() {
  std::puts(kHead);
  Wrapped samples;
  for (int n = 1; n <= post::kMaxSamples; ++n)
    for (const post::SamplePoint& p : post::makeSampleSet(n))
      samples.add("{" + std::to_string(p.x) + ", " + std::to_string(p.yRank) + ", " + std::to_string(p.zRank) + "}");
  samples.end();
  std::puts(kMiddle);

  std::printf("constexpr std::array<uint8_t, 16> kRotationOrder = {\n");
  Wrapped order, pairs;
  const std::array<uint8_t, 16> pattern = post::makeRotationPattern();
  for (uint8_t j : pattern) order.add(std::to_string(j));
  order.end();
  std::printf("\nconstexpr std::array<glm::vec2, 16> kRotations = {\n");
  for (uint8_t j : pattern) {
    // The angle is reduced to the first quarter, so that the four axes come out as 0 and 1 exactly.
    const double angle = (j & 3) * 0x1.921fb54442d18p-2, c = raster::exactCos(angle), s = raster::exactSin(angle);
    const double turned[4][2] = {{c, s}, {-s, c}, {-c, -s}, {s, -c}};
    pairs.add("glm::vec2(" + floatLiteral(turned[j >> 2][0]) + ", " + floatLiteral(turned[j >> 2][1]) + ")");
  }
  pairs.end();

  std::printf("\nconstexpr uint16_t kBoxSeeds[kMaxSamples] = {\n");
  Wrapped seeds;
  for (int n = 1; n <= post::kMaxSamples; ++n) seeds.add(std::to_string(post::makeBoxSeed(n)));
  seeds.end();
  std::puts(kTail);
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? 0 : 4;
}
