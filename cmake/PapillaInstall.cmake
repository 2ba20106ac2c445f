# SPDX-License-Identifier: MIT
include(CMakePackageConfigHelpers)
get_property(PAPILLA_COMPONENTS GLOBAL PROPERTY PAPILLA_COMPONENTS)
configure_package_config_file(cmake/papilla-config.cmake.in ${CMAKE_BINARY_DIR}/papilla-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/papilla)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/papilla-config-version.cmake
  COMPATIBILITY SameMinorVersion)
# The helpers that the static libraries name as what has to be linked.
if(PAPILLA_BUILD_TOOLKIT)
  install(TARGETS papilla_occt papilla_cgal EXPORT papilla-targets)
endif()
install(EXPORT papilla-targets NAMESPACE papilla:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/papilla COMPONENT dev)
install(FILES ${CMAKE_BINARY_DIR}/papilla-config.cmake ${CMAKE_BINARY_DIR}/papilla-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/papilla COMPONENT dev)
