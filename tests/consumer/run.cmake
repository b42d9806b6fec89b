# cmake -DBUILD_DIR=... -DCOMPILER=... -P run.cmake: installs raster and post into a fresh prefix, then configures,
# builds and runs the project in this folder against it.
cmake_minimum_required(VERSION 3.25)

set(work ${BUILD_DIR}/consumer)
file(REMOVE_RECURSE ${work})
foreach(layer raster post)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${work}/prefix --component ${layer}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${work}/build -G Ninja
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${work}/prefix
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${work}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${work}/build/consumer OUTPUT_FILE ${work}/picture.ppm COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${work}/picture.ppm size)
if(NOT size EQUAL 230415)  # a header of 15 bytes and 320 x 240 x 3
  message(FATAL_ERROR "the picture has ${size} bytes")
endif()

execute_process(COMMAND ldd ${work}/build/consumer OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(libraries MATCHES "(OpenImageIO|meshoptimizer|jpeg|png|xxhash|tinygltf|embree)")
  message(FATAL_ERROR "the core links ${CMAKE_MATCH_1}:\n${libraries}")
endif()
