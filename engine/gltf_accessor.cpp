#include "obscura/engine/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace obscura::engine::gltf {
namespace {

template <class T>
T load(const uint8_t* p) {
  T value;
  std::memcpy(&value, p, sizeof value);
  return value;
}

int bytesOf(int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    default: return 0;
  }
}

// The end of count elements, or 2^64 - 1 where it does not fit: count < 2^54, stride < 256, so only offset can.
uint64_t endOf(uint64_t offset, uint64_t count, uint64_t stride, uint64_t size) {
  if (count == 0) return offset;
  const uint64_t length = (count - 1) * stride + size;
  return offset > UINT64_MAX - length ? UINT64_MAX : offset + length;
}

const uint8_t* checkedStart(Bytes view, uint64_t offset, uint64_t count, uint64_t stride, uint64_t size,
                            const std::string& path) {
  const uint64_t end = endOf(offset, count, stride, size);
  if (end > view.size()) {
    fail(path, std::to_string(count) + " elements end at byte " + std::to_string(end) + " of a bufferView of " +
                   std::to_string(view.size()));
  }
  return view.data() + offset;
}

void openSparse(Document& document, const tinygltf::Accessor& a, uint64_t elementBytes, Accessor& opened) {
  const std::string path = opened.path + "/sparse";
  const auto& indices = a.sparse.indices;
  const auto& values = a.sparse.values;
  const uint64_t count = uint64_t(a.sparse.count);
  if (count > opened.count) fail(path + "/count", std::to_string(count) + " of " + std::to_string(opened.count));
  if (!isIndexType(indices.componentType)) fail(path + "/indices/componentType", "not an unsigned integer type");
  const uint64_t indexBytes = uint64_t(bytesOf(indices.componentType));
  const Bytes indexView = document.bufferViewBytes(indices.bufferView, path + "/indices");
  const Bytes valueView = document.bufferViewBytes(values.bufferView, path + "/values");
  opened.sparseIndices =
      checkedStart(indexView, uint64_t(indices.byteOffset), count, indexBytes, indexBytes, path + "/indices");
  opened.sparseValues =
      checkedStart(valueView, uint64_t(values.byteOffset), count, elementBytes, elementBytes, path + "/values");
  opened.sparseType = indices.componentType;
  opened.sparseCount = size_t(count);
}

template <class T>
float toFloat(T c, bool normalized) {
  if (!normalized) return float(c);
  if constexpr (std::is_same_v<T, float>) return c;
  const float value = float(double(c) / double(std::numeric_limits<T>::max()));
  return value < -1.0f ? -1.0f : value;
}

// `positions(i)` is where element i of n starts; dense and sparse data share the loop.
template <class T, class Position>
void convert(Position position, size_t n, int components, bool normalized, int width, float* out) {
  for (size_t i = 0; i < n; ++i, out += width) {
    const uint8_t* p = position(i);
    for (int c = 0; c < components; ++c) out[c] = toFloat(load<T>(p + size_t(c) * sizeof(T)), normalized);
  }
}

