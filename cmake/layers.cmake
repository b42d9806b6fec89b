# How a layer becomes a library: obscura_layer(raster PUBLIC glm::glm PRIVATE hwy::hwy SOURCES ...).

# Sources say #include "obscura/raster/span.h" in the build tree exactly as an installed program does.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/obscura SYMBOLIC)

set(OBSCURA_WARNINGS -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion)

# Every target of the project: no contraction (a * b + c is two roundings everywhere), warnings, sanitizers.
function(obscura_compile_options target)
  target_compile_options(${target} PRIVATE ${OBSCURA_WARNINGS})
  # PUBLIC: inline functions that a program shares with the library (GLM's) must round alike in both.
  target_compile_options(${target} PUBLIC $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang>:-ffp-contract=off>)
  if(OBSCURA_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${OBSCURA_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${OBSCURA_SANITIZE})
  endif()
endfunction()

# Of what has kernels. With sanitizers, Highway's emulation of vectors by loops takes five minutes a kernel to compile: SSSE3 is
# the least then, and SSE4, which differs by little, is left out. All targets compile the same sources.
function(obscura_kernel_options target)
  if(OBSCURA_SANITIZE AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(${target} PRIVATE -mssse3)
    target_compile_definitions(${target} PRIVATE HWY_DISABLED_TARGETS=HWY_SSE4)
  endif()
endfunction()

function(obscura_layer name)
  cmake_parse_arguments(L "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(obscura_${name} ${L_SOURCES})
  add_library(obscura::${name} ALIAS obscura_${name})
  set_target_properties(obscura_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(obscura_${name} PUBLIC cxx_std_17)
  target_include_directories(obscura_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(obscura_${name} PUBLIC ${L_PUBLIC} PRIVATE ${L_PRIVATE})
  obscura_compile_options(obscura_${name})
  obscura_kernel_options(obscura_${name})
endfunction()
