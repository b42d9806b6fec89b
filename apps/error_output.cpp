#include "obscura/apps/error_output.h"

#include <cstdarg>
#include <cstdio>

#include "obscura/engine/image_file.h"

namespace obscura::apps {

using engine::Error;
using engine::ErrorCode;

std::string formatted(const char* format, ...) {
  char text[512];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

engine::Result<engine::Done> writeText(const std::string& path, const std::string& text) {
  return engine::writeFileAtomically(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

engine::Result<size_t> mapRow(const std::string& text, size_t rows) {
  const bool number = !text.empty() && text.find_first_not_of("0123456789") == text.npos && text.size() < 8;
  if (number && std::stoul(text) >= 1 && std::stoul(text) <= rows) return std::stoul(text) - 1;
  return Error{ErrorCode::Usage, "--map: \"" + text + "\" is no row; there are 1 to " + std::to_string(rows), "", ""};
}

engine::Result<engine::Done> writeErrorMap(const std::string& path, engine::Image map) {
  const auto png = engine::encodeImage(engine::FileFormat::Png, {{"color", {"R", "G", "B"}, std::move(map)}}, path);
  if (!png) return Error{ErrorCode::CannotWrite, png.error().message, path, ""};
  return engine::writeFileAtomically(path, {png->data(), png->size()});
}

}  // namespace obscura::apps
