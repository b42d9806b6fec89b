#include <catch2/catch.hpp>

#include <cstring>

#include "obscura/engine/digest.h"

using namespace obscura::engine;

namespace {

Image ramp() {  // 3 x 3 pixels of 5 channels, bytes 3, 10, 17, ...
  Image image(3, 3, 5, Format::U8);
  for (size_t i = 0; i < image.bytes.size(); ++i) image.bytes[i] = uint8_t(i * 7 + 3);
  return image;
}

}  // namespace

TEST_CASE("digest: it is XXH3-128 of the raw bytes, as the xxhsum program prints it") {
  REQUIRE(digest(ramp()) == "53e78b811500813c69152e7bce3a2dbd");  // xxhsum -H2
  Image floats(4, 3, 1, Format::F32);
  for (int i = 0; i < 12; ++i) floats.row<float>(0)[i] = float(i) * 0.25f - 1;
  REQUIRE(digest(floats) == "394385c08b3ef90b2d44fa332f821fd0");  // of '<f4' values
  REQUIRE(digest(Image()) == "99aa06d3014798d86001c324468d497f");
}

TEST_CASE("digest: the line names size, channels and type") {
  REQUIRE(digestLine("color", ramp()) == "color 3x3x5 u8 53e78b811500813c69152e7bce3a2dbd");
  REQUIRE(digestLine("z", Image(2, 1, 1, Format::F32)).substr(0, 12) == "z 2x1x1 f32 ");
  REQUIRE(digestLine("id", Image(2, 1, 1, Format::U32)).substr(0, 13) == "id 2x1x1 u32 ");
  REQUIRE(digestLine("h", Image(2, 1, 1, Format::U16)).substr(0, 12) == "h 2x1x1 u16 ");
}

TEST_CASE("digest: one bit anywhere changes it, and +0 differs from -0") {
  const std::string whole = digest(ramp());
  for (size_t i = 0; i < ramp().bytes.size(); ++i) {
    Image other = ramp();
    other.bytes[i] ^= 1;
    REQUIRE(digest(other) != whole);
  }
  Image zero(1, 1, 1, Format::F32), negative = zero;
  negative.row<float>(0)[0] = -0.0f;
  REQUIRE(digest(zero) != digest(negative));
}
