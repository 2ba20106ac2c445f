# SPDX-License-Identifier: MIT
# cmake -DROOT=... -DSOURCE=... -DVERSIONS=... -DKEEP=... -P CodeVersion.cmake
# Writes the source with the digest of the sources that results depend on, when it is another one; with KEEP, once.
if(KEEP AND EXISTS ${SOURCE})
  return()
endif()
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
#include \"code_version.hpp\"

const char* const papilla::k_code_version = \"${digest}\";
")
set(old "")
if(EXISTS ${SOURCE})
  file(READ ${SOURCE} old)
endif()
if(NOT old STREQUAL content)
  file(WRITE ${SOURCE} "${content}")
endif()
