# SPDX-License-Identifier: MIT
# Finds the libraries of Debian 12 and repairs what their packages leave open.

find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(TinyGLTF REQUIRED)
# Compressed glTF. The toolkit needs both, the player alone does without.
if(PAPILLA_BUILD_TOOLKIT)
  find_package(draco REQUIRED)
  find_package(meshoptimizer REQUIRED)
else()
  find_package(draco QUIET)
  find_package(meshoptimizer QUIET)
endif()
# Debian's libdraco exports a tinygltf of another version, so it must stand behind the real one wherever both are linked.
if(draco_FOUND)
  set_property(TARGET TinyGLTF::TinyGLTF APPEND PROPERTY INTERFACE_LINK_LIBRARIES draco::draco)
endif()
find_package(PkgConfig REQUIRED)
pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(MD REQUIRED IMPORTED_TARGET libmd)
pkg_check_modules(SNDFILE REQUIRED sndfile)
pkg_check_modules(ALSA REQUIRED alsa)
if(PAPILLA_BUILD_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

if(PAPILLA_BUILD_TOOLKIT)
  find_package(Eigen3 REQUIRED NO_MODULE)
  # Before CGAL: CGAL's own FindOpenMesh would shadow the package configuration.
  find_package(OpenMesh CONFIG REQUIRED)
  set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE ON)
  find_package(CGAL REQUIRED)
  find_package(Boost 1.74 REQUIRED)  # Headers only: Beast, Asio and Math.
  find_package(OpenSSL REQUIRED COMPONENTS Crypto SSL)
  pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)
  find_package(websocketpp REQUIRED)
  find_package(TBB REQUIRED)
  find_package(Ceres REQUIRED)
  find_package(OpenCASCADE REQUIRED)
  pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3)
  find_package(assimp REQUIRED)
  find_package(OpenImageIO REQUIRED)
  find_package(PNG REQUIRED)
  pkg_check_modules(LCMS REQUIRED IMPORTED_TARGET lcms2)
  if(PAPILLA_BUILD_PYTHON AND NOT PAPILLA_SANITIZE)  # The interpreter has no sanitizers.
    # The system's Python, whose numpy is the package; -DPython_EXECUTABLE names another one.
    find_program(Python_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
    find_package(Python QUIET COMPONENTS Interpreter Development.Module NumPy OPTIONAL_COMPONENTS Development.Embed)
    if(Python_FOUND)
      find_package(pybind11 QUIET)
    endif()
  endif()
  if(PAPILLA_BUILD_PYTHON AND NOT pybind11_FOUND)
    message(STATUS "No Python module: that needs pybind11, numpy and Python's headers")
    set(PAPILLA_BUILD_PYTHON OFF)
  endif()
  # Debian's target names an OpenCV include directory that need not exist.
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")

  # OpenCASCADE sets no include directory on its targets.
  add_library(papilla_occt INTERFACE)
  set_target_properties(papilla_occt PROPERTIES EXPORT_NAME occt)
  target_include_directories(papilla_occt SYSTEM INTERFACE ${OpenCASCADE_INCLUDE_DIR})
  target_link_libraries(papilla_occt INTERFACE TKernel TKMath TKG2d TKG3d TKGeomBase TKBRep TKGeomAlgo
    TKTopAlgo TKPrim TKBool TKBO TKFillet TKOffset TKShHealing TKMesh TKXSBase TKSTEP TKIGES TKXDESTEP
    TKXDEIGES TKXCAF TKLCAF TKCAF TKCDF)

  # CGAL adds -frounding-math to whatever links it: link it privately and only where it is used.
  add_library(papilla_cgal INTERFACE)
  set_target_properties(papilla_cgal PROPERTIES EXPORT_NAME cgal)
  target_link_libraries(papilla_cgal INTERFACE CGAL::CGAL Eigen3::Eigen)
  target_compile_definitions(papilla_cgal INTERFACE CGAL_EIGEN3_ENABLED)
endif()
