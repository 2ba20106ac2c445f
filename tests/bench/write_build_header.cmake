# SPDX-License-Identifier: MIT
# Writes OUTPUT: from which commit, by which compiler and with which flags the benchmarks are built.
# An unchanged file is left alone, so that nothing is compiled again.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#pragma once
#define PAPILLA_BENCH_COMMIT "@commit@"
#define PAPILLA_BENCH_COMPILER "@COMPILER@"
#define PAPILLA_BENCH_COMPILER_VERSION "@COMPILER_VERSION@"
#define PAPILLA_BENCH_FLAGS "@FLAGS@"
#define PAPILLA_BENCH_BUILD_TYPE "@BUILD_TYPE@"
]])
