#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks what the compiler can't: licence lines and who may include whom. Prints one line per breach, exits 1 if any.
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
    -o -name run \) -print | sort
}
cpp_sources() { sources "$@" | grep -E '\.([ch]pp|h|c)$' || true; }

# What a file includes, one name a line, with its brackets.
includes() { sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*\([<"][^">]*[">]\).*/\1/p' "$1"; }

readonly gpl_headers='^<(CGAL/|fftw3)'
readonly heavy_headers='^[<"](CGAL/|OpenMesh/|OpenImageIO/|Eigen/|ceres/|fftw3|oneapi/tbb|tbb/|[A-Za-z0-9_]+\.hxx)'

check_licence_lines() {
  local file line
  while read -r file; do
    line=$(head -n 3 "$file" | grep -oE 'SPDX-License-Identifier: [^ ]+' | head -n 1) || true
    case ${line#SPDX-License-Identifier: } in
      MIT)
        if [[ $file == apps/papilla/* ]]; then
          breach "$file" "apps/papilla is GPL-3.0-or-later, the file says MIT"
        elif includes "$file" | grep -qE "$gpl_headers"; then
          breach "$file" "includes a GPL library, but says MIT"
        fi ;;
      GPL-3.0-or-later)
        if [[ $file =~ ^(core|haptic|io/gltf|apps/player)/ ]]; then
          breach "$file" "this folder is MIT, the file says GPL-3.0-or-later"
        fi ;;
      '') breach "$file" "has no SPDX-License-Identifier in its first three lines" ;;
      *) breach "$file" "unknown licence: $line" ;;
    esac
  done < <(sources run .ci CMakeLists.txt cmake core haptic io meshing param texture apps tests data)
}

# The player and everything it links: no library but hidapi, tinygltf, and small ones for JSON and the command line.
check_light_folders() {
  local file name
  while read -r file; do
    while read -r name; do
      breach "$file" "the player side must not include $name"
    done < <(includes "$file" | grep -E "$heavy_headers")
  done < <(cpp_sources core haptic io/gltf apps/player)
}

# Public headers: the standard library and papilla only, so that no user needs our libraries to compile.
check_public_headers() {
  local file name
  while read -r file; do
    while read -r name; do
      breach "$file" "a public header must not include $name"
    done < <(includes "$file" | grep -vE '^(<[a-z0-9_]+>|"papilla/.*")$')
  done < <(cpp_sources core haptic io meshing param texture | grep /include/)
}

# Which folders the files of a folder may include.
allowed_modules() {
  case $1 in
    core) echo core ;;
    meshing) echo 'core|meshing' ;;
    param) echo 'core|meshing|param' ;;
    texture) echo 'core|texture' ;;
    haptic) echo 'core|haptic|texture' ;;
    io) echo 'core|haptic|texture|meshing|io' ;;
  esac
}

check_directions() {
  local folder file name allowed
  for folder in core meshing param texture haptic io; do
    allowed=$(allowed_modules "$folder")
    while read -r file; do
      while read -r name; do
        breach "$file" "$folder must not include $name"
      done < <(includes "$file" | grep '^"papilla/' | grep -vE "^\"papilla/($allowed)/")
    done < <(cpp_sources "$folder")
  done
}

check_licence_lines
check_light_folders
check_public_headers
check_directions
((breaches == 0))
