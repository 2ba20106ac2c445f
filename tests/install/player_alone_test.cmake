# SPDX-License-Identifier: MIT
# Builds the player where the heavy libraries can't be found, and looks at what it links.
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE_DIR} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --preset player -B ${WORK_DIR} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
    -DPAPILLA_BUILD_TESTS=OFF -DPAPILLA_BUILD_BENCHMARKS=OFF)
run(${CMAKE_COMMAND} --build ${WORK_DIR} --target papilla-player)
run(${SOURCE_DIR}/tests/conventions/check_player_links.sh ${WORK_DIR}/bin/papilla-player)
