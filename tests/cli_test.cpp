// obscura render as a user meets it: files, formats, digests.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
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

TEST_CASE("cli: crops of a frame with a border, put together, are the file of the whole") {
  const Workplace w;
  const Words eye = {"--eye", "0.9,0.6,1.7", "--target", "1,0.8,0", "--radius", "0.6"};  // close up: much is off screen
  Words common = {"--aov", "transfer", "--border", "9", "--allow-empty"};
  common.insert(common.end(), eye.begin(), eye.end());
  const auto render = [&](Words more) {
    more.insert(more.end(), common.begin(), common.end());
    REQUIRE(w.render(more).code == 0);
  };
  render({"-o", w / "whole.npy"});
  Words borders = eye;
  borders.insert(borders.end(), {"--border", "9"});
  REQUIRE(w.digests(borders).at("color") != w.digests(eye).at("color"));
  const engine::Image whole = imageAt(w / "whole.npy");
  engine::Image stitched = whole;
  std::fill(stitched.bytes.begin(), stitched.bytes.end(), uint8_t(0));
  for (const auto& [x, y, width, height] : {std::array{0, 0, 19, 23}, {19, 0, 29, 23}, {0, 23, 19, 17}, {19, 23, 29, 17}}) {
    const std::string crop = std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(width) + "x" + std::to_string(height);
    render({"-o", w / "part.npy", "-o", w / "part.exr", "--crop", crop});
    const engine::Image part = imageAt(w / "part.npy");
    REQUIRE((part.width == width && part.height == height));
    for (int row = 0; row < height; ++row)
      std::memcpy(stitched.row<float>(y + row) + x * 3, part.row<float>(row), size_t(width) * 12);
    // Attributes of an EXR: name, type, size in bytes, value; a box is xMin, yMin, xMax, yMax.
    const auto box = [exr = contentOf(w / "part.exr")](const std::string& name) {
      const std::string start = name + '\0' + "box2i" + '\0';
      std::array<int32_t, 5> v{};
      const size_t at = exr.find(start);
      REQUIRE(at != exr.npos);
      std::memcpy(v.data(), exr.data() + at + start.size(), sizeof v);
      return v;
    };
    REQUIRE(box("dataWindow") == std::array<int32_t, 5>{16, x, y, x + width - 1, y + height - 1});
    REQUIRE(box("displayWindow") == std::array<int32_t, 5>{16, 0, 0, 47, 39});
  }
  REQUIRE(stitched.bytes == whole.bytes);
}

TEST_CASE("cli: --supersample changes the picture and not its size, and the reference makes the same") {
  const Workplace w;
  const auto plain = w.digests({"--aov", "all"}), one = w.digests({"--aov", "all", "--supersample", "1"});
  REQUIRE(one == plain);
  for (const char* s : {"2", "4"}) {
    const auto found = w.digests({"--aov", "all", "--supersample", s});
    REQUIRE(found.at("color").rfind("color 48x40x3 f32 ", 0) == 0);
    REQUIRE(found.at("color") != plain.at("color"));
    REQUIRE(w.digests({"--aov", "all", "--supersample", s, "--reference"}) == found);
    REQUIRE(w.digests({"--aov", "all", "--supersample", s, "--threads", "3", "--tile", "16", "--no-skip"}) == found);
    REQUIRE(w.digests({"--supersample", s}).at("color") == found.at("color"));
  }
  const Finished timed = w.render({"--timings", "--supersample", "4"});
  REQUIRE(timed.out.find("\ndownsample_ms ") != std::string::npos);
  REQUIRE(timed.out.find("\ndownsample_ms 0.000") == std::string::npos);
}

TEST_CASE("cli: every option of the ambient transfer and of the light changes the colour") {
  const Workplace w;
  const std::string standard = w.digests({}).at("color");
  for (const Words& options : std::vector<Words>{{"--ambient", "off"}, {"--ambient", "obscurance"}, {"--albedo", "own"}, {"--albedo", "radiance"},
                                                 {"--silhouette-bound", "off"},
                                                 {"--ambient-directional", "1,1,1/1,1,1/1,0,1/0,0,0/1,1,1/1,1,1"},
                                                 {"--quality", "draft"}, {"--quality", "high"}, {"--quality", "reference"}, {"--quality", "paper"},
                                                 {"--samples", "9"}, {"--steps", "2"}, {"--radius", "0.3"},
                                                 {"--membership", "classic"}, {"--membership", "sqrt"},
                                                 {"--membership", "exponential"}, {"--bias", "0.1"},
                                                 {"--interleave", "off"}, {"--filter", "off"},
                                                 {"--ambient-light", "0.5,1,1"}, {"--ambient-light", "extended"}, {"--background", "0,0,1"}}) {
    INFO(options[0] << " " << options[1]);
    REQUIRE(w.digests(options).at("color") != standard);
  }
}

