// Planes: what the buffers of a frame are made of, one scalar per pixel (structure of arrays).
#pragma once

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>

#include "obscura/raster/large_memory.h"

namespace obscura::raster {

// width x height elements of T, row 0 on top. Every row starts on a 64-byte boundary and is padded to a
// multiple of 64 bytes, so that a full vector can be loaded and stored at any multiple of the vector's
// length inside a row; what the padding holds is unspecified. T is a 4-byte (or smaller) plain type.
// Allocation leaves the elements uninitialised; throws std::bad_alloc when there is no memory.
template <class T>
class Plane {
  static_assert(64 % sizeof(T) == 0, "rows are padded to whole elements");

 public:
  Plane() = default;
  Plane(int width, int height)
      : width_(width), height_(height), stride_((size_t(width) * sizeof(T) + 63) / 64 * 64 / sizeof(T)) {
    const size_t bytes = stride_ * size_t(height) * sizeof(T);
    if (bytes > 0) data_.reset(static_cast<T*>(allocateLarge(bytes)));
  }

  // Gives it this size; what it holds afterwards is unspecified. Memory of the right size is kept.
  void resize(int width, int height) {
    if (width != width_ || height != height_) *this = Plane(width, height);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  size_t stride() const { return stride_; }  // elements from one row to the next
  bool empty() const { return !data_; }

  T* row(int y) { return data_.get() + stride_ * size_t(y); }
  const T* row(int y) const { return data_.get() + stride_ * size_t(y); }
  T& at(int x, int y) { return row(y)[x]; }
  const T& at(int x, int y) const { return row(y)[x]; }
  const T* data() const { return data_.get(); }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  int width_ = 0, height_ = 0;
  size_t stride_ = 0;
  std::unique_ptr<T, Free> data_;
};

}  // namespace obscura::raster
