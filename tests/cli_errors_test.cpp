// obscura render when something is wrong: one line, the documented exit code, nothing left behind.
#include <catch2/catch.hpp>

#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>

#include "obscura/raster/target.h"
#include "cli_failure.h"
#include "cli_scene.h"
#include "run_program.h"

using namespace obscura;
using Words = std::vector<std::string>;

namespace {

struct Workplace : tests::SceneFolder {
  // Runs "render SCENE OPTIONS" and holds the outcome against what every failure must look like.
  Finished failing(int code, const Words& options, const std::string& says) const {
    return failingOn(scene, code, options, says);
  }
  Finished failingOn(const std::string& path, int code, const Words& options, const std::string& says) const {
    Words words = {"render", path};
    words.insert(words.end(), options.begin(), options.end());
    const size_t before = folder.files();
    const Finished f = runProgram(words);
    tests::checkFailure(f, code, says);
    CHECK(folder.files() == before);
    return f;
  }
};

}  // namespace

TEST_CASE("cli: what the command line cannot mean ends with 2 and says why") {
  const Workplace w;
  w.failing(2, {}, "nothing to do");
  w.failing(2, {"--digest", "--sise", "8x8"}, "--sise");
  w.failing(2, {"--digest", "more.glb"}, "more.glb");
  w.failing(2, {"--digest", "--size", "0x4"}, "WxH");
  for (const char* crop : {"1,2", "1,2,3", "1,2,3,4", "-1,0,4x4", "0,0,0x4", "0,0,4x4x4", "0 ,0,4x4", ""})
    w.failing(2, {"--digest", "--crop", crop}, "X,Y,WxH");
  w.failing(2, {"--digest", "--size", "60x50", "--crop", "40,0,21x9"}, "crop 40,0,21x9 does not lie in the image of 60x50");
  w.failing(2, {"--digest", "--border", "-1"}, "0...8192");
  w.failing(2, {"--digest", "--size", "16383x9", "--border", "1"}, "a border of 1 pixels");
  w.failing(2, {"--digest", "--supersample", "3"}, "1|2|4");
  w.failing(2, {"--digest", "--supersample", "4", "--size", "64x4097"}, "256x16388 sub-pixels");
  w.failing(2, {"--digest", "--size", "8193x8", "--supersample", "2"}, "16384 a side");
  for (const char* node : {"hall", "=1,1,1", "hall=", "hall=1,1", "hall=#12345", "hall=1,-1,1"})
    w.failing(2, {"--digest", "--ambient-node", node}, "NAME=COLOR");
  for (const Words& light : {Words{"--ambient-light", "bright"}, Words{"--ambient-light", "1,1"}, Words{"--ambient-light", "-1,0,0"}}) {
    Words words = {"--digest"};
    words.insert(words.end(), light.begin(), light.end());
    w.failing(2, words, "is not R,G,B, #RRGGBB, constant, extended or environment");
  }
  w.failing(2, {"--digest", "--ambient-light", "extended", "--ambient-light", "constant"}, "second of its kind");
  w.failing(2, {"--digest", "--ambient-node", "nowhere=1,1,1"}, "no node of the scene is named \"nowhere\"");
  for (const char* six : {"1,1,1", "1,1,1/1,1,1/1,1,1/1,1,1/1,1,1", "1,1,1/1,1,1/1,1,1/1,1,1/1,1,1/1,1,-1", "#fff/#fff/#fff/#fff/#fff/#fff",
                          "1,1,1/1,1,1/1,1,1/1,1,1/1,1,1/1,1,1/1,1,1"})
    w.failing(2, {"--digest", "--ambient-directional", six}, "PX/NX/PY/NY/PZ/NZ");
  w.failing(2, {"--digest", "--samples", "65"}, "1...64");
  w.failing(2, {"--digest", "--samples", "8.5"}, "1...64");
  w.failing(2, {"--digest", "--steps", "0"}, "1...16");
  w.failing(2, {"--digest", "--radius", "nan"}, "--radius");
  w.failing(2, {"--digest", "--radius", "-1"}, "--radius");
  w.failing(2, {"--digest", "--filter", "maybe"}, "on|off");
  w.failing(2, {"--digest", "--background", "#12345"}, "--background");
  w.failing(2, {"--digest", "--fov", "180"}, "--fov");
  w.failing(2, {"--digest", "--eye", "1,2"}, "X,Y,Z");
  w.failing(2, {"--digest", "--camera", "side"}, "0 \"front\"");
  w.failing(2, {"--digest", "--camera", "front", "--eye", "1,2,3"}, "camera");
  w.failing(2, {"--digest", "--scene", "7"}, "scene");
  w.failing(2, {"--digest", "--separation", "0"}, "--separation");
  w.failing(2, {"--digest", "--aov", "depth2", "--separation", "1e-300"}, "separation must be positive");
  const std::string one = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", lens = "1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-0.2,0";
  w.failing(2, {"--digest", "--view-matrix", one}, "need each other");
  w.failing(2, {"--digest", "--projection-matrix", lens}, "need each other");
  w.failing(2, {"--digest", "--view-matrix", "1,2,3", "--projection-matrix", lens}, "M0,...,M15");
  w.failing(2, {"--digest", "--view-matrix", one + ",0", "--projection-matrix", lens}, "M0,...,M15");
  w.failing(2, {"--digest", "--view-matrix", one, "--projection-matrix", one}, "not in front of the eye");
  for (const Words& other : {Words{"--eye", "1,2,3"}, Words{"--target", "1,2,3"}, Words{"--up", "0,0,1"}, Words{"--fov", "50"},
                             Words{"--camera", "front"}}) {
    Words words = {"--digest", "--view-matrix", one, "--projection-matrix", lens};
    words.insert(words.end(), other.begin(), other.end());
    w.failing(2, words, "cannot be had at once");
  }
  w.failing(2, {"--digest", "--tile", "48"}, "16|32|64");
  w.failing(2, {"--digest", "--target", "mmx"}, raster::targetName(raster::supportedTargets().back()));
#if defined(__x86_64__)
  w.failing(2, {"--digest", "--target", "neon"}, "not there on this machine");
#endif
  w.failing(2, {"--stats", "--reference"}, "--reference");
  for (const Words& words : {Words{}, Words{"paint"}, Words{"render"}}) {
    const Finished f = runProgram(words);
    CHECK(f.code == 2);
    CHECK(f.out.empty());
    CHECK(std::count(f.err.begin(), f.err.end(), '\n') == 1);
  }
}

