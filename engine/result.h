// How the engine reports what went wrong: a value or an error, never both, no exceptions across the interface.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace obscura::engine {

enum class ErrorCode {
  Usage,        // the caller asked for something that does not exist (a camera, an AOV, a format)
  BadInput,     // a file is missing, broken, too large or needs what is not supported
  CannotWrite,  // an output cannot be created or completed
};

struct Error {
  ErrorCode code = ErrorCode::BadInput;
  std::string message;    // one line, lower case, no full stop
  std::string file;       // the file concerned; may be empty
  std::string gltfPath;   // the offender inside it, as a JSON pointer such as /accessors/3; may be empty

  // "FILE: /accessors/3: message"
  std::string text() const {
    std::string s;
    if (!file.empty()) s += file + ": ";
    if (!gltfPath.empty()) s += gltfPath + ": ";
    return s + message;
  }
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : v_(std::move(value)) {}
  Result(Error error) : v_(std::move(error)) {}
  bool ok() const { return v_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& operator*() { return std::get<0>(v_); }
  const T& operator*() const { return std::get<0>(v_); }
  T* operator->() { return &std::get<0>(v_); }
  const T* operator->() const { return &std::get<0>(v_); }
  const Error& error() const { return std::get<1>(v_); }

 private:
  std::variant<T, Error> v_;
};

struct Done {};  // Result<Done>: success without a value

}  // namespace obscura::engine
