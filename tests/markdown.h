// Reads Markdown as far as the tests of README.md and docs need it.
#pragma once

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

using Lines = std::vector<std::string>;

inline std::string contentsOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline Lines linesOf(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// What the first group of the pattern matches, everywhere in the text.
inline Lines matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  Lines found;
  for (auto i = std::sregex_iterator(text.begin(), text.end(), regex); i != std::sregex_iterator(); ++i)
    found.push_back(i->str(1));
  return found;
}

// The text of each fenced block of that language.
inline Lines blocksOf(const std::string& markdown, const std::string& language) {
  Lines blocks;
  bool inside = false, wanted = false;
  for (const std::string& line : linesOf(markdown)) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside;
      wanted = inside && line == "```" + language;
      if (wanted) blocks.emplace_back();
    } else if (wanted) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

// Without the fenced blocks.
inline std::string proseOf(const std::string& markdown) {
  std::string prose;
  bool inside = false;
  for (const std::string& line : linesOf(markdown)) {
    const bool fence = line.rfind("```", 0) == 0;
    if (!inside && !fence) prose += line + "\n";
    inside ^= fence;
  }
  return prose;
}

// Rows of the table whose head begins with `head`; cells without the blanks around them, \| as |.
inline std::vector<Lines> tableOf(const std::string& markdown, const std::string& head) {
  std::vector<Lines> rows;
  bool inside = false;
  for (const std::string& line : linesOf(markdown)) {
    if (line.rfind("| " + head + " |", 0) == 0) inside = true;
    else if (line.empty() || line[0] != '|') inside = false;
    if (!inside) continue;
    Lines cells(1);
    for (size_t i = 1; i < line.size(); ++i) {
      if (line[i] == '|' && line[i - 1] == '\\') cells.back().back() = '|';
      else if (line[i] == '|') cells.emplace_back();
      else cells.back() += line[i];
    }
    cells.pop_back();
    for (std::string& cell : cells) cell = std::regex_replace(cell, std::regex("^ +| +$"), "");
    rows.push_back(cells);
  }
  if (rows.size() >= 2) rows.erase(rows.begin(), rows.begin() + 2);  // head and rule
  return rows;
}

// GitHub's name of a heading: lower case, blanks to hyphens, punctuation dropped.
inline std::string anchorOf(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_') anchor += char(std::tolower(c));
    else if (c == ' ') anchor += '-';
  }
  return anchor;
}

inline bool hasHeading(const std::string& markdown, const std::string& anchor) {
  const Lines headings = matches(proseOf(markdown), "(?:^|\\n)#+ ([^\\n]*)");
  return std::any_of(headings.begin(), headings.end(), [&](const std::string& h) { return anchorOf(h) == anchor; });
}
