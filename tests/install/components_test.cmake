# SPDX-License-Identifier: MIT
# The components of the install, of which packages are made: every file is in one, and what each must have is there.
# Usage: cmake -D BUILD_DIR=folder -D WORK_DIR=folder -D TOOLKIT=bool -D PYTHON=bool -P components_test.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK_DIR})

function(installed result)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix ${ARGN}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE files RELATIVE ${WORK_DIR}/prefix ${WORK_DIR}/prefix/*)
  file(REMOVE_RECURSE ${WORK_DIR}/prefix)
  set(${result} ${files} PARENT_SCOPE)
endfunction()

set(player bin/papilla-player share/bash-completion/completions/papilla-player share/papilla/schema/haptic-material.schema.json)
set(library "lib[^;]*/libpapilla\\.so\\.[0-9]+")
set(dev "lib[^;]*/libpapilla\\.so" "lib[^;]*/libpapilla_haptic\\.a" include/papilla/io/papilla_haptic\\.h
    include/papilla/core/vec\\.hpp "lib[^;]*/cmake/papilla/papilla-config\\.cmake" "lib[^;]*/pkgconfig/papilla\\.pc")
set(papilla bin/papilla "lib[^;]*/papilla/papilla_cad\\.so" "lib[^;]*/papilla/papilla_pictures\\.so"
    share/bash-completion/completions/papilla share/papilla/demo/cockpit\\.step share/papilla/demo/materials\\.json
    share/papilla/schema/materials\\.schema\\.json "share/papilla/materials/[^;]*\\.json" share/papilla/blender/papilla_blender\\.zip)
set(python "lib[^;]*/papilla/_papilla\\.[^;]*so" "lib[^;]*/papilla/__init__\\.py" "lib[^;]*/papilla/__init__\\.pyi"
    "lib[^;]*/papilla/py\\.typed")
set(components player library dev)
if(TOOLKIT)
  list(APPEND components papilla)
endif()
if(PYTHON)
  list(APPEND components python)
endif()

installed(all)
foreach(component IN LISTS components)
  installed(files --component ${component})
  foreach(wanted IN LISTS ${component})
    if(NOT ";${files};" MATCHES ";${wanted};")
      message(SEND_ERROR "component ${component} has no ${wanted}")
    endif()
  endforeach()
  list(LENGTH files count)
  list(REMOVE_DUPLICATES files)
  foreach(file IN LISTS files)
    if(NOT file IN_LIST all)
      message(SEND_ERROR "${file} of component ${component} is in another one too, or not in the whole install")
    endif()
  endforeach()
  list(REMOVE_ITEM all ${files})
  message("${component}: ${count} files")
endforeach()
if(all)
  message(SEND_ERROR "in no component: ${all}")
endif()
