# SPDX-License-Identifier: MIT
# One helper per kind of target, so that every module is built the same way.

add_library(papilla_build_options INTERFACE)
target_compile_features(papilla_build_options INTERFACE cxx_std_20)
target_compile_options(papilla_build_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
    -Wold-style-cast -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused
    -Wdouble-promotion -Wformat=2>
  $<$<BOOL:${PAPILLA_WARNINGS_AS_ERRORS}>:-Werror>)
# g++ 12 warns falsely of overlapping copies in "text" + std::string (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(papilla_build_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
endif()
if(PAPILLA_SANITIZE)
  target_compile_options(papilla_build_options INTERFACE -fsanitize=${PAPILLA_SANITIZE} -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer)
  target_link_options(papilla_build_options INTERFACE -fsanitize=${PAPILLA_SANITIZE})
endif()

# papilla_module(NAME [PLAYER] SOURCES ... [PUBLIC libs] [PRIVATE libs])
# A static library papilla::NAME whose public headers are those below include/. PLAYER: the player, which has a limit of
# size, links it and leaves out the functions that it does not call.
function(papilla_module name)
  cmake_parse_arguments(ARG "PLAYER" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target papilla_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(papilla::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/include/*.hpp
       ${CMAKE_CURRENT_SOURCE_DIR}/include/*.h)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/include
                                  FILES ${headers})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE}
                                  $<BUILD_INTERFACE:papilla_build_options>)
  if(ARG_PLAYER)
    target_compile_options(${target} PRIVATE -ffunction-sections -fdata-sections)
  endif()
  install(TARGETS ${target} EXPORT papilla-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev FILE_SET HEADERS COMPONENT dev)
  set_property(GLOBAL APPEND PROPERTY PAPILLA_COMPONENTS ${name})
endfunction()

# papilla_plugin(NAME SOURCES ... LIBRARIES ...)
# papilla_NAME.so, which papilla::plugin loads when it is needed: what links heavy libraries. Its one symbol is the
# variable papilla_NAME.
function(papilla_plugin name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(target papilla_${name}_plugin)
  add_library(${target} MODULE ${ARG_SOURCES})
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME papilla_${name} CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin/${PAPILLA_PLUGIN_FOLDER})
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} papilla_build_options)
  target_link_options(${target} PRIVATE -Wl,--exclude-libs,ALL)
  install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/papilla COMPONENT papilla)
endfunction()

# papilla_types(NAME DIRECTORY dir FILES header... [PUBLIC libs])
# A header-only papilla::NAME: the few types of a toolkit folder that the player side shares.
function(papilla_types name)
  cmake_parse_arguments(ARG "" "DIRECTORY" "FILES;PUBLIC" ${ARGN})
  set(target papilla_${name})
  add_library(${target} INTERFACE)
  add_library(papilla::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  set(base ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_DIRECTORY}/include)
  list(TRANSFORM ARG_FILES PREPEND ${base}/papilla/${ARG_DIRECTORY}/)
  target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${base} FILES ${ARG_FILES})
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_link_libraries(${target} INTERFACE ${ARG_PUBLIC})
  install(TARGETS ${target} EXPORT papilla-targets FILE_SET HEADERS COMPONENT dev)
endfunction()

# papilla_program(NAME SOURCES ... LIBRARIES ... [INSTALL component])
function(papilla_program name)
  cmake_parse_arguments(ARG "" "INSTALL" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} papilla_build_options)
  if(ARG_INSTALL)
    install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${ARG_INSTALL})
  endif()
endfunction()

# papilla_test(NAME SOURCES ... LIBRARIES ...)
# One GoogleTest program; every case becomes a ctest test named module.Suite.Case.
function(papilla_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  set(target papilla_${name}_tests)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main papilla_build_options)
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  gtest_discover_tests(${target} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS "${name};${ARG_LABELS}" TIMEOUT 300)
endfunction()

# papilla_small(FILE...)
# Sources that run once and should stay small: the player has a limit.
function(papilla_small)
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-Os>)
endfunction()
