// obscura envmap as a user meets it: conversions, what it prints, errors.
#include <catch2/catch.hpp>

#include <algorithm>

#include "obscura/engine/image_file.h"
#include "cli_failure.h"
#include "run_program.h"

using namespace obscura;
using Words = std::vector<std::string>;

namespace {

struct Workplace {
  TemporaryFolder folder;
  std::string sky = folder / "sky.pfm";

  Workplace() {
    engine::Image image(32, 16, 3, engine::Format::F32);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 96; ++x) image.row<float>(y)[x] = float(x / 3 % 8) + 0.1f * float(y);
    const auto bytes = engine::encodeImage(engine::FileFormat::Pfm, {{"color", {"R", "G", "B"}, image}});
    REQUIRE(engine::writeFileAtomically(sky, *bytes).ok());
  }
  std::string operator/(const std::string& name) const { return folder / name; }
  Finished run(Words words) const {
    words.insert(words.begin(), "envmap");
    return runProgram(words);
  }
  void failing(int code, const Words& words, const std::string& says) const {
    const size_t before = folder.files();
    tests::checkFailure(run(words), code, says);
    CHECK(folder.files() == before);
  }
};

}  // namespace

TEST_CASE("cli: envmap writes the other projection and says what a round trip loses") {
  const Workplace w;
  for (const auto& [to, file, width, height] : {std::tuple{"latlong", "a.npy", 32, 16}, {"sphere", "a.pfm", 26, 26},
                                                {"cube", "a.exr", 40, 30}, {"paraboloid", "a.hdr", 38, 19}, {"cube", "a.png", 40, 30}}) {
    const Finished f = w.run({w.sky, "-o", w / file, "--to", to});
    INFO(to << " " << file << " " << f.err);
    REQUIRE(f.code == 0);
    CHECK(f.err.empty());
    CHECK(f.out.rfind("latlong 32x16 -> " + std::string(to) + " " + std::to_string(width) + "x" + std::to_string(height) + "\nround_trip_rmse ", 0) == 0);
    for (const char* name : {"\nround_trip_relative ", "\nround_trip_largest ", "\nround_trip_rmse_below_1 "}) CHECK(f.out.find(name) != f.out.npos);
    const auto image = engine::readImage(w / file);
    REQUIRE(image);
    CHECK((image->width == width && image->height == height && image->channels == 3));
  }
  REQUIRE(w.run({w / "a.exr", "-o", w / "back.pfm", "--from", "cube", "--to", "latlong", "--size", "16x8"}).code == 0);
  CHECK(engine::readImage(w / "back.pfm")->width == 16);
  const Finished help = runProgram({"envmap", "--help"});
  CHECK((help.code == 0 && help.out.find("--from") != help.out.npos));
}

TEST_CASE("cli: envmap that cannot be done ends with the documented code, one line and no file") {
  const Workplace w;
  const std::string out = w / "out.exr";
  w.failing(2, {w.sky, "-o", out}, "--to");
  w.failing(2, {w.sky, "-o", out, "--to", "disc"}, "latlong, sphere, cube, paraboloid");
  w.failing(2, {w.sky, "-o", out, "--to", "cube", "--from", "disc"}, "disc");
  w.failing(2, {w.sky, "-o", w / "out.jpg", "--to", "cube"}, ".exr, .hdr");
  w.failing(2, {w.sky, "-o", w / "out", "--to", "cube"}, ".exr, .hdr");
  for (const char* size : {"64x64", "0x0", "64", "64x48x1", "x", "65536x49152", "64.0x48"}) w.failing(2, {w.sky, "-o", out, "--to", "cube", "--size", size}, "4 to 3");
  w.failing(3, {w / "none.hdr", "-o", out, "--to", "cube"}, "none.hdr");
  w.failing(3, {w.sky, "-o", out, "--to", "cube", "--from", "sphere"}, "32 x 16");
  w.failing(3, {w.folder.path, "-o", out, "--to", "cube"}, "cannot read");
  w.failing(4, {w.sky, "-o", w / "nowhere/out.exr", "--to", "cube"}, "nowhere");
}
