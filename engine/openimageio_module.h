// The interface between the engine and obscura_openimageio.so: C types only, so that both sides may be built by
// different compilers. Nothing is thrown across it; all memory for pixels and bytes is the engine's.
#pragma once

#include <stddef.h>
#include <stdint.h>

extern "C" {

// Elements of a pixel's channel; the same numbers as engine::Format.
enum ObscuraFormat { kObscuraU8 = 0, kObscuraU16 = 1, kObscuraU32 = 2, kObscuraF32 = 3 };

// height x width x channels elements, interleaved, no padding, native byte order.
struct ObscuraLayer {
  const char* name;
  const char* const* channelNames;
  int32_t width, height, channels, format;
  const void* data;
};

// Where layers lie in a larger image, pixels; EXR only.
struct ObscuraPlacement {
  int32_t x, y, imageWidth, imageHeight;
};

// Where decode puts its layers: returns memory for the elements of `layer` (whose data is null), or null to stop.
// All layers are announced before the first one is filled.
struct ObscuraLayerSink {
  void* user;
  void* (*layer)(void* user, const ObscuraLayer* layer);
};

// Where encode puts its bytes, once. Returns 0, or something else when there is no memory.
struct ObscuraByteSink {
  void* user;
  int (*bytes)(void* user, const void* data, size_t size);
};

struct ObscuraOpenImageIO {
  uint32_t version;  // kObscuraOpenImageIOVersion
  // Both return 0, or something else with one line of text in `error`. `name` is a file name that is never opened:
  // its extension tells the format where the content does not (decode), or chooses it (encode). Thread-safe.
  int (*decode)(const void* file, size_t size, const char* name, const ObscuraLayerSink* sink, char* error,
                size_t errorSize);
  int (*encode)(const char* name, const ObscuraLayer* layers, size_t layerCount, const ObscuraPlacement* place,
                const ObscuraByteSink* sink, char* error, size_t errorSize);
};

enum { kObscuraOpenImageIOVersion = 2 };

// The module's only exported function.
const ObscuraOpenImageIO* obscuraOpenImageIO(void);

}  // extern "C"