template <class Position>
void convertAny(const Accessor& a, Position position, size_t n, int width, float* out) {
  const int k = a.components;
  switch (a.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return convert<int8_t>(position, n, k, a.normalized, width, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return convert<uint8_t>(position, n, k, a.normalized, width, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return convert<int16_t>(position, n, k, a.normalized, width, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return convert<uint16_t>(position, n, k, a.normalized, width, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return convert<uint32_t>(position, n, k, a.normalized, width, out);
    default: return convert<float>(position, n, k, false, width, out);
  }
}

uint32_t indexAt(const uint8_t* data, int componentType, size_t i) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return data[i];
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<uint16_t>(data + i * 2);
    default: return load<uint32_t>(data + i * 4);
  }
}

template <class T>
void widen(const uint8_t* data, size_t stride, size_t n, uint32_t* out) {
  if (stride == sizeof(T))
    for (size_t i = 0; i < n; ++i) out[i] = load<T>(data + i * sizeof(T));
  else
    for (size_t i = 0; i < n; ++i) out[i] = load<T>(data + i * stride);
}

void readDense(const Accessor& a, const Selection& s, int width, float* out) {
  const size_t elementBytes = size_t(a.components) * sizeof(float);
  if (!a.data) {
    for (size_t i = 0; i < s.count; ++i) std::fill_n(out + i * size_t(width), a.components, 0.0f);
  } else if (s.list) {
    convertAny(a, [&](size_t i) { return a.data + s.list[i] * a.stride; }, s.count, width, out);
  } else if (a.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && a.stride == elementBytes && width == a.components) {
    if (s.count > 0) std::memcpy(out, a.data + s.first * a.stride, s.count * elementBytes);
  } else {
    convertAny(a, [&](size_t i) { return a.data + (s.first + i) * a.stride; }, s.count, width, out);
  }
}

}  // namespace

bool isIndexType(int componentType) {
  return componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

Accessor openAccessor(Document& document, int index, const std::string& user) {
  const tinygltf::Accessor& a = at(document.model.accessors, index, "accessor", user);
  Accessor opened;
  opened.path = pointer("/accessors", uint64_t(index));
  opened.count = a.count;
  opened.components = tinygltf::GetNumComponentsInType(uint32_t(a.type));
  opened.componentType = a.componentType;
  opened.normalized = a.normalized;
  const uint64_t elementBytes = uint64_t(bytesOf(a.componentType)) * uint64_t(opened.components);
  opened.stride = size_t(elementBytes);
  if (a.bufferView >= 0) {
    const Bytes view = document.bufferViewBytes(a.bufferView, opened.path + "/bufferView");
    const size_t stride = document.model.bufferViews[size_t(a.bufferView)].byteStride;
    if (stride != 0) opened.stride = stride;
    opened.data = checkedStart(view, a.byteOffset, a.count, opened.stride, elementBytes, opened.path);
  } else {
    document.reserveZeroElements(a.count, opened.path);
  }
  if (a.sparse.isSparse) openSparse(document, a, elementBytes, opened);
  for (size_t i = 0; i < opened.sparseCount; ++i) {
    const uint32_t element = indexAt(opened.sparseIndices, opened.sparseType, i);
    if (element >= opened.count) {
      fail(opened.path + "/sparse/indices", "element " + std::to_string(element) + " of " +
                                                std::to_string(opened.count));
    }
  }
  return opened;
}

void readFloats(const Accessor& a, const Selection& s, int width, float* out) {
  const size_t step = size_t(width);
  if (a.isSparse() && s.list) {
    std::vector<float> all(a.count * step);
    readFloats(a, {0, a.count, nullptr}, width, all.data());
    for (size_t i = 0; i < s.count; ++i) std::copy_n(&all[s.list[i] * step], step, out + i * step);
    return;
  }
  readDense(a, s, width, out);
  const size_t valueBytes = size_t(a.components) * size_t(bytesOf(a.componentType));
  for (size_t k = 0; k < a.sparseCount; ++k) {
    const size_t element = indexAt(a.sparseIndices, a.sparseType, k);
    if (element < s.first || element - s.first >= s.count) continue;
    const uint8_t* value = a.sparseValues + k * valueBytes;
    convertAny(a, [value](size_t) { return value; }, 1, width, out + (element - s.first) * step);
  }
  if (width > a.components)
    for (size_t i = 0; i < s.count; ++i) std::fill(out + i * step + a.components, out + (i + 1) * step, 1.0f);
}

void readIndices(const Accessor& a, uint32_t* out) {
  if (!a.data) {
    std::fill_n(out, a.count, 0u);
  } else if (a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) {
    widen<uint8_t>(a.data, a.stride, a.count, out);
  } else if (a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
    widen<uint16_t>(a.data, a.stride, a.count, out);
  } else {
    widen<uint32_t>(a.data, a.stride, a.count, out);
  }
  for (size_t k = 0; k < a.sparseCount; ++k)
    out[indexAt(a.sparseIndices, a.sparseType, k)] = indexAt(a.sparseValues, a.componentType, k);
}

}  // namespace obscura::engine::gltf
