// Keeps README.md and docs/*.md true: their commands run, their tables are those of the program, their links lead
// somewhere, their code is the code that is compiled elsewhere.
#include <catch2/catch.hpp>

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "obscura/engine/aov.h"
#include "obscura/engine/gltf.h"
#include "obscura/engine/image_file.h"
#include "obscura/raster/target.h"
#include "obscura/tests/markdown.h"
#include "obscura/tests/temporary_folder.h"

namespace fs = std::filesystem;

namespace {

const std::string kRoot = OBSCURA_SOURCE_DIR "/";
// Relative to the root.
Lines documents() {
  Lines all = {"README.md"};
  for (const auto& entry : fs::directory_iterator(kRoot + "docs"))
    if (entry.path().extension() == ".md") all.push_back("docs/" + entry.path().filename().string());
  std::sort(all.begin(), all.end());
  return all;
}

struct Ran {
  int code;
  std::string output;  // both streams
};

// Runs a script in a folder, with the programs under test on the PATH.
Ran shell(const TemporaryFolder& folder, const std::string& script) {
  std::ofstream(folder / ".script") << "PATH='" << OBSCURA_BIN_DIR << "':$PATH\n" << script;
  const std::string command = "cd '" + folder.path + "' && bash -euo pipefail .script > .log 2>&1 < /dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentsOf(folder / ".log")};
}

std::string helpOfRender() {
  const TemporaryFolder folder;
  const Ran help = shell(folder, "obscura render --help\n");
  REQUIRE(help.code == 0);
  return help.output;
}

// Commands that would install, build, test or ask git: they are only looked up. The rest of the block runs.
std::string withoutSetUp(const std::string& block, const TemporaryFolder& folder) {
  std::string rest;
  for (const std::string& line : linesOf(block)) {
    INFO(line);
    std::istringstream words(line);
    std::string first, word;
    words >> first;
    if (first.rfind("./", 0) == 0 && fs::exists(kRoot + first)) {
      const Ran help = shell(folder, "'" + kRoot + first + "' --help\n");
      CHECK(help.code == 0);
      while (words >> word)
        if (word.rfind("--", 0) == 0) CHECK(help.output.find(word) != std::string::npos);
    } else if (first.rfind("scripts/", 0) == 0) {
      CHECK(fs::exists(kRoot + first));
    } else if (first == "sudo" || first == "apt") {
      const std::string setUp = contentsOf(kRoot + "scripts/setup.sh");
      for (const std::string& package : matches(line, "\\b(lib[a-z0-9-]+)"))
        CHECK(setUp.find(package) != std::string::npos);
    } else if (first != "cmake" && first != "git") {
      rest += line + "\n";
    }
  }
  return rest;
}

// Every file that a line "obscura ... -o FILE" names must be there afterwards, by itself or as STEM.AOV.EXT.
void checkOutputs(const std::string& script, const TemporaryFolder& folder) {
  for (const std::string& line : matches(script, "(?:^|\\n)(obscura[^\\n]*)")) {
    for (const std::string& name : matches(line, "(?:-o|--picture|--stages) ([^ ]+)")) {
      INFO(line << ": " << name);
      const fs::path path(name);
      bool found = name == "-";
      for (const auto& entry : fs::directory_iterator(folder.path)) {
        const fs::path other = entry.path().filename();
        const bool isPart = other.string().rfind(path.stem().string() + ".", 0) == 0;
        found |= other == path || (isPart && other.extension() == path.extension());
      }
      CHECK(found);
    }
  }
}

struct Option {
  std::string name;  // with its placeholder, as "--size WxH"
  Lines brackets;    // what its description says in brackets: the default
};

// An option's line is indented by two blanks; its description continues far to the right of that.
std::vector<Option> optionsOf(const std::string& help) {
  std::vector<Option> options;
  std::vector<std::string> texts;
  const std::regex line("^  (-[^ ]+)( [^ ]+)?( \\.\\.\\.)?( .*|$)");
  for (const std::string& l : linesOf(help)) {
    std::smatch m;
    if (l.rfind("  -h,--help", 0) == 0) continue;
    if (std::regex_match(l, m, line)) {
      options.push_back({m.str(1) + m.str(2), {}});
      texts.push_back(m.str(4));
    } else if (l.rfind("          ", 0) == 0 && !texts.empty()) {
      texts.back() += " " + l.substr(l.find_first_not_of(' '));
    }
  }
  for (size_t i = 0; i < options.size(); ++i) options[i].brackets = matches(texts[i], "\\[([^\\]]*)\\]");
  return options;
}

// Each side halved twice over: the mean of 4 x 4 pixels, rounded.
obscura::engine::Image quarter(const obscura::engine::Image& in) {
  obscura::engine::Image out(in.width / 4, in.height / 4, in.channels, in.format);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width * out.channels; ++x) {
      int sum = 8;
      for (int k = 0; k < 16; ++k)
        sum += in.row<uint8_t>(y * 4 + k / 4)[(x / in.channels * 4 + k % 4) * in.channels + x % in.channels];
      out.row<uint8_t>(y)[x] = uint8_t(sum / 16);
    }
  return out;
}

