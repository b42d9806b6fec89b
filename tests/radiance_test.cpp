// Radiance's HDR files, as the engine reads them itself.
#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>
#include <string>

#include "obscura/engine/image_file.h"
#include "temporary_folder.h"

using namespace obscura;

namespace {

engine::Result<engine::Image> read(const TemporaryFolder& folder, const std::string& bytes) {
  std::ofstream(folder / "a.hdr", std::ios::binary) << bytes;
  return engine::readImage(folder / "a.hdr");
}

std::string header(int width, int height) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
}

std::string text(std::initializer_list<int> bytes) { return std::string(bytes.begin(), bytes.end()); }

}  // namespace

TEST_CASE("radiance: pixels, old runs and new runs hold mantissas times a power of two, exactly") {
  const TemporaryFolder folder;
  const auto plain = read(folder, header(2, 2) + text({128, 64, 1, 129, 255, 0, 0, 136, 200, 0, 1, 1, 3, 4, 5, 0}));
  REQUIRE(plain.ok());
  const float* v = plain->row<float>(0);
  CHECK((v[0] == 1 && v[1] == 0.5f && v[2] == 0x1p-7f && v[3] == 255 && v[6] == std::ldexp(200.0f, -135) && v[8] == std::ldexp(1.0f, -135) && v[9] == 0));
  const auto old = read(folder, header(6, 1) + text({128, 0, 0, 129, 1, 1, 1, 3, 0, 128, 0, 129, 1, 1, 1, 1}));
  REQUIRE(old.ok());
  for (int x = 0; x < 6; ++x) CHECK((old->row<float>(0)[3 * x] == (x < 4) && old->row<float>(0)[3 * x + 1] == (x >= 4)));
  const auto runs = read(folder, header(8, 1) + text({2, 2, 0, 8, 136, 128, 8, 0, 1, 2, 3, 4, 5, 6, 7, 133, 0, 3, 9, 9, 9, 136, 129}));
  REQUIRE(runs.ok());
  const float* r = runs->row<float>(0);
  CHECK((r[0] == 1 && r[7 * 3] == 1 && r[3 * 3 + 1] == 3 * 0x1p-7f && r[4 * 3 + 2] == 0 && r[5 * 3 + 2] == 9 * 0x1p-7f));
}

TEST_CASE("radiance: what OpenImageIO writes is read as OpenImageIO reads it") {
  const TemporaryFolder folder;
  engine::Image image(40, 9, 3, engine::Format::F32);
  for (int k = 0; k < 40 * 9 * 3; ++k) image.row<float>(0)[k] = float(k / 50) * float(k % 11) * 0.37f;
  const auto bytes = engine::encodeImage(engine::FileFormat::Other, {{"color", {"R", "G", "B"}, image}}, "a.hdr");
  REQUIRE(bytes.ok());
  const auto here = read(folder, std::string(bytes->begin(), bytes->end()));
  REQUIRE(here.ok());
  for (int k = 0; k < 40 * 9; ++k) {
    const float* in = image.row<float>(0) + 3 * k;
    const float most = std::max(in[0], std::max(in[1], in[2]));
    for (int c = 0; c < 3; ++c) REQUIRE(std::fabs(here->row<float>(0)[3 * k + c] - in[c]) <= most / 127);
  }
}

TEST_CASE("radiance: a file that is not whole, or whose runs leave the row, is an error") {
  const TemporaryFolder folder;
  const std::string good = header(8, 2) + text({2, 2, 0, 8, 136, 1, 136, 2, 136, 3, 136, 129}) + text({2, 2, 0, 8, 136, 1, 136, 2, 136, 3, 136, 129});
  REQUIRE(read(folder, good).ok());
  for (size_t size = 0; size < good.size(); ++size) REQUIRE_FALSE(read(folder, good.substr(0, size)).ok());
  for (const std::string& bad : {text({2, 2, 0, 8, 137, 1, 136, 2, 136, 3, 136, 129}), text({2, 2, 0, 8, 0, 1, 136, 2, 136, 3, 136, 129}),
                                 text({2, 2, 0, 8, 128, 1, 136, 2, 136, 3, 136, 129}), text({1, 1, 1, 8, 0, 0, 0, 0, 0, 0, 0, 0}),
                                 text({5, 5, 5, 8, 1, 1, 1, 8, 0, 0, 0, 0})})
    CHECK_FALSE(read(folder, header(8, 1) + bad).ok());
  CHECK_FALSE(read(folder, header(999999999, 999999999) + "0000").ok());
  CHECK_FALSE(read(folder, header(16000, 16000) + "0000").ok());
  CHECK_FALSE(read(folder, header(0, 4) + "0000").ok());
}
