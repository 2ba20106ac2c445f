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

readonly gpl_headers=' <(CGAL/|fftw3)'
readonly heavy_headers=' [<"](CGAL/|OpenMesh/|OpenImageIO/|Eigen/|ceres/|fftw3|oneapi/tbb|tbb/|[A-Za-z0-9_]+\.hxx)'

check_licence_lines() {
  local file licence
  while read -r file licence; do
    case $licence in
      MIT)
        if [[ $file == apps/papilla/* ]]; then breach "$file" "apps/papilla is GPL-3.0-or-later, the file says MIT"; fi ;;
      GPL-3.0-or-later)
        if [[ $file =~ ^(core|haptic|io/gltf|io/haptic|apps/player)/ ]]; then
          breach "$file" "this folder is MIT, the file says GPL-3.0-or-later"
        fi ;;
      '') breach "$file" "has no SPDX-License-Identifier in its first three lines" ;;
      *) breach "$file" "unknown licence: $licence" ;;
    esac
  done < <(sources run .ci CMakeLists.txt cmake core haptic io meshing param texture apps page tests data | licences)
}

check_gpl_users() {
  local all
  all=$(cpp_sources core haptic io meshing param texture apps tests data)
  breach_each "includes %s, which is GPL, but says MIT" < <(licences <<<"$all" | awk '$2 == "MIT" {print $1}' | includes |
    grep -E "$gpl_headers")
}

# The player and everything it links: no library but hidapi, tinygltf, and small ones for JSON and the command line.
check_light_folders() {
  breach_each "the player side must not include %s" < <(cpp_sources core haptic io/gltf io/haptic apps/player | includes |
    grep -E "$heavy_headers")
}

# Public headers: the standard library and papilla only, so that no user needs our libraries to compile.
check_public_headers() {
  breach_each "a public header must not include %s" < <(cpp_sources core haptic io meshing param texture |
    grep /include/ | includes | grep -vE ' (<[a-z0-9_]+>|"papilla/.*")$')
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
  local folder
  for folder in core meshing param texture haptic io; do
    breach_each "$folder must not include %s" < <(cpp_sources "$folder" | includes | grep ' "papilla/' |
      grep -vE " \"papilla/($(allowed_modules "$folder"))/")
  done
}

check_licence_lines
check_gpl_users
check_light_folders
check_public_headers
check_directions
((breaches == 0))