std::string shownLimit(uint64_t value, bool bytes) {
  if (bytes) return std::to_string(value >> 30) + " GiB";
  int k = 0;
  while (value >> k != 1) ++k;
  return value > 100000 && value == uint64_t(1) << k ? "2^" + std::to_string(k) : std::to_string(value);
}

}  // namespace

TEST_CASE("readme: the commands of README and docs run, and leave the files that they name") {
  int blocks = 0;
  for (const std::string& document : documents()) {
    const TemporaryFolder folder;
    REQUIRE(shell(folder, "obscura-scene demo -o scene.glb\n").code == 0);
    for (const std::string& block : blocksOf(contentsOf(kRoot + document), "sh")) {
      std::string script = withoutSetUp(block, folder);
      // A build with sanitizers has no scalar kernels.
      const std::string least = obscura::raster::targetName(obscura::raster::supportedTargets().back());
      script = std::regex_replace(script, std::regex("--target scalar"), "--target " + least);
      if (script.find_first_not_of(" \n") == std::string::npos) continue;
      const Ran ran = shell(folder, script);
      INFO(document << ":\n" << block << "printed:\n" << ran.output);
      CHECK(ran.code == 0);
      checkOutputs(script, folder);
      ++blocks;
    }
  }
  CHECK(blocks >= 2);
}

TEST_CASE("readme: the table of options has those of --help, their values and their defaults") {
  const std::vector<Option> expected = optionsOf(helpOfRender());
  REQUIRE(expected.size() > 20);
  std::vector<Option> found;
  for (const Lines& row : tableOf(contentsOf(kRoot + "README.md"), "option"))
    if (row[0][0] == '`')
      found.push_back({row[0].substr(1, row[0].size() - 2), matches(row[1], "\\[([^\\]]*)\\](?!\\()")});
  for (const Option& e : expected) {
    INFO(e.name << " is in --help");
    const auto row = std::find_if(found.begin(), found.end(), [&](const Option& f) { return f.name == e.name; });
    CHECK(row != found.end());
    if (row != found.end()) CHECK(row->brackets == e.brackets);
  }
  for (const Option& f : found) {
    INFO(f.name << " is in the README");
    CHECK(std::any_of(expected.begin(), expected.end(), [&](const Option& e) { return f.name == e.name; }));
  }
}

TEST_CASE("readme: the table of AOVs is the program's, names and channels") {
  std::vector<Lines> expected, found;
  for (const obscura::engine::AovInfo& info : obscura::engine::allAovs()) {
    std::string channels;
    for (const std::string& c : info.channels) channels += (channels.empty() ? "" : " ") + c;
    expected.push_back({"`" + std::string(info.name) + "`", channels});
  }
  for (const Lines& row : tableOf(contentsOf(kRoot + "README.md"), "`--aov`")) found.push_back({row[0], row[1]});
  CHECK(found == expected);
}

TEST_CASE("readme: the exit codes are those of --help") {
  const std::string help = helpOfRender();
  Lines found;
  for (const Lines& row : tableOf(contentsOf(kRoot + "README.md"), "code")) found.push_back(row[0]);
  CHECK(found == matches(help.substr(help.find("Exit codes: ")), "(?:: |, )([0-9]+(?:\\+n)?) "));
}

TEST_CASE("readme: links lead to files and headings that exist") {
  int links = 0;
  for (const std::string& document : documents()) {
    const std::string markdown = contentsOf(kRoot + document);
    for (const std::string& link : matches(proseOf(markdown), "\\]\\(([^)]+)\\)")) {
      if (link.find("://") != std::string::npos) continue;
      INFO(document << " links to " << link);
      const std::string file = link.substr(0, link.find('#'));
      const std::string from = kRoot + document, folder = fs::path(from).parent_path().string();
      const std::string target = file.empty() ? from : folder + "/" + file;
      CHECK(fs::exists(target));
      const size_t hash = link.find('#');
      if (hash != std::string::npos) CHECK(hasHeading(contentsOf(target), link.substr(hash + 1)));
      ++links;
    }
  }
  CHECK(links > 5);
}

