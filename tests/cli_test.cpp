// obscura render as a user meets it: files, formats, digests.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "cli_scene.h"
#include "obscura/engine/aov.h"
#include "obscura/engine/digest.h"
#include "obscura/engine/image_file.h"
#include "obscura/raster/target.h"
#include "run_program.h"

using namespace obscura;
using Words = std::vector<std::string>;

namespace {

struct Workplace : tests::SceneFolder {
  // 48 x 40 pixels, unless the options say otherwise.
  Finished render(const Words& options) const {
    Words words = {"render", scene};
    if (std::find(options.begin(), options.end(), "--size") == options.end())
      words.insert(words.end(), {"--size", "48x40"});
    words.insert(words.end(), options.begin(), options.end());
    return runProgram(words);
  }
  // The lines of --digest, by their first word.
  std::map<std::string, std::string> digests(const Words& options) const {
    Words words = options;
    words.push_back("--digest");
    const Finished f = render(words);
    CHECK(f.code == 0);
    std::map<std::string, std::string> lines;
    std::istringstream in(f.out);
    for (std::string line; std::getline(in, line);) lines[line.substr(0, line.find(' '))] = line;
    return lines;
  }
};

engine::Image imageAt(const std::string& path) {
  const engine::Result<engine::Image> image = engine::readImage(path);
  INFO((image ? "" : image.error().text()));
  REQUIRE(image);
  return *image;
}

}  // namespace

TEST_CASE("cli: a render writes its one file and says nothing") {
  const Workplace w;
  const Finished f = w.render({"-o", w / "a.png"});
  REQUIRE(f.code == 0);
  REQUIRE(f.out.empty());
  REQUIRE(f.err.empty());
  REQUIRE(w.folder.files() == 2);
  const engine::Image image = imageAt(w / "a.png");
  REQUIRE((image.width == 48 && image.height == 40 && image.channels == 3 && image.format == engine::Format::U8));
}

TEST_CASE("cli: one AOV is written to the name given, several become STEM.AOV.EXT") {
  const Workplace w;
  REQUIRE(w.render({"-o", w / "one.v2.png", "--aov", "depth"}).code == 0);
  REQUIRE(w.folder.files() == 2);
  REQUIRE(imageAt(w / "one.v2.png").channels == 3);
  REQUIRE(w.render({"-o", w / "two.v2.png", "-o", w / "two.npy", "--aov", "depth,normal", "--aov", "depth"}).code == 0);
  REQUIRE(w.folder.files() == 6);
  for (const char* name : {"two.v2.depth.png", "two.v2.normal.png", "two.depth.npy", "two.normal.npy"})
    REQUIRE(imageAt(w / name).width == 48);
}

TEST_CASE("cli: NPY files are [H,W,C] of float32, or uint32 for ids, and hold the values whose digest is printed") {
  const Workplace w;
  const auto digests = w.digests({"--aov", "all", "-o", w / "a.npy"});
  for (const engine::AovInfo& info : engine::allAovs()) {
    INFO(info.name);
    const std::string path = w / (std::string("a.") + info.name + ".npy");
    const bool isId = info.channels[0] == "id";
    const std::string header = contentOf(path).substr(10, 118);
    REQUIRE(header.find(isId ? "'<u4'" : "'<f4'") != header.npos);
    REQUIRE(header.find("(40, 48, " + std::to_string(info.channels.size()) + ")") != header.npos);
    REQUIRE(engine::digestLine(info.name, imageAt(path)) == digests.at(info.name));
  }
}

TEST_CASE("cli: PFM and EXR hold the same floats") {
  const Workplace w;
  const auto digests = w.digests({"--aov", "color,depth,normal", "-o", w / "a.pfm", "-o", w / "a.exr"});
  for (const char* name : {"color", "depth", "normal"})
    REQUIRE(engine::digestLine(name, imageAt(w / (std::string("a.") + name + ".pfm"))) == digests.at(name));
  const engine::Result<std::vector<engine::Layer>> layers = engine::readLayers(w / "a.exr");
  REQUIRE(layers);
  REQUIRE(layers->size() == 3);
  for (const engine::Layer& layer : *layers)
    REQUIRE(engine::digestLine(layer.name, layer.image) == digests.at(layer.name));
}

