// obscura figures as a user meets it: what is written, that the figures show what they argue, errors.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "obscura/engine/image_file.h"
#include "cli_failure.h"
#include "run_program.h"

using namespace obscura;
using Words = std::vector<std::string>;
namespace fs = std::filesystem;

namespace {

Finished figures(Words words) {
  words.insert(words.begin(), "figures");
  return runProgram(words);
}

std::vector<std::string> listed() {
  const Finished f = figures({"--list"});
  REQUIRE(f.code == 0);
  std::vector<std::string> names;
  std::istringstream lines(f.out);
  for (std::string line; std::getline(lines, line);) names.push_back(line.substr(0, line.find(' ')));
  return names;
}

// Cells by row and column; no cell of these figures holds a quote.
std::vector<Words> table(const std::string& path) {
  std::vector<Words> rows;
  std::istringstream lines(contentOf(path));
  for (std::string line; std::getline(lines, line);) {
    Words cells;
    std::string cell;
    bool quoted = false;
    for (const char c : line + ",") {
      if (c == '"') quoted = !quoted;
      else if (c == ',' && !quoted) cells.push_back(cell), cell.clear();
      else cell += c;
    }
    rows.push_back(cells);
  }
  return rows;
}

double cell(const std::vector<Words>& rows, const std::string& row, size_t column) {
  for (const Words& r : rows)
    if (r[0] == row) return std::atof(r.at(column).c_str());
  FAIL("no row " << row);
  return 0;
}

const char* const kSmall = "160x120";

}  // namespace

TEST_CASE("cli: figures are those of the list, each with picture and numbers, and show what they argue") {
  const TemporaryFolder folder;
  const Finished f = figures({"-o", folder / "out", "--size", kSmall});
  INFO(f.err << f.out);
  REQUIRE(f.code == 0);
  CHECK(f.err.empty());
  const std::vector<std::string> names = listed();
  CHECK(names.size() >= 11);
  const std::string page = contentOf(folder / "out/index.html");
  size_t files = 1;
  for (const std::string& name : names) {
    INFO(name);
    const auto image = engine::readImage(folder / ("out/" + name + ".png"));
    REQUIRE(image);
    CHECK((image->width > 160 && image->height > 120 && image->channels == 3));
    const std::vector<Words> rows = table(folder / ("out/" + name + ".csv"));
    CHECK(rows.size() > 1);
    for (const Words& row : rows) CHECK(row.size() == rows[0].size());
    CHECK(page.find("<img src=\"" + name + ".png\"") != page.npos);
    CHECK(f.out.find(name + ": ") != f.out.npos);
    files += 2;
  }
  size_t there = 0;
  for (const auto& entry : fs::directory_iterator(folder / "out")) there += entry.exists();
  CHECK(there == files);
  CHECK(f.out.find("DOES NOT HOLD") == f.out.npos);
  CHECK(contentOf(OBSCURA_SOURCE_DIR "/docs/figures.md").find("```\n" + f.out + "```\n") != std::string::npos);

  // Once more, from the numbers that are written.
  const auto at = [&](const char* figure, const char* row, size_t column) { return cell(table(folder / ("out/" + std::string(figure) + ".csv")), row, column); };
  CHECK(at("white-room", "1", 4) == 1);
  CHECK(at("white-room", "1", 2) < 0.6);
  CHECK(at("snow", "W of snow", 2) < at("snow", "O", 2) / 6);
  for (const char* n : {"1", "4", "8"}) CHECK(at("sampling", n, 2) < at("sampling", n, 1));
  CHECK(at("silhouettes", "with the bound", 2) < at("silhouettes", "without the bound", 2) / 10);
  CHECK(at("extended", "extended ambient term", 1) > 1.05 * at("extended", "extended ambient term", 2));
  CHECK(at("extended", "extended ambient term", 4) > 1.05 * at("extended", "extended ambient term", 3));
  CHECK(at("extended", "constant ambient term", 1) == at("extended", "constant ambient term", 4));
  CHECK(at("carved", "W", 1) > at("carved", "W", 3));
  CHECK(at("carved", "W", 3) > at("carved", "O", 3));
  CHECK(at("membership", "0.5", 2) == 0.5);
}

TEST_CASE("cli: the carved object of README is the figure of that name") {
  const TemporaryFolder folder;
  REQUIRE(figures({"-o", folder.path, "--only", "carved", "--size", "320x240"}).code == 0);
  const auto shown = engine::readImage(OBSCURA_SOURCE_DIR "/docs/images/figure_carved.png"), made = engine::readImage(folder / "carved.png");
  REQUIRE((shown && made));
  CHECK((shown->width == made->width && shown->bytes == made->bytes));
}

TEST_CASE("cli: figures have the same bytes for any number of threads") {
  const TemporaryFolder folder;
  for (const char* name : {"extended", "relief", "projections"}) {
    std::map<std::string, std::string> expected;
    for (const char* threads : {"1", "3"}) {
      REQUIRE(figures({"-o", folder / threads, "--only", name, "--size", kSmall, "--threads", threads}).code == 0);
      for (const auto& entry : fs::directory_iterator(folder / threads)) {
        const std::string file = entry.path().filename(), bytes = contentOf(entry.path());
        INFO(file);
        CHECK(!bytes.empty());
        CHECK(expected.try_emplace(file, bytes).first->second == bytes);
      }
    }
  }
}

TEST_CASE("cli: figures that cannot be made end with the documented code, one line and no file") {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const auto failing = [&](int code, const Words& words, const std::string& says) {
    tests::checkFailure(figures(words), code, says);
    CHECK(!fs::exists(out));
  };
  failing(2, {}, "-o DIR");
  failing(2, {"-o", out, "--only", "nothing"}, "membership, ");
  for (const char* size : {"0x0", "119x400", "400", "400x2049", "x"}) failing(2, {"-o", out, "--size", size}, "--size");
  failing(2, {"-o", out, "--threads", "-1"}, "--threads");
  failing(4, {"-o", folder / "no/where"}, "no/where");
  std::ofstream(folder / "file") << "x";
  failing(4, {"-o", folder / "file"}, "file");
  fs::create_directory(folder / "sealed");
  fs::permissions(folder / "sealed", fs::perms::owner_read | fs::perms::owner_exec);
  if (access((folder / "sealed").c_str(), W_OK) != 0) failing(4, {"-o", folder / "sealed"}, "sealed");  // not as root
  fs::permissions(folder / "sealed", fs::perms::owner_all);
}
