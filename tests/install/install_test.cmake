# SPDX-License-Identifier: MIT
# Installs BUILD_DIR into an empty folder, then builds and runs the consumer of COMPONENTS against it.
# Packages named in HIDDEN count as not installed.
file(REMOVE_RECURSE ${WORK_DIR})
list(TRANSFORM HIDDEN REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix COMMAND_ERROR_IS_FATAL ANY)
# What the program needs beside it is installed, too.
if(EXISTS ${WORK_DIR}/prefix/bin/papilla)
  execute_process(COMMAND ${WORK_DIR}/prefix/bin/papilla materials list --json - OUTPUT_VARIABLE library
    COMMAND_ERROR_IS_FATAL ANY)
  if(NOT library MATCHES "${WORK_DIR}/prefix/share/papilla/materials")
    message(FATAL_ERROR "the installed program does not find the installed material library")
  endif()
  # The plug-ins are found where they are installed, not in the build tree.
  execute_process(COMMAND ${CMAKE_COMMAND} -E env LD_DEBUG=files ${WORK_DIR}/prefix/bin/papilla inspect ${CAD_FILE}
    OUTPUT_QUIET ERROR_VARIABLE loaded COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env LD_DEBUG=files ${WORK_DIR}/prefix/bin/papilla synthesize grain
    --kind leather --size 64 -o ${WORK_DIR}/grain.png OUTPUT_QUIET ERROR_VARIABLE more COMMAND_ERROR_IS_FATAL ANY)
  foreach(plugin cad pictures)
    if(NOT "${loaded}${more}" MATCHES "calling init: ${WORK_DIR}/prefix/lib[^ \n]*/papilla/papilla_${plugin}.so")
      message(FATAL_ERROR "the installed program does not load the installed papilla_${plugin}.so")
    endif()
  endforeach()
  foreach(schema materials library-material)
    if(NOT EXISTS ${WORK_DIR}/prefix/share/papilla/schema/${schema}.schema.json)
      message(FATAL_ERROR "${schema}.schema.json is not installed")
    endif()
  endforeach()
endif()
# Quoted, a list is one argument.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_DIR}/build -G Ninja -Wno-dev
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_FLAGS=${CXX_FLAGS}
    "-DCOMPONENTS=${COMPONENTS}" ${HIDDEN} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK_DIR}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${WORK_DIR}/build --output-on-failure --output-junit ran.xml
    COMMAND_ERROR_IS_FATAL ANY)
file(READ ${WORK_DIR}/build/ran.xml ran)
foreach(component IN LISTS COMPONENTS)
  if(NOT ran MATCHES "testcase name=\"${component}\"[^>]*status=\"run\"")
    message(FATAL_ERROR "the component ${component} was not consumed")
  endif()
endforeach()