TEST_CASE("readme: files and tests that are named exist") {
  std::string tests;
  for (const auto& entry : fs::directory_iterator(kRoot + "tests"))
    if (entry.path().extension() == ".cpp") tests += contentsOf(entry.path().string());
  int files = 0;
  for (const std::string& document : documents()) {
    const std::string prose = proseOf(contentsOf(kRoot + document));
    const char* paths = "`((?:raster|post|engine|apps|tests|scripts|docs|cmake)/[A-Za-z0-9_./-]+)`";
    for (const std::string& file : matches(prose, paths)) {
      INFO(document << " names " << file);
      CHECK(fs::exists(kRoot + file));
      ++files;
    }
    for (const std::string& wrapped : matches(prose, "(?:^|[^*])\\*([a-z ]+: [^*]+)\\*(?!\\*)")) {
      const std::string name = std::regex_replace(wrapped, std::regex("\\s+"), " ");
      INFO(document << " names the test " << name);
      CHECK(tests.find("TEST_CASE(\"" + name) != std::string::npos);
    }
  }
  CHECK(files > 40);
}

TEST_CASE("readme: the embedding example is the program that the consumer test builds") {
  const std::string readme = contentsOf(kRoot + "README.md");
  const std::string cmake = contentsOf(kRoot + "tests/consumer/CMakeLists.txt");
  CHECK(blocksOf(readme, "cpp") == Lines{contentsOf(kRoot + "tests/consumer/main.cpp")});
  REQUIRE(blocksOf(readme, "cmake").size() == 1);
  for (const std::string& line : linesOf(blocksOf(readme, "cmake")[0])) {
    INFO(line);
    CHECK(cmake.find(line) != std::string::npos);
  }
}

TEST_CASE("readme: docs/gltf.md lists the extensions and limits of the loader") {
  const std::string document = contentsOf(kRoot + "docs/gltf.md");
  const std::string loader = contentsOf(kRoot + "engine/gltf_document.cpp");
  const size_t begin = loader.find("kSupportedExtensions[]");
  REQUIRE(begin != std::string::npos);
  const Lines expected = matches(loader.substr(begin, loader.find("};", begin) - begin), "\"([A-Za-z_]+)\"");
  Lines found;
  for (const Lines& row : tableOf(document, "extension")) found.push_back(row[0].substr(1, row[0].size() - 2));
  std::sort(found.begin(), found.end());
  CHECK(found == expected);

  const obscura::engine::LoadLimits l;
  const std::vector<Lines> limits = {
      {"`fileBytes`", shownLimit(l.fileBytes, true)}, {"`triangles`", shownLimit(l.triangles, false)},
      {"`instancedTriangles`", shownLimit(l.instancedTriangles, false)},
      {"`instances`", shownLimit(l.instances, false)},
      {"`geometryBytes`", shownLimit(l.geometryBytes, true)}, {"`zeroElements`", shownLimit(l.zeroElements, false)},
      {"`lights`", shownLimit(l.lights, false)}, {"`nodeDepth`", shownLimit(l.nodeDepth, false)}, {"`textureSize`", shownLimit(l.textureSize, false)},
      {"`textureBytes`", shownLimit(l.textureBytes, true)}};
  std::vector<Lines> shown;
  for (const Lines& row : tableOf(document, "limit")) shown.push_back({row[0], row[1]});
  CHECK(shown == limits);
}

// Named "golden" so that scripts/bless renews it, too.
TEST_CASE("golden: the README's picture is what the program renders, scaled down by four") {
  using namespace obscura::engine;
  const TemporaryFolder folder;
  const Ran ran = shell(folder, "obscura-scene demo -o scene.glb\n"
                                "obscura render scene.glb --size 800x448 --background '#9cc4e8' --stages stages.png\n");
  INFO(ran.output);
  REQUIRE(ran.code == 0);
  const auto stages = readImage(folder / "stages.png");
  REQUIRE(stages.ok());
  const Image expected = quarter(*stages);
  const std::string path = kRoot + "docs/images/stages.png";
  if (std::getenv("OBSCURA_BLESS")) {
    const auto png = encodeImage(FileFormat::Png, {{"color", {"R", "G", "B"}, expected}});
    REQUIRE(png.ok());
    REQUIRE(writeFileAtomically(path, {png->data(), png->size()}).ok());
  }
  const auto found = readImage(path);
  REQUIRE(found.ok());
  CHECK(found->width == expected.width);
  INFO("if the change is wanted, run scripts/bless");
  CHECK((found->bytes == expected.bytes));  // in brackets: nobody wants to see the bytes
  CHECK(fs::file_size(path) <= 150000);
}
