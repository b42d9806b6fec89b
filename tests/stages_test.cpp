#include <catch2/catch.hpp>

#include <set>

#include "obscura/engine/stages.h"

using namespace obscura::engine;

namespace {

Image filled(int width, int height, uint8_t r, uint8_t g, uint8_t b) {
  Image image(width, height, 3, Format::U8);
  for (size_t i = 0; i < image.bytes.size(); i += 3) image.bytes[i] = r, image.bytes[i + 1] = g, image.bytes[i + 2] = b;
  return image;
}

const uint8_t* at(const Image& image, int x, int y) { return image.row<uint8_t>(y) + x * 3; }

// The first character of a label as contactSheet draws it, as text art.
std::string glyph(const std::string& label) {
  const std::vector<Labelled> tiles = {{label, filled(64, 8, 0, 0, 0)}};
  const Image sheet = contactSheet(tiles, 1);
  const SheetLayout s = sheetLayout(tiles, 1);
  std::string art;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 5; ++x) art += at(sheet, s.x(0) + x, s.y(0) + s.cellHeight + 3 + y)[0] > 128 ? '#' : '.';
    art += '\n';
  }
  return art;
}

}  // namespace

TEST_CASE("stages: tiles lie in rows, each where the layout says, with its pixels unchanged") {
  std::vector<Labelled> tiles;
  for (int i = 0; i < 5; ++i) tiles.push_back({"tile", filled(30, 20, uint8_t(i * 50), 7, 9)});
  tiles[3].rgb8 = filled(10, 20, 150, 7, 9);  // smaller: centred
  const Image sheet = contactSheet(tiles, 3);
  const SheetLayout s = sheetLayout(tiles, 3);
  REQUIRE(s.rows == 2);
  REQUIRE(sheet.width == 4 + 3 * (30 + 4));
  REQUIRE(sheet.height == 4 + 2 * (20 + 12 + 4));
  REQUIRE(sheet.channels == 3);
  for (int i = 0; i < 5; ++i)
    for (const int corner : {0, 1}) {
      const int margin = i == 3 ? 10 : 0;
      const uint8_t* p = at(sheet, s.x(i) + margin + corner * (29 - 2 * margin), s.y(i) + corner * 19);
      REQUIRE(int(p[0]) == i * 50);
      REQUIRE(p[1] == 7);
    }
  REQUIRE(at(sheet, s.x(0) - 1, s.y(0))[0] == 28);
  REQUIRE(at(sheet, s.x(3) + 9, s.y(3))[0] == 28);
}

TEST_CASE("stages: a label is drawn under its tile and nowhere else") {
  std::vector<Labelled> tiles(2, {"", filled(60, 10, 0, 0, 0)});
  const Image without = contactSheet(tiles, 2);
  tiles[1].label = "Depth: 1.5 and much too long to fit";
  const Image with = contactSheet(tiles, 2);
  const SheetLayout s = sheetLayout(tiles, 2);
  int inside = 0, outside = 0;
  for (int y = 0; y < with.height; ++y)
    for (int x = 0; x < with.width; ++x) {
      if (at(with, x, y)[0] == at(without, x, y)[0]) continue;
      const bool under = x >= s.x(1) && x < s.x(1) + 60 && y >= s.y(1) + 10 && y < s.y(1) + 10 + s.strip;
      ++(under ? inside : outside);
    }
  REQUIRE(inside > 100);
  REQUIRE(outside == 0);
}

TEST_CASE("stages: every printable letter, digit and sign has a glyph of its own, others are a box") {
  REQUIRE(glyph("A") == ".###.\n#...#\n#...#\n#####\n#...#\n#...#\n#...#\n.....\n");
  REQUIRE(glyph("g") == ".....\n.....\n.####\n#...#\n#...#\n.####\n....#\n.###.\n");
  std::set<std::string> seen;
  const std::string all =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,:;-+_/()[]<>=%*#!?'\"&|";
  for (const char c : all) seen.insert(glyph(std::string(1, c)));
  REQUIRE(seen.size() == all.size());
  const std::string box = glyph("~");
  REQUIRE(box == "#####\n#...#\n#...#\n#...#\n#...#\n#...#\n#####\n.....\n");
  REQUIRE(seen.count(box) == 0);
  REQUIRE(glyph("\xC3") == box);
  REQUIRE(glyph(std::string(1, '\0')) == box);
  REQUIRE(glyph(" ").find('#') == std::string::npos);
}

TEST_CASE("stages: large tiles get a larger font, odd input an orderly sheet") {
  REQUIRE(sheetLayout({{"a", filled(400, 2, 0, 0, 0)}}, 1).scale == 2);
  REQUIRE(sheetLayout({{"a", filled(5000, 2, 0, 0, 0)}}, 1).scale == 4);
  REQUIRE(contactSheet({}, 3).bytes.empty());
  const Image grey(20, 20, 1, Format::U8);
  const Image sheet = contactSheet({{"grey", grey}, {"rgb", filled(40, 5, 1, 2, 3)}}, 0);
  REQUIRE(sheet.width == 4 + 40 + 4);
  REQUIRE(sheet.height == 4 + 2 * (5 + 12 + 4));
}
