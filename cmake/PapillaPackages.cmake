# SPDX-License-Identifier: MIT
# The .deb files: one for each component of the install. ./run package makes them.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME papilla)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # Each package has its own.
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_PACKAGE_CONTACT "Papilla maintainers <maintainers@papilla.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/packages/finish_tree.cmake)

configure_file(packages/changelog.in ${CMAKE_BINARY_DIR}/changelog.Debian @ONLY)

# papilla_package(COMPONENT NAME SECTION section SUMMARY text TEXT lines... [DEPENDS packages]
#                 [RECOMMENDS packages] [SUGGESTS packages])
# The component's .deb file, with the copyright and change log that each package has. TEXT: lines of the description.
function(papilla_package component name)
  cmake_parse_arguments(ARG "" "SECTION;SUMMARY;DEPENDS;RECOMMENDS;SUGGESTS" "TEXT" ${ARGN})
  string(TOUPPER ${component} key)
  list(JOIN ARG_TEXT "\n" text)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${ARG_SECTION} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${ARG_SUMMARY}\n${text}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${ARG_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_RECOMMENDS "${ARG_RECOMMENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SUGGESTS "${ARG_SUGGESTS}" PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  install(FILES ${CMAKE_SOURCE_DIR}/packages/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  install(FILES ${CMAKE_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} RENAME changelog
          COMPONENT ${component})
  install(FILES ${CMAKE_BINARY_DIR}/changelog.Debian DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endfunction()

if(PAPILLA_BUILD_TOOLKIT)
  papilla_package(papilla papilla SECTION graphics SUMMARY "CAD interiors that can be seen and felt"
    SUGGESTS "papilla-player, python3-papilla, blender, gnuplot-nox, www-browser"
    TEXT "Papilla takes the surfaces of a car cockpit as CAD gives them, repairs and"
         "charts them, unwraps them in millimetres, reads photographs of grain as"
         "relief, and bakes the result into one glTF file whose materials carry what"
         "a hand needs: stiffness, friction and a 16-bit height map.")
  # The pages; those on the web are made of them by mkdocs.
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/papilla/docs COMPONENT papilla
    FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png" PATTERN "*.jpg" PATTERN make EXCLUDE)
  install(FILES ${CMAKE_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/papilla COMPONENT papilla)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libpapilla-dev COMPONENT dev)
  # Menus and software centres.
  install(FILES ${CMAKE_SOURCE_DIR}/packages/invalid.papilla.papilla.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT papilla)
  install(FILES ${CMAKE_SOURCE_DIR}/packages/papilla.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT papilla)
  install(FILES ${CMAKE_SOURCE_DIR}/packages/papilla.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps
          COMPONENT papilla)
endif()
if(TARGET papilla_python)
  # Made for one version of Python; reads pictures, CAD and materials by what is in papilla.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(python ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})
  papilla_package(python python3-papilla SECTION python SUMMARY "CAD interiors that can be seen and felt, from Python"
    DEPENDS "papilla (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), python3 (>= ${python}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy (>= 1:1.21)"
    SUGGESTS "python3-matplotlib"
    TEXT "The module papilla: scenes, meshes, charts, parameterizations and their"
         "distortion, pictures, reliefs, recipes, bakes and contact, with numpy's arrays.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packages/python/postinst ${CMAKE_SOURCE_DIR}/packages/python/prerm)
endif()
papilla_package(player papilla-player SECTION graphics SUMMARY "player of glTF files that can be felt"
  SUGGESTS "libasound2, libsndfile1"
  TEXT "Reads a glTF file with haptic tags, as Papilla bakes it, and drives a force"
       "device, or a simulated one, at 1 kHz. Vibration as sound needs libasound2 or"
       "libsndfile1, which are loaded when they are asked for.")
papilla_package(library libpapilla1 SECTION libs SUMMARY "forces of the materials of a glTF file"
  TEXT "Library with a C interface that loads a glTF file with haptic tags and"
       "computes the force on a hand that touches it, at 1 kHz.")
get_target_property(papilla_abi papilla_c SOVERSION)
file(CONFIGURE OUTPUT shlibs CONTENT "libpapilla @papilla_abi@ libpapilla1 (>= @PROJECT_VERSION@)\n" @ONLY)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packages/triggers ${CMAKE_CURRENT_BINARY_DIR}/shlibs)
papilla_package(dev libpapilla-dev SECTION libdevel SUMMARY "development files of Papilla"
  DEPENDS "libpapilla1 (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})"
  RECOMMENDS "libdraco-dev, libhidapi-dev, libmd-dev, libmeshoptimizer-dev, libtinygltf-dev, nlohmann-json3-dev"
  SUGGESTS "libassimp-dev, libceres-dev, libcgal-dev, libeigen3-dev, libfftw3-dev, libfmt-dev, liblcms2-dev, libocct-data-exchange-dev, libopenimageio-dev, libopenmesh-dev, libpng-dev, libssl-dev, libtbb-dev"
  TEXT "Headers, static libraries, CMake and pkg-config files: the C interface of"
       "libpapilla1, and the C++ libraries of meshing, parameterization, texture,"
       "haptics and pipeline. C programs need nothing else; the C++ libraries of touch"
       "need what is recommended, those of the toolkit what is suggested.")
include(CPack)
