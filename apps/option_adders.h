// Options whose values are checked while parsing: what was expected stands in the error and in --help.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "obscura/apps/option_text.h"
#include "obscura/apps/setting_names.h"

namespace obscura::apps {

// An option whose text `read` turns into a value; false: refused, with what was expected.
template <class Read>
CLI::Option* addRead(CLI::App& app, const std::string& name, const std::string& type, const std::string& what,
                     Read read) {
  const auto set = [name, type, read](const std::string& text) {
    if (!read(text)) throw CLI::ValidationError(name, "\"" + text + "\" is not " + type);
  };
  return app.add_option_function<std::string>(name, set, what)->type_name(type);
}

template <class T>
CLI::Option* addChoice(CLI::App& app, const std::string& name, const Names<T>& names, T& value,
                       const std::string& what) {
  std::string list, current;
  for (const auto& [text, v] : names) {
    list += (list.empty() ? "" : "|") + text;
    if (v == value) current = text;
  }
  return addRead(app, name, list, what + " [" + current + "]", [names, &value](const std::string& text) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == text; });
    if (found != names.end()) value = found->second;
    return found != names.end();
  });
}

inline CLI::Option* addInteger(CLI::App& app, const std::string& name, int least, int most, int& value,
                        const std::string& what) {
  const std::string type = std::to_string(least) + "..." + std::to_string(most);
  return addRead(app, name, type, what, [=, &value](const std::string& text) {
    const std::optional<int> n = numberOf<int>(text);
    if (!n || *n < least || *n > most) return false;
    value = *n;
    return true;
  });
}

inline CLI::Option* addLength(CLI::App& app, const std::string& name, bool zero, std::optional<double>& value,
                       const std::string& what, const std::string& otherwise) {
  const std::string is = value ? shown(*value) : otherwise;
  return addRead(app, name, "LENGTH", what + ", scene units [" + is + "]", [&value, zero](const std::string& text) {
    const std::optional<double> v = numberOf<double>(text);
    if (!v || !(zero ? *v >= 0 : *v > 0)) return false;
    value = v;
    return true;
  });
}

}  // namespace obscura::apps
