#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that a program links nothing but what a compact player may link, neither shared nor static.
# usage: check_player_links.sh PROGRAM
set -euo pipefail
program=$1
export LC_ALL=C

readonly allowed='^(lib(c|m|gcc_s|stdc\+\+|md|hidapi-hidraw|tinygltf|draco|meshoptimizer|fmt|asan|ubsan)\.so|ld-linux)'
readonly heavy_symbols='(^|[^A-Za-z_])(CGAL|ceres|OpenMesh|OpenImageIO_v[0-9_]+|OpenImageIO|Eigen|tbb|opencascade|TopoDS_[A-Za-z]+)::|[ _]fftwf?_'

needed=$(readelf -d "$program" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
[[ -n $needed ]] || { echo "$program: no dynamic section that readelf can read"; exit 1; }
symbols=$(nm -C "$program")
[[ -n $symbols ]] || { echo "$program: is stripped, its symbols can't be checked"; exit 1; }

# Debian's libdraco exports another version of tinygltf: the loader must find ours first.
order=$(grep -nE '^lib(tinygltf|draco)\.so' <<<"$needed" | sed -E 's/.*lib([a-z]+)\.so.*/\1/' | xargs)
[[ $order != draco* ]] || { echo "$program: links libdraco before libtinygltf"; exit 1; }

breaches=$(
  grep -vE "$allowed" <<<"$needed" | sed 's/^/links the shared library /'
  grep -E "$heavy_symbols" <<<"$symbols" | head -n 5 | sed 's/^/holds the symbol /'
) || true
[[ -z $breaches ]] || { sed "s|^|$program: |" <<<"$breaches"; exit 1; }
