# cmake --install: each layer is a component of its own, so that the embeddable core (raster, post) can be installed
# without the engine; "programs" has the command lines and the image module. Consumers: obscuraConfig.cmake.in.
include(CMakePackageConfigHelpers)

set(OBSCURA_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/obscura)

# The packages that a layer's targets link, by the namespace of what it links: TBB::tbb is found by find_package(TBB).
# Private ones count too: a static library hands them on to whoever links it.
function(obscura_packages_of layer result)
  set(packages)
  get_target_property(libraries obscura_${layer} LINK_LIBRARIES)
  foreach(library IN LISTS libraries)
    if(library MATCHES "^([A-Za-z0-9_-]+)::" AND NOT CMAKE_MATCH_1 STREQUAL "obscura")
      list(APPEND packages ${CMAKE_MATCH_1})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  set(${result} ${packages} PARENT_SCOPE)
endfunction()

foreach(layer raster post engine)
  obscura_packages_of(${layer} OBSCURA_PACKAGES_${layer})
  install(TARGETS obscura_${layer} EXPORT obscura-${layer}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${layer}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${layer}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${layer})
  install(EXPORT obscura-${layer} NAMESPACE obscura:: FILE obscura-${layer}.cmake
    DESTINATION ${OBSCURA_CONFIG_DIR} COMPONENT ${layer})
  # SIMD fragments and offline generators are no interface.
  install(DIRECTORY ${layer}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/obscura/${layer} COMPONENT ${layer}
    FILES_MATCHING PATTERN "*.h" PATTERN "*-inl.h" EXCLUDE PATTERN "make_*.h" EXCLUDE)
endforeach()

configure_package_config_file(cmake/obscuraConfig.cmake.in ${PROJECT_BINARY_DIR}/obscuraConfig.cmake
  INSTALL_DESTINATION ${OBSCURA_CONFIG_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/obscuraConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/obscuraConfig.cmake ${PROJECT_BINARY_DIR}/obscuraConfigVersion.cmake
  DESTINATION ${OBSCURA_CONFIG_DIR} COMPONENT raster)

if(OBSCURA_APPS)
  get_property(programs DIRECTORY apps PROPERTY BUILDSYSTEM_TARGETS)
  foreach(program IN LISTS programs)
    get_target_property(type ${program} TYPE)
    if(type STREQUAL "EXECUTABLE" AND NOT program MATCHES "obscura-make-")
      install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
    endif()
  endforeach()
endif()
if(TARGET obscura_openimageio)
  install(TARGETS obscura_openimageio LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/obscura COMPONENT programs)
endif()
