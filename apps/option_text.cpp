#include "obscura/apps/option_text.h"

#include <algorithm>
#include <cmath>

#include "obscura/raster/srgb.h"
#include "obscura/raster/view.h"

namespace obscura::apps {

bool readNumbers(std::string_view text, int count, double* out) {
  for (int i = 0; i < count; ++i) {
    const size_t comma = i + 1 < count ? text.find(',') : text.size();
    if (comma == text.npos) return false;
    const std::optional<double> number = numberOf<double>(text.substr(0, comma));
    if (!number) return false;
    out[i] = *number;
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return true;
}

std::optional<glm::dvec3> vectorOf(std::string_view text) {
  glm::dvec3 v;
  return readNumbers(text, 3, &v.x) ? std::optional(v) : std::nullopt;
}

std::optional<glm::vec3> colorOf(const std::string& text) {
  if (text.size() == 7 && text[0] == '#') {
    uint32_t rgb = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, rgb, 16);
    if (error != std::errc() || end != text.data() + 7) return std::nullopt;
    glm::vec3 color;
    for (int c = 0; c < 3; ++c) color[c] = float(raster::linearFromSrgb((rgb >> (16 - 8 * c) & 0xFF) / 255.0));
    return color;
  }
  const std::optional<glm::dvec3> v = vectorOf(text);
  if (!v || !(v->x >= 0 && v->y >= 0 && v->z >= 0 && std::max({v->x, v->y, v->z}) < 1e30)) return std::nullopt;
  return glm::vec3(*v);
}

std::optional<std::array<glm::vec3, 6>> sixColorsOf(std::string_view text) {
  std::array<glm::vec3, 6> colors;
  for (size_t k = 0; k < 6; ++k) {
    const size_t end = k < 5 ? text.find('/') : text.size();
    if (end == text.npos) return std::nullopt;
    const std::optional<glm::vec3> color = colorOf(std::string(text.substr(0, end)));
    if (!color) return std::nullopt;
    colors[k] = *color;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return colors;
}

bool addNodeColor(const std::string& text, std::vector<std::pair<std::string, glm::vec3>>& out) {
  const size_t equals = text.rfind('=');
  if (equals == text.npos || equals == 0) return false;
  const std::optional<glm::vec3> color = colorOf(text.substr(equals + 1));
  if (color) out.emplace_back(text.substr(0, equals), *color);
  return bool(color);
}

bool readSize(const std::string& text, int& width, int& height) {
  const size_t x = text.find_first_of("xX");
  if (x == text.npos) return false;
  const auto w = numberOf<int>(std::string_view(text).substr(0, x)),
             h = numberOf<int>(std::string_view(text).substr(x + 1));
  if (!w || !h || *w < 1 || *h < 1 || *w > raster::kMaxImageSize || *h > raster::kMaxImageSize) return false;
  width = *w;
  height = *h;
  return true;
}

std::optional<raster::Window> cropOf(std::string_view text) {
  raster::Window w;
  for (int* v : {&w.x, &w.y}) {
    const size_t comma = text.find(',');
    if (comma == text.npos) return std::nullopt;
    const std::optional<int> number = numberOf<int>(text.substr(0, comma));
    if (!number || *number < 0) return std::nullopt;
    *v = *number;
    text.remove_prefix(comma + 1);
  }
  if (!readSize(std::string(text), w.width, w.height)) return std::nullopt;
  return w;
}

std::string shown(double v) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, v).ptr);
}

std::string shown(const glm::vec3& v) { return shown(v.x) + "," + shown(v.y) + "," + shown(v.z); }

std::string escapedXml(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

}  // namespace obscura::apps
