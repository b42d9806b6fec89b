// In: pictures with names.  Out: one picture of them all, side by side.
#pragma once

#include <string>
#include <vector>

#include "obscura/engine/image.h"

namespace obscura::engine {

struct Labelled {
  std::string label;  // ASCII; other characters are shown as a box, what does not fit is cut off
  Image rgb8;         // 3 channels U8; anything else is shown as an empty tile
};

// Tiles in rows of `columns` (less than 1 counts as 1), each in a cell of the largest width and height, with its label
// in a strip below; the font grows with the cells. U8 RGB; 0 x 0 without tiles. Throws std::bad_alloc.
Image contactSheet(const std::vector<Labelled>& tiles, int columns);

// Writes ASCII (other characters are a box) into a U8 RGB image, in grey: characters of 5 x 8 in boxes of 6 x 8, times
// scale, from this pixel on; what lies outside the image is cut off.
void drawText(Image& rgb8, const std::string& text, int left, int top, int scale, uint8_t ink);

// Where contactSheet puts things, all in pixels.
struct SheetLayout {
  int columns = 0, rows = 0;
  int cellWidth = 0, cellHeight = 0;  // of the pictures
  int scale = 1;                      // of the font, whose characters are 5 x 8 in a box of 6 x 8
  int gap = 0, strip = 0;             // around every cell; height of a label
  int width = 0, height = 0;
  int x(int tile) const { return gap + tile % columns * (cellWidth + gap); }
  int y(int tile) const { return gap + tile / columns * (cellHeight + strip + gap); }
};
SheetLayout sheetLayout(const std::vector<Labelled>& tiles, int columns);

}  // namespace obscura::engine
