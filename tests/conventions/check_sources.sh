#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks what the compiler can't: licence lines, who may include whom, that every required package is used, and the
# format of C++ files. Prints one line per breach, exits 1 if any.
# usage: check_sources.sh ROOT
set -euo pipefail
cd "$1"

breaches=0
breach() {
  printf '%s: %s\n' "$1" "$2"
  breaches=$((breaches + 1))
}

# All files below the given folders with one of the usual endings, without what other people made.
sources() {
  local path
  local -a existing=()
  for path in "$@"; do [[ ! -e $path ]] || existing+=("$path"); done
  ((${#existing[@]})) || return 0
  find "${existing[@]}" \( -name node_modules -o -name build \) -prune -o -type f \
    \( -name '*.?pp' -o -name '*.h' -o -name '*.c' -o -name '*.cmake' -o -name CMakeLists.txt -o -name '*.sh' -o -name '*.mjs' \
    -o -name '*.py' -o -name run \) -print | sort
}
cpp_sources() { sources "$@" | grep -E '\.([ch]pp|h|c)$' || true; }

# What the files named on stdin include: "FILE NAME" a line, NAME with its brackets.
includes() {
  xargs -r grep -HE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]' |
    sed -nE 's/^([^:]+):[^<"]*([<"][^">]*[">]).*/\1 \2/p'
}

# Reports every "FILE NAME" of stdin; the reason's %s stands for NAME.
breach_each() {
  local file name
  while read -r file name; do breach "$file" "${1/\%s/$name}"; done
}

# The licence of each file named on stdin: "FILE LICENCE" a line, without LICENCE when the first three lines name none.
licences() {
  xargs -r awk 'FNR == 1 { if (file != "") print file, licence; file = FILENAME; licence = "" }
    FNR <= 3 && match($0, /SPDX-License-Identifier: [^ ]+/) { licence = substr($0, RSTART + 25, RLENGTH - 25) }
    END { if (file != "") print file, licence }'
}

# Folders of libraries, and all folders with C++ files.
readonly libraries=(core cache meshing param texture procedural haptic io study pipeline)
readonly all_cpp=("${libraries[@]}" apps python tests data examples)

readonly gpl_headers=' <(CGAL/|fftw3)'
readonly heavy_headers=' [<"](CGAL/|OpenMesh/|OpenImageIO/|assimp/|Eigen/|fftw3|ceres/|oneapi/tbb|tbb/|[A-Za-z0-9_]+\.hxx)'

check_licence_lines() {
  local file licence
  while read -r file licence; do
    case $licence in
      MIT)
        if [[ $file == apps/papilla/* ]]; then breach "$file" "apps/papilla is GPL-3.0-or-later, the file says MIT"; fi ;;
      GPL-3.0-or-later)
        if [[ $file =~ ^(core|haptic|io/gltf|io/haptic|io/c|apps/player)/ ]]; then
          breach "$file" "this folder is MIT, the file says GPL-3.0-or-later"
        fi ;;
      '') breach "$file" "has no SPDX-License-Identifier in its first three lines" ;;
      *) breach "$file" "unknown licence: $licence" ;;
    esac
  done < <(sources run .ci CMakeLists.txt cmake page docs/make "${all_cpp[@]}" | licences)
}

check_gpl_users() {
  local all
  all=$(cpp_sources "${all_cpp[@]}")
  breach_each "includes %s, which is GPL, but says MIT" < <(licences <<<"$all" | awk '$2 == "MIT" {print $1}' | includes |
    grep -E "$gpl_headers")
}

# The player and everything it links: no library but hidapi, tinygltf, and small ones for JSON and the command line.
check_light_folders() {
  breach_each "the player side must not include %s" < <(cpp_sources core haptic io/gltf io/haptic io/c apps/player | includes |
    grep -E "$heavy_headers")
}

# Public headers: the standard library and papilla only, so that no user needs our libraries to compile.
check_public_headers() {
  breach_each "a public header must not include %s" < <(cpp_sources "${libraries[@]}" |
    grep /include/ | includes | grep -vE ' (<[a-z0-9_]+>|<std(def|int|bool)\.h>|"papilla/.*")$')
}

# Which folders the files of a folder may include.
allowed_modules() {
  case $1 in
    core) echo core ;;
    meshing) echo 'core|meshing' ;;
    param) echo 'core|meshing|param' ;;
    texture) echo 'core|texture' ;;
    procedural) echo 'core|texture|procedural' ;;
    haptic) echo 'core|haptic|texture' ;;
    cache) echo 'core|cache' ;;
    io) echo 'core|cache|haptic|texture|meshing|io' ;;
    study) echo 'core|study' ;;
    pipeline) echo 'core|cache|haptic|texture|meshing|io|param|procedural|study|pipeline' ;;
    apps/player) echo 'core|haptic|io' ;;
  esac
}

check_directions() {
  local folder
  for folder in "${libraries[@]}" apps/player; do
    breach_each "$folder must not include %s" < <(cpp_sources "$folder" | includes | grep ' "papilla/' |
      grep -vE " \"papilla/($(allowed_modules "$folder"))/")
  done
}

# A private header of a library is in its own src/.
check_private_headers() {
  local file name
  while read -r file name; do
    name=${name//\"/}
    [[ -e ${file%%/src/*}/src/$name || -e $(dirname "$file")/$name ]] ||
      breach "$file" "must not include \"$name\", which is no header of its library"
  done < <(cpp_sources "${libraries[@]}" | grep /src/ | includes | grep -E ' "' | grep -v ' "papilla/')
}

# Scenes in, scenes out: no command line, no console, no server; JSON in parsers only.
check_pipeline() {
  breach_each "pipeline must not include %s" < <(cpp_sources pipeline | includes | grep -E ' <(CLI/|iostream>|boost/(asio|beast))')
  breach_each "a header of pipeline must not include %s" < <(cpp_sources pipeline | grep -E '/src/.*\.hpp$' | includes |
    grep ' <nlohmann/json.hpp')
}

# Everything is written by write_atomically(), printed by print_out(), and what is printed has no names that steer a
# terminal: shown_format().
check_outputs() {
  breach_each "writes past write_atomically()" < <(cpp_sources "${libraries[@]}" apps |
    xargs -r grep -lE 'std::ofstream|[^a-z]fopen\(')
  breach_each "prints past print_out() or shown_format()" < <(cpp_sources apps | grep -v apps/standard_output.hpp |
    xargs -r grep -lE 'std::cout|fmt::print\("|(^|[^a-z])printf\(|console\.print\(fmt::')
  breach_each "formats names past shown_format()" < <(cpp_sources apps/papilla/text apps/player/report.cpp |
    xargs -r grep -lE 'fmt::format\(')
}

# What shows that a library is used: a pattern of includes, then its names in CMake and as a Debian package.
readonly library_uses='
<(thread|mutex|atomic)> Threads Threads::Threads
<nlohmann/ nlohmann_json nlohmann-json3-dev nlohmann_json::nlohmann_json
<fmt/ fmt libfmt-dev fmt::fmt
<CLI/ CLI11 libcli11-dev CLI11::CLI11
<tiny_gltf\.h> TinyGLTF libtinygltf-dev TinyGLTF::TinyGLTF
<draco/ draco libdraco-dev draco::draco
<meshoptimizer\.h> meshoptimizer libmeshoptimizer-dev meshoptimizer::meshoptimizer
<hidapi hidapi-hidraw libhidapi-dev PkgConfig::HIDAPI
<sha2\.h> libmd libmd-dev PkgConfig::MD
<openssl/ OpenSSL libssl-dev OpenSSL::Crypto
<sndfile\.h> sndfile libsndfile1-dev
<alsa/ alsa libasound2-dev
<gtest/ GTest libgtest-dev GTest::gtest_main
<benchmark/ benchmark libbenchmark-dev benchmark::benchmark
<Eigen/ Eigen3 libeigen3-dev Eigen3::Eigen
<OpenMesh/ OpenMesh libopenmesh-dev OpenMeshCore OpenMeshTools
<CGAL/ CGAL libcgal-dev
<(CGAL|Eigen)/ papilla_cgal
<(oneapi/)?tbb/ TBB libtbb-dev TBB::tbb
\.hxx> OpenCASCADE libocct-data-exchange-dev libfontconfig-dev papilla_occt
<fftw3 fftw3 libfftw3-dev PkgConfig::FFTW
<ceres/ Ceres libceres-dev Ceres::ceres
<boost/(asio|beast|math) Boost libboost-dev Boost::headers
<httplib\.h> cpp-httplib libcpp-httplib-dev PkgConfig::HTTPLIB
<websocketpp/ websocketpp libwebsocketpp-dev websocketpp::websocketpp
<assimp/ assimp libassimp-dev assimp::assimp
<OpenImageIO/ OpenImageIO libopenimageio-dev OpenImageIO::OpenImageIO
<zlib\.h> ZLIB zlib1g-dev ZLIB::ZLIB
<lcms2\.h> lcms2 liblcms2-dev PkgConfig::LCMS
<png\.h> PNG libpng-dev PNG::PNG
<pybind11/ pybind11 pybind11-dev pybind11::embed
<pybind11/numpy python3-numpy
<pybind11/pybind11 Python python3-dev
<openxr/ libopenxr-dev'

# The same of a program: a pattern of scripts and build files, then its names.
readonly program_uses='
LANGUAGES.*CXX g++
cmake cmake
Ninja ninja-build
ccache ccache
pkg_check_modules pkg-config PkgConfig
git git
help2man help2man
oiiotool openimageio-tools
gnuplot gnuplot-nox
node nodejs
npm npm ca-certificates
mkdocs mkdocs
chromium chromium
firefox firefox-esr
Xvfb xvfb
localedef locales
qemu-system qemu-system-x86
cpio cpio
cpack dpkg-dev file
blender blender
slurmctld slurmctld
slurmd slurmd
sbatch slurm-client
munged munge
snakemake snakemake
python3 python3
mcs mono-mcs
mono mono-runtime
import.yaml python3-yaml
matplotlib python3-matplotlib
setuptools python3-setuptools
pip.*wheel python3-wheel python3-pip
check_sources\.sh clang-format'

# The pattern that shows the use of name $2 by table $1.
pattern_of() { awk -v name="$2" '{ for (i = 2; i <= NF; ++i) if ($i == name) { print $1; exit } }' <<<"$1"; }

# The packages that CMake and `run` ask for: "FILE NAME" a line.
required_packages() {
  local cmake=cmake/PapillaDependencies.cmake
  if [[ -e $cmake ]]; then
    sed -nE -e 's/^[[:space:]]*find_package\(([A-Za-z0-9_]+).*/\1/p' \
      -e 's/^[[:space:]]*pkg_check_modules\(.*[[:space:]]([A-Za-z0-9_-]+)\).*/\1/p' "$cmake" | sort -u | sed "s|^|$cmake |"
  fi
  if [[ -e run ]]; then
    awk '{ sub(/#.*/, "") }
      /^readonly [a-z_]*packages=\(/ { inside = 1; sub(/^[^(]*\(/, "") }
      inside { last = /\)/; sub(/\).*/, ""); for (i = 1; i <= NF; ++i) print "run", $i; inside = !last }' run
  fi
}

# Of the includes on stdin those of the sources that a CMakeLists.txt builds: of its folder, and others that it names.
includes_of_folder() {
  local named
  named=$({ grep -oE '\$\{CMAKE_SOURCE_DIR\}/[^ )]+\.cpp' "$1" || true; } | sed 's|^[^/]*/||' | paste -sd'|')
  grep -E "^($(dirname "$1")/${named:+|($named) })"
}

# Nothing is required that no source includes or no script calls, and nothing linked that no source of the folder includes.
check_packages() {
  local file name pattern included scripts
  included=$(cpp_sources "${all_cpp[@]}" | includes || true)
  scripts=$(sources CMakeLists.txt .ci cmake page docs/make "${all_cpp[@]}" | grep -vE '/(src|include)/|/check_sources' || true)
  while read -r file name; do
    if pattern=$(pattern_of "$library_uses" "$name") && [[ -n $pattern ]]; then
      grep -qE " $pattern|$pattern\$" <<<"$included" || breach "$file" "requires $name, which no source includes"
    elif pattern=$(pattern_of "$program_uses" "$name") && [[ -n $pattern ]]; then
      { cat CMakePresets.json 2>/dev/null; sed '/^readonly [a-z_]*packages=(/,/)/d' run 2>/dev/null; xargs -r cat <<<"$scripts"; } |
        grep -E -- "$pattern" >/dev/null || breach "$file" "requires $name, which no script calls"
    else
      breach "$file" "requires $name, of which check_sources.sh does not know how its use shows"
    fi
  done < <(required_packages)

  while read -r file name; do
    pattern=$(pattern_of "$library_uses" "$name")
    [[ -n $pattern ]] || continue
    includes_of_folder "$file" <<<"$included" | grep -E "$pattern" >/dev/null ||
      breach "$file" "links $name, which no source of its folder includes"
  done < <(sources "${all_cpp[@]}" | grep '/CMakeLists\.txt$' |
    xargs -r grep -HoE '[A-Za-z0-9_]+::[A-Za-z0-9_]+|papilla_(cgal|occt)|OpenMesh(Core|Tools)' | sort -u | sed 's/:/ /')
}

check_format() {
  local file
  if ! command -v clang-format >/dev/null; then
    echo "clang-format is not installed: the format of C++ files is not checked"
    return
  fi
  while read -r file; do breach "$file" "is not formatted: clang-format -i $file"; done < <(cpp_sources "${all_cpp[@]}" |
    xargs -r clang-format --style=file --fallback-style=none --dry-run -Werror 2>&1 |
    sed -nE 's/^([^ :]+):[0-9]+:[0-9]+: error: .*/\1/p' | sort -u)
}

check_licence_lines
check_gpl_users
check_light_folders
check_public_headers
check_directions
check_private_headers
check_pipeline
check_outputs
check_packages
check_format
((breaches == 0))
