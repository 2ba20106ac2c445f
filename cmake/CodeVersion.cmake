# SPDX-License-Identifier: MIT
# cmake -DROOT=... -DHEADER=... -DVERSIONS=... -P CodeVersion.cmake
# Writes the header with the digest of the sources that results depend on, when it is another one.
set(folders core meshing param texture haptic io procedural pipeline cache)
list(TRANSFORM folders PREPEND ${ROOT}/)
set(patterns)
foreach(folder IN LISTS folders)
  list(APPEND patterns ${folder}/*.cpp ${folder}/*.hpp ${folder}/*.c ${folder}/*.h ${folder}/CMakeLists.txt)
endforeach()
file(GLOB_RECURSE files RELATIVE ${ROOT} ${patterns})
list(SORT files)
set(text "${VERSIONS}\n")
foreach(name IN LISTS files)
  file(SHA256 ${ROOT}/${name} sum)
  string(APPEND text "${name} ${sum}\n")
endforeach()
string(SHA256 digest "${text}")
set(content "// Written by cmake/CodeVersion.cmake.
#pragma once

inline constexpr char k_code_version[] = \"${digest}\";
")
set(old "")
if(EXISTS ${HEADER})
  file(READ ${HEADER} old)
endif()
if(NOT old STREQUAL content)
  file(WRITE ${HEADER} "${content}")
endif()
