# SPDX-License-Identifier: MIT
# What makes a fault of memory hard to use, for every library and program; docs/security.md, check_hardening.sh.
# Sanitizers have their own checks, and _FORTIFY_SOURCE needs an optimised build.
include(CheckCXXCompilerFlag)
include(CheckPIESupported)

set(CMAKE_POSITION_INDEPENDENT_CODE ON)
check_pie_supported(LANGUAGES C CXX)

foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full)
  string(MAKE_C_IDENTIFIER "PAPILLA_HAS${flag}" known)
  check_cxx_compiler_flag(${flag} ${known})
  if(${known})
    target_compile_options(papilla_build_options INTERFACE ${flag})
  endif()
endforeach()
if(NOT PAPILLA_SANITIZE)
  target_compile_options(papilla_build_options INTERFACE
    $<$<CONFIG:Release,RelWithDebInfo>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3>)
endif()
target_link_options(papilla_build_options INTERFACE -Wl,-z,relro,-z,now,-z,noexecstack)
