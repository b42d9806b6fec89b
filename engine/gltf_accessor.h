// In: an accessor of a document.  Out: its elements as floats or indices.
// Private to engine/gltf*.cpp.
#pragma once

#include "obscura/engine/gltf_document.h"

namespace obscura::engine::gltf {

// An accessor whose every byte was found to exist. Nothing is aligned.
struct Accessor {
  const uint8_t* data = nullptr;  // null: zeros
  size_t count = 0, stride = 0;   // elements, bytes
  int components = 1;
  int componentType = 0;  // as in glTF: 5120 ... 5126
  bool normalized = false;
  size_t sparseCount = 0;
  const uint8_t* sparseIndices = nullptr;  // u8, u16 or u32 as sparseType says, each < count
  int sparseType = 0;
  const uint8_t* sparseValues = nullptr;   // tightly packed
  std::string path;                        // its JSON pointer

  bool isSparse() const { return sparseCount > 0; }
};

Accessor openAccessor(Document& document, int index, const std::string& user);

// Which elements to read: all those of `list`, or `count` from `first`. All are < accessor.count.
struct Selection {
  size_t first = 0, count = 0;
  const uint32_t* list = nullptr;
};

// Writes selection.count elements of `width` floats, width >= accessor.components; the rest of an element becomes 1.
// Normalized integers become c / max as glTF's section 3.6.2.2 says, others themselves.
void readFloats(const Accessor& accessor, const Selection& selection, int width, float* out);
// Scalars of u8, u16 or u32; writes accessor.count of them.
void readIndices(const Accessor& accessor, uint32_t* out);

bool isIndexType(int componentType);

}  // namespace obscura::engine::gltf