TEST_CASE("cli: a quality is what its table says, and options of one's own go on top wherever they stand") {
  const Workplace w;
  const auto color = [&](const Words& options) { return w.digests(options).at("color"); };
  const auto marched = [&](const std::string& samples, const std::string& steps, const std::string& layers) {
    return color({"--estimator", "march", "--samples", samples, "--steps", steps, "--layers", layers, "--filter-guide", "plane"});
  };
  CHECK(color({}) == marched("4", "3", "1"));
  CHECK(color({"--quality", "draft"}) == marched("1", "2", "1"));
  CHECK(color({"--quality", "standard"}) == marched("4", "3", "1"));
  CHECK(color({"--quality", "high"}) == marched("8", "8", "1"));
  CHECK(color({"--quality", "reference"}) == marched("16", "8", "2"));
  CHECK(color({"--quality", "paper"}) == color({"--estimator", "paper", "--samples", "8", "--steps", "1", "--filter-guide", "depth"}));
  CHECK(color({"--quality", "paper", "--samples", "3"}) == color({"--samples", "3", "--quality", "paper"}));
  CHECK(color({"--quality", "paper", "--samples", "3"}) != color({"--quality", "paper"}));
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
    return w.digests({"--quality", "paper", "--radius", text(radius), "--bias", text(bias), "--filter-threshold", text(threshold),
                      "--size", "240x200"}).at("color");
  };
  const double r = 0.04 * std::sqrt(12.0);  // of the diagonal of 2 x 2 x 2
  const std::string stated = color(r, 0.01 * r, 0.2 * r);
  REQUIRE(stated == w.digests({"--quality", "paper", "--size", "240x200"}).at("color"));
  REQUIRE(stated != color(1.2 * r, 0.01 * r, 0.2 * r));
  REQUIRE(stated != color(r, 0.02 * r, 0.2 * r));
  REQUIRE(stated != color(r, 0.01 * r, 0.3 * r));
}

TEST_CASE("cli: the second depth layer begins at the separation, a tenth of R unless it is given") {
  const Workplace w;  // the fence at depth 4, the wall behind it at 5
  const auto all = [&](const Words& options) {
    Words words = {"--aov", "depth,depth2,depthback,transfer"};
    words.insert(words.end(), options.begin(), options.end());
    return w.digests(words);
  };
  const auto standard = all({}), nearer = all({"--separation", "0.99"}), farther = all({"--separation", "1.01"});
  REQUIRE(nearer == standard);
  REQUIRE(farther.at("depth2") != standard.at("depth2"));
  for (const char* name : {"depth", "depthback", "transfer"}) REQUIRE(farther.at(name) == standard.at(name));
  REQUIRE(all({"--radius", "9.9"}).at("depth2") == nearer.at("depth2"));
  REQUIRE(all({"--radius", "10.1"}).at("depth2") == farther.at("depth2"));
  REQUIRE(w.render({"--aov", "depth2", "-o", w / "a.npy"}).code == 0);
  REQUIRE(w.render({"--aov", "depth,depth2,depthback", "-o", w / "a.exr", "-o", w / "a.png"}).code == 0);
  REQUIRE(engine::digestLine("depth2", imageAt(w / "a.npy")) == standard.at("depth2"));
  REQUIRE(engine::readLayers(w / "a.exr")->size() == 3);
}

TEST_CASE("cli: matrices, column by column, give the picture of the camera that they are of") {
  const Workplace w;
  // As the file's camera: at (1, 1, 5), cot(0.35) = 2.7395, an image of 1.2 to 1, near 0.1, far infinite.
  const auto matrices = w.digests({"--aov", "all", "--view-matrix", "1,0,0,0,0,1,0,0,0,0,1,0,-1,-1,-5,1", "--projection-matrix",
                                   "2.282926799236486,0,0,0,0,2.7395121590837834,0,0,0,0,-1,-1,0,0,-0.2,0"});
  REQUIRE(matrices == w.digests({"--aov", "all"}));
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
  const std::string least = raster::targetName(raster::supportedTargets().back());
  REQUIRE(with({"--target", least}) == middle);
  REQUIRE(with({"--target", least, "--target", "1,0.5,1"}) == with({"--target", "1,0.5,1"}));
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