TEST_CASE("cli: the PNG of the colour holds the bytes that the line 'display' is the digest of") {
  const Workplace w;
  const auto digests = w.digests({"-o", w / "a.png", "--picture", w / "b.png"});
  REQUIRE(digests.size() == 2);
  REQUIRE(engine::digestLine("display", imageAt(w / "a.png")) == digests.at("display"));
  REQUIRE(contentOf(w / "a.png") == contentOf(w / "b.png"));
}

TEST_CASE("cli: 16-bit PNGs round to the 8-bit ones") {
  const Workplace w;
  const std::string aovs = "color,normal,albedo,emissive,obscurance,transfer";
  REQUIRE(w.render({"--aov", aovs, "-o", w / "a.png"}).code == 0);
  REQUIRE(w.render({"--aov", aovs, "-o", w / "b.png", "--bits", "16"}).code == 0);
  for (const char* name : {"color", "normal", "albedo", "emissive", "obscurance", "transfer"}) {
    const engine::Image narrow = imageAt(w / (std::string("a.") + name + ".png"));
    const engine::Image wide = imageAt(w / (std::string("b.") + name + ".png"));
    REQUIRE(wide.format == engine::Format::U16);
    REQUIRE(narrow.bytes.size() * 2 == wide.bytes.size());
    int wrong = 0;  // 65535 = 257 x 255, and both are rounded: half a step and half of a small one
    for (size_t i = 0; i < narrow.bytes.size(); ++i)
      wrong += std::abs(int(wide.row<uint16_t>(0)[i]) - 257 * int(narrow.bytes[i])) > 129;
    INFO(name);
    REQUIRE(wrong == 0);
  }
}

TEST_CASE("cli: standard output gets the bytes of the file, and the report goes to standard error") {
  const Workplace w;
  for (const char* format : {"png", "pfm", "npy", "exr"}) {
    INFO(format);
    const std::string file = w / (std::string("a.") + format);
    REQUIRE(w.render({"-o", file}).code == 0);
    const Finished f = w.render({"-o", "-", "--format", format, "--digest"});
    REQUIRE(f.code == 0);
    REQUIRE(f.out == contentOf(file));
    REQUIRE(f.err.rfind("color 48x40x3 f32 ", 0) == 0);
  }
  REQUIRE(w.render({"-o", "-"}).out == contentOf(w / "a.png"));
}

TEST_CASE("cli: threads, instruction set, tile size, skipping and the reference change no digest") {
  const Workplace w;
  const auto expected = w.digests({"--aov", "all"});
  REQUIRE(expected.size() == engine::allAovs().size() + 1);
  for (const char* threads : {"1", "2", "3", "8"})
    REQUIRE(w.digests({"--aov", "all", "--threads", threads}) == expected);
  for (const char* tile : {"16", "32", "64"}) REQUIRE(w.digests({"--aov", "all", "--tile", tile}) == expected);
  for (raster::Target target : raster::supportedTargets())
    REQUIRE(w.digests({"--aov", "all", "--target", raster::targetName(target)}) == expected);
  REQUIRE(w.digests({"--aov", "all", "--no-skip"}) == expected);
  REQUIRE(w.digests({"--aov", "all", "--reference"}) == expected);
}

TEST_CASE("cli: every option of the ambient transfer and of the light changes the colour") {
  const Workplace w;
  const std::string standard = w.digests({}).at("color");
  for (const Words& options : std::vector<Words>{{"--ambient", "off"}, {"--ambient", "obscurance"}, {"--albedo", "own"},
                                                 {"--samples", "9"}, {"--steps", "2"}, {"--radius", "0.3"},
                                                 {"--membership", "classic"}, {"--membership", "sqrt"},
                                                 {"--membership", "exponential"}, {"--bias", "0.1"},
                                                 {"--interleave", "off"}, {"--filter", "off"},
                                                 {"--ambient-light", "0.5,1,1"}, {"--background", "0,0,1"}}) {
    INFO(options[0] << " " << options[1]);
    REQUIRE(w.digests(options).at("color") != standard);
  }
}

TEST_CASE("cli: the lengths' defaults are the stated fractions of the scene's size") {
  const Workplace w;
  const auto color = [&](double radius, double bias, double threshold) {
    const auto text = [](double v) {
      std::ostringstream out;
      out.precision(17);
      out << v;
      return out.str();
    };
    return w.digests({"--radius", text(radius), "--bias", text(bias), "--filter-threshold", text(threshold),
                      "--size", "240x200"}).at("color");
  };
  const double r = 0.04 * std::sqrt(12.0);  // of the diagonal of 2 x 2 x 2
  const std::string stated = color(r, 0.01 * r, 0.2 * r);
  REQUIRE(stated == w.digests({"--size", "240x200"}).at("color"));
  REQUIRE(stated != color(1.2 * r, 0.01 * r, 0.2 * r));
  REQUIRE(stated != color(r, 0.02 * r, 0.2 * r));
  REQUIRE(stated != color(r, 0.01 * r, 0.3 * r));
}

