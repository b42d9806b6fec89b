#include "obscura/apps/gl.h"

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace obscura::apps {
namespace {

// Of EGL 1.5, EGL_EXT_platform_base and EGL_MESA_platform_surfaceless.
constexpr unsigned kSurfacelessMesa = 0x31DD, kOpenGlApi = 0x30A2;
constexpr int kMajor = 0x3098, kMinor = 0x30FB, kProfile = 0x30FD, kCore = 1, kNone = 0x3038;

using Function = void (*)();
using GetProcAddress = Function (*)(const char*);

[[noreturn]] void missing(const std::string& what) {
  throw std::runtime_error("no llvmpipe to compare with: " + what + " (Debian: libegl1, libgl1-mesa-dri)");
}

}  // namespace

Gl openGl(int threads) {
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) missing("libEGL.so.1 cannot be loaded");
  const auto getProcAddress = reinterpret_cast<GetProcAddress>(dlsym(library, "eglGetProcAddress"));
  const auto egl = [&](const char* name) {
    void* symbol = dlsym(library, name);
    if (Function f = symbol ? reinterpret_cast<Function>(symbol) : getProcAddress ? getProcAddress(name) : nullptr) return f;
    missing(std::string("libEGL has no ") + name);
  };
  const auto display = reinterpret_cast<void* (*)(unsigned, void*, const int*)>(egl("eglGetPlatformDisplayEXT"))(kSurfacelessMesa, nullptr, nullptr);
  if (!display || !reinterpret_cast<unsigned (*)(void*, int*, int*)>(egl("eglInitialize"))(display, nullptr, nullptr))
    missing("EGL has no display without a window");
  reinterpret_cast<unsigned (*)(unsigned)>(egl("eglBindAPI"))(kOpenGlApi);
  const int attributes[] = {kMajor, 3, kMinor, 3, kProfile, kCore, kNone};
  void* context = reinterpret_cast<void* (*)(void*, void*, void*, const int*)>(egl("eglCreateContext"))(display, nullptr, nullptr, attributes);
  if (!context || !reinterpret_cast<unsigned (*)(void*, void*, void*, void*)>(egl("eglMakeCurrent"))(display, nullptr, nullptr, context))
    missing("EGL makes no context of OpenGL 3.3");

  Gl gl;
#define OBSCURA_LOAD(result, name, arguments) gl.name = reinterpret_cast<result(*) arguments>(egl("gl" #name));
  OBSCURA_GL_FUNCTIONS(OBSCURA_LOAD)
#undef OBSCURA_LOAD
  const unsigned char* renderer = gl.GetString(0x1F01);
  const std::string name = renderer ? reinterpret_cast<const char*>(renderer) : "";
  if (name.find("llvmpipe") == name.npos) missing("OpenGL is \"" + name + "\"");
  return gl;
}

}  // namespace obscura::apps