TEST_CASE("cli: AOVs that an output cannot hold are refused before any work, with what can hold them") {
  const Workplace w;
  w.failing(2, {"--aov", "colour", "-o", w / "a.png"}, "color, depth");
  w.failing(2, {"--aov", "depth,instance", "-o", w / "a.pfm"}, ".npy or .exr");
  w.failing(2, {"--aov", "depth,color", "-o", "-"}, "--format exr");
  w.failing(2, {"-o", w / "a.png", "--format", "npy"}, "-o -");
  w.failing(2, {"-o", w / "a.gif"}, ".png, .exr, .pfm and .npy");
  w.failing(2, {"-o", w / "a.jpg"}, ".png, .exr, .pfm and .npy");
  w.failing(2, {"-o", w / "png"}, ".png, .exr, .pfm and .npy");
  w.failing(2, {"-o", w / "a.png", "-o", w / "a.png"}, "more than one");
  w.failing(2, {"-o", w / "a.png", "--stages", w / "a.png"}, "more than one");
  w.failing(2, {"-o", "-", "--stages", "-"}, "more than one");
  w.failing(2, {"--stages", w / "a.exr"}, ".png");
}

TEST_CASE("cli: a scene that is missing, cut short or no scene ends with 3 and no file") {
  const Workplace w;
  w.failingOn(w / "none.glb", 3, {"-o", w / "a.png"}, "none.glb");
  const std::vector<uint8_t> whole = tests::cornerScene().glb();
  for (size_t length : {size_t(0), size_t(11), size_t(100), whole.size() / 2, whole.size() - 1}) {
    const TemporaryFolder cut;
    tests::writeBytes(cut / "cut.glb", std::vector<uint8_t>(whole.begin(), whole.begin() + long(length)));
    w.failingOn(cut / "cut.glb", 3, {"-o", w / "a.png", "--digest"}, "cut.glb");
  }
  const TemporaryFolder other;
  tests::writeBytes(other / "bad\nname.gltf", {'{', '}'});
  w.failingOn(other / "bad\nname.gltf", 3, {"--digest"}, "bad name.gltf");  // still one line
}

