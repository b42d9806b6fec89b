// Finds and loads obscura_openimageio.so at the first use. The handle is the engine's only global state: it is set
// once and never closed, for OpenImageIO and what it brings start threads that outlive any call.
#include <dlfcn.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstring>
#include <mutex>
#include <new>

#include "obscura/engine/image_codecs.h"
#include "obscura/engine/openimageio_module.h"

namespace obscura::engine::codec {
namespace {

constexpr const char* kModuleFile = "obscura_openimageio.so";

// The folder of a file with links resolved; empty when there is none.
std::string folderOf(const char* file) {
  char resolved[PATH_MAX];
  if (!file || !std::strchr(file, '/') || !realpath(file, resolved)) return {};
  const std::string path = resolved;
  return path.substr(0, path.rfind('/'));
}

std::vector<std::string> searchFolders() {
  std::vector<std::string> folders;
  const auto add = [&](const std::string& folder) {
    for (const std::string& f : folders)
      if (f == folder) return;
    if (!folder.empty()) folders.push_back(folder);
  };
  if (const char* list = secure_getenv("OBSCURA_MODULE_PATH")) {
    const std::string all = list;
    for (size_t at = 0; at <= all.size();) {
      const size_t end = std::min(all.find(':', at), all.size());
      add(all.substr(at, end - at));
      at = end + 1;
    }
  }
  Dl_info self = {};
  static const char anchor = 0;  // an address inside the library or program this file is linked into
  const bool known = dladdr(&anchor, &self) != 0;
  for (const std::string& base : {folderOf(known ? self.dli_fname : nullptr), folderOf("/proc/self/exe")}) {
    if (base.empty()) continue;
    add(base);
    add(base + "/../lib");
    add(base + "/../lib/obscura");
  }
#ifdef OBSCURA_MODULE_DIR
  add(OBSCURA_MODULE_DIR);
#endif
  return folders;
}

Result<const ObscuraOpenImageIO*> load() {
  const auto failed = [](const std::string& why) {
    return Error{ErrorCode::BadInput, "this image format needs OpenImageIO, whose module " + why, {}, {}};
  };
  std::string looked;
  for (const std::string& folder : searchFolders()) {
    const std::string path = folder + "/" + kModuleFile;
    looked += (looked.empty() ? "" : ", ") + folder;
    if (access(path.c_str(), F_OK) != 0) continue;
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) return failed(std::string("cannot be loaded: ") + dlerror());
    const auto entry = reinterpret_cast<decltype(&obscuraOpenImageIO)>(dlsym(handle, "obscuraOpenImageIO"));
    const ObscuraOpenImageIO* module = entry ? entry() : nullptr;
    if (!module || module->version != kObscuraOpenImageIOVersion) {
      dlclose(handle);
      return failed("is of another version: " + path);
    }
    return module;
  }
  return failed(std::string("is missing: ") + kModuleFile + " is in none of " + looked + " (set OBSCURA_MODULE_PATH)");
}

Result<const ObscuraOpenImageIO*> openImageIO() {
  static std::mutex mutex;
  static const ObscuraOpenImageIO* module = nullptr;
  const std::lock_guard<std::mutex> lock(mutex);
  if (module) return module;
  Result<const ObscuraOpenImageIO*> loaded = load();  // a failure is tried again at the next call
  if (loaded) module = *loaded;
  return loaded;
}

// What the module's callbacks work on.
struct Receiver {
  const std::string& file;
  DecodeLimits limits;
  std::vector<Layer> layers;
  std::optional<Error> error;

  void* add(const ObscuraLayer& from) {
    const Format format = Format(from.format);
    error = checkSize(uint64_t(from.width), uint64_t(from.height), uint64_t(from.channels), format, file, limits);
    if (error) return nullptr;
    Layer layer;
    layer.name = from.name;
    for (int c = 0; c < from.channels; ++c) layer.channels.push_back(from.channelNames[c]);
    layer.image = Image(from.width, from.height, from.channels, format);
    limits.bytes -= layer.image.bytes.size();
    layers.push_back(std::move(layer));
    return layers.back().image.bytes.data();
  }

  static void* layer(void* user, const ObscuraLayer* from) noexcept {
    auto* self = static_cast<Receiver*>(user);
    try {
      return self->add(*from);
    } catch (const std::bad_alloc&) {
      return nullptr;
    }
  }
};

int receiveBytes(void* user, const void* data, size_t size) noexcept try {
  const auto* bytes = static_cast<const uint8_t*>(data);
  static_cast<std::vector<uint8_t>*>(user)->assign(bytes, bytes + size);
  return 0;
} catch (const std::bad_alloc&) {
  return 1;
}

}  // namespace

Result<std::vector<Layer>> decodeWithModule(Bytes file, const std::string& name, const DecodeLimits& limits) {
  const Result<const ObscuraOpenImageIO*> module = openImageIO();
  if (!module) return badImage(name, module.error().message);
  Receiver receiver{name, limits, {}, {}};
  const ObscuraLayerSink sink{&receiver, Receiver::layer};
  char error[512] = "";
  if ((*module)->decode(file.data(), file.size(), name.c_str(), &sink, error, sizeof error) != 0) {
    if (receiver.error) return *receiver.error;
    return badImage(name, error);
  }
  return std::move(receiver.layers);
}

Result<std::vector<uint8_t>> encodeWithModule(const std::string& name, const std::vector<Layer>& layers,
                                              const Placement& place) {
  const Result<const ObscuraOpenImageIO*> module = openImageIO();
  if (!module) return Error{ErrorCode::CannotWrite, module.error().message, name, {}};
  std::vector<std::vector<const char*>> names(layers.size());
  std::vector<ObscuraLayer> plain;
  for (size_t i = 0; i < layers.size(); ++i) {
    const Image& image = layers[i].image;
    for (const std::string& channel : layers[i].channels) names[i].push_back(channel.c_str());
    plain.push_back({layers[i].name.c_str(), names[i].data(), image.width, image.height, image.channels,
                     int32_t(image.format), image.bytes.data()});
  }
  const Image& first = layers[0].image;
  const ObscuraPlacement placed{place.x, place.y, place.imageWidth ? place.imageWidth : first.width,
                                place.imageHeight ? place.imageHeight : first.height};
  std::vector<uint8_t> bytes;
  const ObscuraByteSink sink{&bytes, receiveBytes};
  char error[512] = "";
  if ((*module)->encode(name.c_str(), plain.data(), plain.size(), &placed, &sink, error, sizeof error) != 0)
    return Error{ErrorCode::CannotWrite, std::string("cannot encode: ") + error, name, {}};
  return bytes;
}

}  // namespace obscura::engine::codec
