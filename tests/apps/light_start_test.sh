#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The libraries for CAD files and pictures are loaded by what needs them and by nothing else.
# usage: light_start_test.sh PAPILLA CAD_FILE FOLDER
set -u
papilla=$1 cad_file=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"

printf 'v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >solid.obj
"$papilla" repair solid.obj -o solid.stl -q || fail "no STL"
"$papilla" synthesize grain --size 32 -o grain.png -q || fail "no picture"

# Which of the two a command loads, and whether there is more than the libraries of a program without them.
loads() {
  local -r wanted=$1
  shift
  local loaded found=
  loaded=$(LD_DEBUG=files "$papilla" "$@" 2>&1 >/dev/null) || fail "$*: exit $?"
  grep -q 'calling init:.*papilla_cad\.so' <<<"$loaded" && found+=cad
  grep -q 'calling init:.*papilla_pictures\.so' <<<"$loaded" && found+=pictures
  [[ $found == "$wanted" ]] || fail "$*: loads '$found', not '$wanted'"
  [[ -n $wanted ]] || ! grep -qE 'calling init:.*/lib(TK[A-Z]|OpenImageIO|avcodec)' <<<"$loaded" ||
    fail "$*: loads a library of plug-ins"
}
loads '' --version
loads '' --help
loads '' materials list
loads '' inspect solid.stl
loads '' unwrap solid.stl -o solid.glb
loads cad inspect "$cad_file"
loads pictures analyze grain.png

# Without them the rest works, and what needs them says what is missing.
mkdir -p alone/bin
cp "$papilla" alone/bin/papilla
alone/bin/papilla inspect solid.stl >/dev/null || fail "inspect without plug-ins: exit $?"
alone/bin/papilla inspect "$cad_file" >out.txt 2>err.txt
code=$?
((code == 3)) && grep -q 'papilla_cad\.so: cannot be loaded' err.txt && (($(wc -l <err.txt) == 1)) ||
  fail "a CAD file without its plug-in: exit $code, $(cat err.txt)"
finish "light start"
