#include "obscura/apps/figure_page.h"

#include "obscura/apps/option_text.h"

namespace obscura::apps {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Figures of the papers, by obscura</title>
<style>
body { max-width: 72rem; margin: 2rem auto; padding: 0 1rem; font-family: sans-serif; line-height: 1.45; color: #222; }
img { max-width: 100%; height: auto; display: block; }
section { margin: 3rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; }
th, td { border: 1px solid #ccc; padding: 0.15rem 0.6rem; text-align: left; }
.source { color: #666; }
.fails { color: #b00; font-weight: bold; }
</style>
</head>
<body>
<h1>Figures of the papers, by obscura</h1>
<p>Scenes and environment are the project's own. Every picture and every number is the same on every machine.</p>
)";

std::string cells(const char* tag, const std::vector<std::string>& row) {
  std::string out = "<tr>";
  for (const std::string& cell : row) out += "<" + std::string(tag) + ">" + escapedXml(cell) + "</" + tag + ">";
  return out + "</tr>\n";
}

std::string sectionOf(const MadeFigure& made) {
  const Figure& f = *made.figure;
  const std::string name = f.name;
  std::string out = "<section id=\"" + name + "\">\n<h2>" + escapedXml(f.title) + "</h2>\n<p class=\"source\">" + escapedXml(f.source) + "</p>\n";
  out += "<p>" + escapedXml(f.look) + "</p>\n<img src=\"" + name + ".png\" alt=\"" + escapedXml(f.title) + "\">\n<ul>\n";
  for (const FigureClaim& claim : made.content.claims)
    out += "<li>" + escapedXml(claim.text) + (claim.holds ? "" : " <span class=\"fails\">does not hold</span>") + "</li>\n";
  out += "</ul>\n<details><summary>Numbers</summary>\n<table>\n" + cells("th", made.content.numbers.columns);
  for (const std::vector<std::string>& row : made.content.numbers.rows) out += cells("td", row);
  out += "</table>\n<p><a href=\"" + name + ".csv\">" + name + ".csv</a>";
  return out + "</p>\n</details>\n</section>\n";
}

}  // namespace

std::string pageOf(const std::vector<MadeFigure>& figures) {
  std::string out = kHead;
  out += "<ol>\n";
  for (const MadeFigure& made : figures) out += "<li><a href=\"#" + std::string(made.figure->name) + "\">" + escapedXml(made.figure->title) + "</a></li>\n";
  out += "</ol>\n";
  for (const MadeFigure& made : figures) out += sectionOf(made);
  return out + "</body>\n</html>\n";
}

std::string csvOf(const FigureTable& table) {
  std::string out;
  const auto add = [&](const std::vector<std::string>& row) {
    for (size_t i = 0; i < row.size(); ++i) {
      const bool quoted = row[i].find_first_of(",\"\n") != std::string::npos;
      out += i > 0 ? "," : "";
      if (!quoted) {
        out += row[i];
        continue;
      }
      out += '"';
      for (const char c : row[i]) out += c == '"' ? std::string("\"\"") : std::string(1, c);
      out += '"';
    }
    out += '\n';
  };
  add(table.columns);
  for (const auto& row : table.rows) add(row);
  return out;
}

}  // namespace obscura::apps