TEST_CASE("cli: --target is a point, an instruction set, or both") {
  const Workplace w;
  const Words eye = {"--eye", "-1,3,6"};
  const auto with = [&](Words more) {
    more.insert(more.end(), eye.begin(), eye.end());
    return w.digests(more).at("color");
  };
  const std::string middle = with({});
  REQUIRE(with({"--target", "1,1,1"}) == middle);  // the middle of the scene
  REQUIRE(with({"--target", "1,0.5,1"}) != middle);
  REQUIRE(with({"--target", "scalar"}) == middle);
  REQUIRE(with({"--target", "scalar", "--target", "1,0.5,1"}) == with({"--target", "1,0.5,1"}));
}

TEST_CASE("cli: a background in hexadecimal is in the picture as it was given") {
  const Workplace w;
  REQUIRE(w.render({"--background", "#12aBef", "-o", w / "a.png"}).code == 0);
  const engine::Image image = imageAt(w / "a.png");
  REQUIRE((image.bytes[0] == 0x12 && image.bytes[1] == 0xAB && image.bytes[2] == 0xEF));
}

TEST_CASE("cli: planes that show no texture still see through its holes") {
  const Workplace w;
  const auto all = w.digests({"--aov", "all"});
  for (const char* name : {"depth", "triangle", "position"})
    REQUIRE(w.digests({"--aov", name}).at(name) == all.at(name));
}

TEST_CASE("cli: the stages are one picture of six tiles") {
  const Workplace w;
  REQUIRE(w.render({"--stages", w / "s.png", "--size", "64x32"}).code == 0);
  REQUIRE(w.folder.files() == 2);
  const engine::Image image = imageAt(w / "s.png");
  REQUIRE(image.width > 3 * 64);
  REQUIRE(image.height > 2 * 32);
  REQUIRE(image.width < 4 * 64);
}

TEST_CASE("cli: the report has plain names, and --json makes one object of it") {
  const Workplace w;
  const Finished text = w.render({"--stats", "--timings"});
  REQUIRE(text.code == 0);
  for (const char* name : {"triangles_drawn ", "tiles_empty ", "load_ms ", "gbuffer_ms ", "frame_ms ", "write_ms "})
    REQUIRE(("\n" + text.out).find(std::string("\n") + name) != std::string::npos);
  const Finished all = w.render({"--json", "-o", w / "a.png"});
  REQUIRE(all.code == 0);
  const nlohmann::json json = nlohmann::json::parse(all.out);
  REQUIRE(json["digests"][0]["name"] == "color");
  REQUIRE(json["digests"][0]["hash"].get<std::string>().size() == 32);
  REQUIRE(json["statistics"]["triangles"] == 8);
  const auto pixels = [&](const char* kind) {
    return json["statistics"][std::string("transfer_pixels_") + kind].get<int>();
  };
  const std::string size = json["digests"][0]["size"];
  const int width = std::stoi(size), height = std::stoi(size.substr(size.find('x') + 1));
  REQUIRE(pixels("empty") + pixels("open") + pixels("sampled") == width * height);
  const nlohmann::json unskipped = nlohmann::json::parse(w.render({"--json", "--stats", "--no-skip"}).out);
  REQUIRE(unskipped["statistics"]["transfer_pixels_open"] == 0);
  REQUIRE(json["timings"]["frame_ms"] > 0);
  REQUIRE(!nlohmann::json::parse(w.render({"--json", "--stats"}).out).contains("timings"));
}

TEST_CASE("cli: --help and --version end with 0 and name what there is") {
  const Finished help = runProgram({"render", "--help"});
  REQUIRE(help.code == 0);
  for (const engine::AovInfo& info : engine::allAovs()) REQUIRE(help.out.find(info.name) != std::string::npos);
  for (const char* word : {"Examples:", "--samples", "--filter-threshold", "--no-skip", "Exit codes:"})
    REQUIRE(help.out.find(word) != std::string::npos);
  REQUIRE(runProgram({"--help"}).code == 0);
  REQUIRE(runProgram({"--version"}).out.rfind("obscura ", 0) == 0);
}
