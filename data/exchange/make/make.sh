#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the files of data/exchange again: parts of data/cockpit.step as OpenCASCADE's DRAW and Blender write them.
# usage: make.sh     Needs Debian's packages occt-draw, libocct-draw-dev, blender and python3-numpy.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
find "$here/.." -maxdepth 1 -type f ! -name README.md -delete
COCKPIT=$here/../../cockpit.step OUT=$here/.. WORK=$work occt-draw -b -f "$here/make.tcl"
OUT=$here/.. WORK=$work blender --background --factory-startup --python-exit-code 1 --python "$here/make.py"
