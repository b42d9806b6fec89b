// OpenGL without a window, on the processor, found when the program runs: it is built, and runs otherwise, without it.
#pragma once

#include <cstdint>

namespace obscura::apps {

// The functions that the benchmark calls, as OpenGL 3.3 declares them. X(result, name without gl, arguments)
#define OBSCURA_GL_FUNCTIONS(X)                                                                                            \
  X(const unsigned char*, GetString, (unsigned))                                                                           \
  X(void, GenTextures, (int, unsigned*))                                                                                   \
  X(void, BindTexture, (unsigned, unsigned))                                                                               \
  X(void, TexImage2D, (unsigned, int, int, int, int, int, unsigned, unsigned, const void*))                                \
  X(void, TexParameteri, (unsigned, unsigned, int))                                                                        \
  X(void, ActiveTexture, (unsigned))                                                                                       \
  X(void, GenFramebuffers, (int, unsigned*))                                                                               \
  X(void, BindFramebuffer, (unsigned, unsigned))                                                                           \
  X(void, FramebufferTexture2D, (unsigned, unsigned, unsigned, unsigned, int))                                             \
  X(unsigned, CheckFramebufferStatus, (unsigned))                                                                          \
  X(void, DrawBuffers, (int, const unsigned*))                                                                             \
  X(void, GenVertexArrays, (int, unsigned*))                                                                               \
  X(void, BindVertexArray, (unsigned))                                                                                     \
  X(void, GenBuffers, (int, unsigned*))                                                                                    \
  X(void, BindBuffer, (unsigned, unsigned))                                                                                \
  X(void, BufferData, (unsigned, intptr_t, const void*, unsigned))                                                         \
  X(void, EnableVertexAttribArray, (unsigned))                                                                             \
  X(void, VertexAttribPointer, (unsigned, int, unsigned, unsigned char, int, const void*))                                 \
  X(void, VertexAttrib4f, (unsigned, float, float, float, float))                                                          \
  X(unsigned, CreateShader, (unsigned))                                                                                    \
  X(void, ShaderSource, (unsigned, int, const char* const*, const int*))                                                   \
  X(void, CompileShader, (unsigned))                                                                                       \
  X(unsigned, CreateProgram, ())                                                                                           \
  X(void, AttachShader, (unsigned, unsigned))                                                                              \
  X(void, LinkProgram, (unsigned))                                                                                         \
  X(void, GetProgramiv, (unsigned, unsigned, int*))                                                                        \
  X(void, UseProgram, (unsigned))                                                                                          \
  X(int, GetUniformLocation, (unsigned, const char*))                                                                      \
  X(void, Uniform1i, (int, int))                                                                                           \
  X(void, Uniform1f, (int, float))                                                                                         \
  X(void, Uniform2fv, (int, int, const float*))                                                                            \
  X(void, Uniform3fv, (int, int, const float*))                                                                            \
  X(void, Uniform4fv, (int, int, const float*))                                                                            \
  X(void, UniformMatrix3fv, (int, int, unsigned char, const float*))                                                       \
  X(void, UniformMatrix4fv, (int, int, unsigned char, const float*))                                                       \
  X(void, Enable, (unsigned))                                                                                              \
  X(void, Disable, (unsigned))                                                                                             \
  X(void, FrontFace, (unsigned))                                                                                           \
  X(void, ClearColor, (float, float, float, float))                                                                        \
  X(void, Clear, (unsigned))                                                                                               \
  X(void, Viewport, (int, int, int, int))                                                                                  \
  X(void, DrawElements, (unsigned, int, unsigned, const void*))                                                            \
  X(void, DrawArrays, (unsigned, int, int))                                                                                \
  X(void, ReadPixels, (int, int, int, int, unsigned, unsigned, void*))                                                     \
  X(unsigned, GetError, ())                                                                                                \
  X(void, Finish, ())

struct Gl {
#define OBSCURA_DECLARE(result, name, arguments) result(*name) arguments = nullptr;
  OBSCURA_GL_FUNCTIONS(OBSCURA_DECLARE)
#undef OBSCURA_DECLARE
};

// Makes a context of Mesa's llvmpipe current in this thread, with so many threads of its own (by the environment's
// LP_NUM_THREADS). Throws std::runtime_error, with what is missing, where there is none. It lasts as long as the process.
Gl openGl(int threads);

}  // namespace obscura::apps
