#include "obscura/engine/stages.h"

#include <algorithm>
#include <cstring>

namespace obscura::engine {
namespace {

constexpr uint8_t kBackground = 28, kInk = 235;
constexpr int kGlyphWidth = 5, kGlyphHeight = 8, kAdvance = 6;

// Thirteen characters to a band, each five columns wide with one between; the eighth row is for descenders.
struct Band {
  const char* characters;
  const char* rows[kGlyphHeight];
};
constexpr Band kFont[] = {
    {"ABCDEFGHIJKLM",
     {" ###  ####   #### ####  ##### #####  #### #   #  ###    ### #   # #     #   #",
      "#   # #   # #     #   # #     #     #     #   #   #      #  #  #  #     ## ##",
      "#   # #   # #     #   # #     #     #     #   #   #      #  # #   #     # # #",
      "##### ####  #     #   # ####  ####  #  ## #####   #      #  ##    #     # # #",
      "#   # #   # #     #   # #     #     #   # #   #   #      #  # #   #     #   #",
      "#   # #   # #     #   # #     #     #   # #   #   #   #  #  #  #  #     #   #",
      "#   # ####   #### ####  ##### #      #### #   #  ###   ##   #   # ##### #   #",
      "                                                                             "}},
    {"NOPQRSTUVWXYZ",
     {"#   #  ###  ####   ###  ####   #### ##### #   # #   # #   # #   # #   # #####",
      "##  # #   # #   # #   # #   # #       #   #   # #   # #   # #   # #   #     #",
      "##  # #   # #   # #   # #   # #       #   #   # #   # #   #  # #   # #     # ",
      "# # # #   # ####  #   # ####   ###    #   #   # #   # # # #   #     #     #  ",
      "#  ## #   # #     # # # # #       #   #   #   #  # #  # # #  # #    #    #   ",
      "#  ## #   # #     #  #  #  #      #   #   #   #  # #  ## ## #   #   #   #    ",
      "#   #  ###  #      ## # #   # ####    #    ###    #   #   # #   #   #   #####",
      "                                                                             "}},
    {"abcdefghijklm",
     {"      #               #         ##        #       #      #  #      ##        ",
      "      #               #        #          #                 #       #        ",
      " ###  ####   ####  ####  ###  ####   #### ####   ##     ##  #  #    #   ## # ",
      "    # #   # #     #   # #   #  #    #   # #   #   #      #  # #     #   # # #",
      " #### #   # #     #   # #####  #    #   # #   #   #      #  ###     #   # # #",
      "#   # #   # #     #   # #      #     #### #   #   #      #  #  #    #   # # #",
      " #### ####   ####  ####  ####  #        # #   #  ###     #  #   #    ## # # #",
      "                                     ###               ##                    "}},
    {"nopqrstuvwxyz",
     {"                                     #                                       ",
      "                                     #                                       ",
      "####   ###  ####   #### # ##   #### ####  #   # #   # #   # #   # #   # #####",
      "#   # #   # #   # #   # ##  # #      #    #   # #   # # # #  # #  #   #    # ",
      "#   # #   # #   # #   # #      ###   #    #   #  # #  # # #   #   #   #   #  ",
      "#   # #   # ####   #### #         #  #    #   #  # #  # # #  # #   ####  #   ",
      "#   #  ###  #         # #     ####    ##   ####   #    # #  #   #     # #####",
      "            #         #                                            ###       "}},
    {"0123456789.,:",
     {" ###    #    ###  ####     #  #####   ##  #####  ###   ###                   ",
      "#   #  ##   #   #     #   ##  #      #        # #   # #   #              ##  ",
      "#  ##   #       #     #  # #  ####  #        #  #   # #   #              ##  ",
      "# # #   #      #   ###  #  #      # ####     #   ###   ####                  ",
      "##  #   #     #       # #####     # #   #   #   #   #     #              ##  ",
      "#   #   #    #        #    #  #   # #   #   #   #   #    #   ##     ##   ##  ",
      " ###   ###  ##### ####     #   ###   ###    #    ###   ##    ##     ##       ",
      "                                                                   ##        "}},
    {";-+_/()[]<>=%",
     {"                            #    #   #     ###   ###     #   #          ##  #",
      "  ##          #            #    #     #    #       #    #     #         ##  #",
      "  ##          #            #   #       #   #       #   #       #  #####    # ",
      "       ###  #####         #    #       #   #       #  #         #         #  ",
      "  ##          #          #     #       #   #       #   #       #  #####  #   ",
      "  ##          #          #      #     #    #       #    #     #         #  ##",
      " ##               ##### #        #   #     ###   ###     #   #          #  ##",
      "                                                                             "}},
    {"*#!?'\"&|",
     {"       # #    #    ###    #    # #   ##     #  ",
      "# # #  # #    #   #   #   #    # #  #  #    #  ",
      " ###  #####   #       #  #    # #   # #     #  ",
      "#####  # #    #      #               #      #  ",
      " ###  #####   #     #               # # #   #  ",
      "# # #  # #                          #  #    #  ",
      "       # #    #     #                ## #   #  ",
      "                                               "}},
};

bool inked(char c, int x, int y) {
  if (c == ' ') return false;
  for (const Band& band : kFont)
    if (const char* found = std::strchr(band.characters, c); found && c != 0)
      return band.rows[y][(found - band.characters) * kAdvance + x] == '#';
  return y < 7 && (x == 0 || x == kGlyphWidth - 1 || y == 0 || y == 6);  // a box
}

bool isPicture(const Image& image) {
  return image.channels == 3 && image.format == Format::U8 && image.width > 0 && image.height > 0;
}

}  // namespace

void drawText(Image& rgb8, const std::string& text, int left, int top, int scale, uint8_t ink) {
  for (size_t i = 0; i < text.size(); ++i)
    for (int y = std::max(0, -top); y < kGlyphHeight * scale && top + y < rgb8.height; ++y)
      for (int x = 0; x < kGlyphWidth * scale; ++x) {
        const int column = left + int(i) * kAdvance * scale + x;
        if (column < 0 || column >= rgb8.width || !inked(text[i], x / scale, y / scale)) continue;
        std::memset(rgb8.row<uint8_t>(top + y) + column * 3, ink, 3);
      }
}

SheetLayout sheetLayout(const std::vector<Labelled>& tiles, int columns) {
  SheetLayout s;
  if (tiles.empty()) return s;
  s.columns = std::clamp(columns, 1, int(tiles.size()));
  s.rows = (int(tiles.size()) + s.columns - 1) / s.columns;
  s.cellWidth = s.cellHeight = 1;
  for (const Labelled& tile : tiles) {
    if (!isPicture(tile.rgb8)) continue;
    s.cellWidth = std::max(s.cellWidth, tile.rgb8.width);
    s.cellHeight = std::max(s.cellHeight, tile.rgb8.height);
  }
  s.scale = std::clamp(s.cellWidth / 200, 1, 4);
  s.gap = 4 * s.scale;
  s.strip = (kGlyphHeight + 4) * s.scale;
  s.width = s.gap + s.columns * (s.cellWidth + s.gap);
  s.height = s.gap + s.rows * (s.cellHeight + s.strip + s.gap);
  return s;
}

Image contactSheet(const std::vector<Labelled>& tiles, int columns) {
  const SheetLayout s = sheetLayout(tiles, columns);
  Image sheet(s.width, s.height, 3, Format::U8);
  std::fill(sheet.bytes.begin(), sheet.bytes.end(), kBackground);
  for (int i = 0; i < int(tiles.size()); ++i) {
    const Image& from = tiles[size_t(i)].rgb8;
    if (isPicture(from)) {
      const int left = s.x(i) + (s.cellWidth - from.width) / 2, top = s.y(i) + (s.cellHeight - from.height) / 2;
      for (int y = 0; y < from.height; ++y)
        std::memcpy(sheet.row<uint8_t>(top + y) + left * 3, from.row<uint8_t>(y), size_t(from.width) * 3);
    }
    const std::string shown = tiles[size_t(i)].label.substr(0, size_t(s.cellWidth / (kAdvance * s.scale)));
    drawText(sheet, shown, s.x(i), s.y(i) + s.cellHeight + 3 * s.scale, s.scale, kInk);
  }
  return sheet;
}

}  // namespace obscura::engine