TEST_CASE("cli: an image in which nothing is seen is refused, or accepted with a warning") {
  const Workplace w;
  const Words away = {"--eye", "1,1,5", "--target", "1,1,9", "-o", w / "a.png"};
  const Finished f = w.failing(3, away, "nothing is visible from this camera");
  REQUIRE(f.err.find("0,0,0 to 2,2,2") != std::string::npos);
  REQUIRE(f.err.find("--allow-empty") != std::string::npos);
  w.failing(3, {"--eye", "1,1,9", "--crop", "0,0,4x4", "-o", w / "a.png"}, "nothing is visible in this crop");
  Words words = {"render", w.scene, "--size", "32x32", "--allow-empty"};
  words.insert(words.end(), away.begin(), away.end());
  const Finished accepted = runProgram(words);
  REQUIRE(accepted.code == 0);
  REQUIRE(accepted.err.rfind("obscura: warning: nothing is visible", 0) == 0);
  REQUIRE(w.folder.files() == 2);
}

TEST_CASE("cli: an output that cannot be written ends with 4 before the scene is read, and leaves nothing") {
  const Workplace w;
  tests::writeBytes(w / "file", {'x'});
  // The scene does not exist: an exit code of 4 shows that the outputs were looked at first.
  w.failingOn(w / "none.glb", 4, {"-o", w / "file/a.png"}, "file/a.png: cannot write");
  w.failingOn(w / "none.glb", 4, {"-o", w / "nowhere/a.png"}, "there is no folder");
  REQUIRE(mkdir((w / "folder.png").c_str(), 0700) == 0);
  w.failingOn(w / "none.glb", 4, {"-o", w / "folder.png"}, "it is a folder");
  w.failingOn(w / "none.glb", 4, {"-o", w / "a.png", "--stages", w / "file/s.png"}, "file/s.png");
  w.failingOn(w / "none.glb", 4, {"-o", w / "a.png", "--picture", w / "file/p.png"}, "file/p.png");
}

TEST_CASE("cli: a full disk ends with 4, for files, pictures on standard output and reports") {
  const Workplace w;
  REQUIRE(symlink("/dev/full", (w / "full.png").c_str()) == 0);
  w.failing(4, {"-o", w / "full.png", "--digest"}, "full.png: cannot write");
  for (const Words& what : {Words{"-o", "-"}, Words{"--digest"}}) {
    Words words = {"render", w.scene, "--size", "32x32"};
    words.insert(words.end(), what.begin(), what.end());
    REQUIRE(exitCodeOf(startProgram(words, "/dev/full", w / "err")) == 4);
    REQUIRE(contentOf(w / "err").find("standard output: cannot write") != std::string::npos);
  }
}

TEST_CASE("cli: a long render shows a bar on a terminal, and a signal ends it with 128 + n and no file") {
  const Workplace w;
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE(terminal >= 0);
  REQUIRE(grantpt(terminal) == 0);
  REQUIRE(unlockpt(terminal) == 0);
  const pid_t pid = startProgram(
      {"render", w.scene, "--size", "2400x1800", "--reference", "--samples", "64", "--steps", "4", "-o", w / "a.png"},
      "/dev/null", ptsname(terminal));
  REQUIRE(pid > 0);
  std::string shown;
  const auto readUntil = [&](const std::string& text) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (shown.find(text) == shown.npos && std::chrono::steady_clock::now() < deadline) {
      pollfd ready = {terminal, POLLIN, 0};
      if (poll(&ready, 1, 100) <= 0) continue;
      char buffer[256];
      const ssize_t n = read(terminal, buffer, sizeof buffer);
      if (n <= 0) break;  // the program has ended
      shown.append(buffer, size_t(n));
    }
    return shown.find(text) != shown.npos;
  };
  CHECK(readUntil("2/3 rendering"));
  kill(pid, SIGTERM);
  CHECK(exitCodeOf(pid) == 128 + SIGTERM);
  shown.clear();
  CHECK(readUntil("\r\033[K"));  // the line is gone
  close(terminal);
  REQUIRE(w.folder.files() == 1);
}
