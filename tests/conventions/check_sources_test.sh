#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Shows that check_sources.sh finds each kind of breach, and nothing in a tree without one.
# usage: check_sources_test.sh
set -euo pipefail
check=$(cd "$(dirname "$0")" && pwd)/check_sources.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree"

failures=0

# write FILE LICENCE [LINE ...]
write() {
  mkdir -p "$(dirname "$1")"
  printf '// SPDX-License-Identifier: %s\n' "$2" >"$1"
  if (($# > 2)); then printf '%s\n' "${@:3}" >>"$1"; fi
}

# list FILE LINE ...: the same of a file whose comments begin with #.
list() {
  mkdir -p "$(dirname "$1")"
  printf '%s\n' '# SPDX-License-Identifier: MIT' "${@:2}" >"$1"
}

# expect TEXT: the check must fail with exactly one line, which holds TEXT. Then the tree is emptied.
expect() {
  local output
  if output=$("$check" "$tree") || [[ $output != *"$1"* || $output == *$'\n'* ]]; then
    printf 'expected one breach "%s", got: %s\n' "$1" "$output"
    failures=$((failures + 1))
  fi
  rm -rf "${tree:?}"/*
}

cp "$(dirname "$check")/../../.clang-format" .  # stays when the tree is emptied
write core/src/a.cpp MIT '#include <vector>' '#include "papilla/core/error.hpp"'
write param/src/b.cpp GPL-3.0-or-later '#include <CGAL/Surface_mesh.h>' '#include "papilla/meshing/triangle_mesh.hpp"'
write apps/papilla/main.cpp GPL-3.0-or-later '#include "papilla/pipeline/bake_scene.hpp"'
write pipeline/src/a.cpp MIT '#include "b.hpp"' '' '#include <nlohmann/json.hpp>'
write pipeline/src/b.hpp MIT '#include "papilla/param/lscm.hpp"'
list pipeline/CMakeLists.txt 'papilla_module(pipeline PRIVATE nlohmann_json::nlohmann_json)'
list CMakeLists.txt 'project(papilla LANGUAGES CXX)'
list cmake/PapillaDependencies.cmake 'find_package(nlohmann_json REQUIRED)' 'find_package(CGAL REQUIRED)'
list run 'readonly build_packages=(' '  g++  # the compiler' '  nlohmann-json3-dev' ')'
"$check" "$tree" || { echo 'a tree without breach is refused'; failures=$((failures + 1)); }
rm -rf "${tree:?}"/*

mkdir -p core && echo 'int a;' >core/a.cpp && expect 'core/a.cpp: has no SPDX-License-Identifier'
write core/a.cpp Apache-2.0 && expect 'unknown licence'
write core/a.cpp GPL-3.0-or-later && expect 'this folder is MIT'
write apps/papilla/a.cpp MIT && expect 'apps/papilla is GPL-3.0-or-later'
write meshing/a.cpp MIT '#include <CGAL/Surface_mesh.h>' && expect ', which is GPL, but says MIT'
write texture/a.cpp MIT '// clang-format off' '#  include <fftw3.h>' && expect ', which is GPL, but says MIT'
write haptic/a.cpp MIT '#include <Eigen/Core>' && expect 'the player side must not include <Eigen/Core>'
write io/gltf/a.cpp MIT '#include <gp_Pnt.hxx>' && expect 'must not include <gp_Pnt.hxx>'
write apps/player/a.cpp MIT '#include <OpenImageIO/imageio.h>' && expect 'must not include <OpenImageIO/imageio.h>'
write param/include/papilla/param/a.hpp MIT '#include <Eigen/Core>' && expect 'a public header must not include <Eigen/Core>'
write io/include/papilla/io/a.hpp MIT '#include "helper.hpp"' && expect 'a public header must not include "helper.hpp"'
write meshing/a.cpp MIT '#include "papilla/param/lscm.hpp"' && expect 'meshing must not include "papilla/param/lscm.hpp"'
write core/a.cpp MIT '#include "papilla/meshing/triangle_mesh.hpp"' && expect 'core must not include'
write texture/a.cpp MIT '#include "papilla/haptic/model.hpp"' && expect 'texture must not include'
write io/src/a.cpp MIT '#include "papilla/pipeline/bake_scene.hpp"' && expect 'io must not include'
write apps/player/a.cpp MIT '#include "papilla/pipeline/bake_scene.hpp"' && expect 'apps/player must not include'
write pipeline/include/papilla/pipeline/a.hpp MIT '#include <nlohmann/json.hpp>' && expect 'a public header must not include <nlohmann/json.hpp>'
write pipeline/src/a.hpp MIT '#include <nlohmann/json.hpp>' && expect 'a header of pipeline must not include <nlohmann/json.hpp>'
write pipeline/src/a.cpp MIT '#include <CLI/CLI.hpp>' && expect 'pipeline must not include <CLI/CLI.hpp>'
write pipeline/src/a.cpp MIT '#include <iostream>' && expect 'pipeline must not include <iostream>'
write pipeline/src/a.cpp MIT '#include "verb.hpp"' && expect 'must not include "verb.hpp", which is no header of its library'
write pipeline/src/a.cpp Apache-2.0 && expect 'unknown licence'
write io/src/a.cpp MIT 'std::ofstream out(name);' && expect 'io/src/a.cpp: writes past write_atomically()'
write apps/papilla/a.cpp GPL-3.0-or-later 'void f() { std::cout << 1; }' && expect 'prints past print_out()'
write apps/player/a.cpp MIT 'void f() { fmt::print("{}", 1); }' && expect 'prints past print_out()'
write apps/papilla/text/a.cpp GPL-3.0-or-later 'auto a = fmt::format("{}", name);' && expect 'formats names past shown_format()'
mkdir -p examples && echo 'int a;' >examples/a.cpp && expect 'examples/a.cpp: has no SPDX-License-Identifier'
list cmake/PapillaDependencies.cmake 'find_package(OpenMesh REQUIRED)' && expect 'requires OpenMesh, which no source includes'
list cmake/PapillaDependencies.cmake 'pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3)' &&
  expect 'requires fftw3, which no source includes'
list cmake/PapillaDependencies.cmake 'find_package(Qt6 REQUIRED)' && expect 'requires Qt6, of which'
list run 'readonly build_packages=(libopenmesh-dev)' && expect 'run: requires libopenmesh-dev, which no source includes'
list run 'readonly docs_packages=(' '  gnuplot-nox  # plots' ')' && expect 'run: requires gnuplot-nox, which no script calls'
write core/src/a.cpp MIT '#include <vector>' && list core/CMakeLists.txt 'papilla_module(core PRIVATE TBB::tbb)' &&
  expect 'core/CMakeLists.txt: links TBB::tbb, which no source of its folder includes'
if command -v clang-format >/dev/null; then
  write core/src/a.cpp MIT 'int  a;' && expect 'core/src/a.cpp: is not formatted'
fi

echo "$failures failures"
((failures == 0))
