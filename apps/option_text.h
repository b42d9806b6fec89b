// The texts that options take, as values; without the locale, and only the whole of a text.
#pragma once

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/raster/camera.h"

namespace obscura::apps {

// Empty if it is no number, infinite or NaN.
template <class T>
std::optional<T> numberOf(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value - value == 0)) return std::nullopt;
  return value;
}

// Exactly `count` numbers with commas between; false: they are not.
bool readNumbers(std::string_view text, int count, double* out);
std::optional<glm::dvec3> vectorOf(std::string_view text);
// "r,g,b" is linear, "#rrggbb" is sRGB; 0 or more.
std::optional<glm::vec3> colorOf(const std::string& text);
// Six colours with slashes between.
std::optional<std::array<glm::vec3, 6>> sixColorsOf(std::string_view text);
// "NAME=COLOR"; names may hold further =.
bool addNodeColor(const std::string& text, std::vector<std::pair<std::string, glm::vec3>>& out);
// "WxH" of 1 ... raster::kMaxImageSize.
bool readSize(const std::string& text, int& width, int& height);
// "X,Y,WxH"; whether it lies in the image is the frame's business.
std::optional<raster::Window> cropOf(std::string_view text);

// The shortest text that reads as this value.
std::string shown(double v);
std::string shown(const glm::vec3& v);  // with commas between

// As text or as a quoted attribute of XML and HTML.
std::string escapedXml(const std::string& text);

}  // namespace obscura::apps
