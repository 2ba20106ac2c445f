#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Rubbish in, one line and the right exit code out: bad_input_test.sh PAPILLA PLAYER FOLDER
set -u
papilla=$1 player=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"
mkdir "a folder.stl"

# expect CODE PATTERN COMMAND...: the exit code, exactly one line on stderr, and that line matches.
expect() {
  local code=$1 pattern=$2 got lines
  shift 2
  "$@" >out.txt 2>err.txt </dev/null
  got=$?
  lines=$(wc -l <err.txt)
  if [[ $got != "$code" || ($code == 3 && $lines != 1) ]] || ! grep -qE -- "$pattern" err.txt; then
    fail "$* -> exit $got (expected $code), stderr: $(cat err.txt)"
  fi
}

: >empty.stl; : >empty.glb; : >empty.step; : >empty.png; : >empty.obj
printf 'solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0' >truncated.stl
{ head -c 80 /dev/zero; printf '\xff\xff\xff\xff'; head -c 16 /dev/zero; } >huge.stl
head -c 300 /dev/urandom >random.glb; cp random.glb random.step; cp random.glb random.png; cp random.glb random.stl
printf 'ISO-10303-21;\nHEADER;\n' >truncated.step
printf '{"materials": {"g": {"texture": "random.png", "size_mm": [40, 40]}}, "assign": [{"part": "*", "material": "g"}]}' >grain.json
printf '{"materials": {"g": {"stiffness": "hard"}}}' >wrong.json
printf '{' >broken.json
cat >one.obj <<'OBJ'
v 0 0 0
v 10 0 0
v 0 10 0
f 1 2 3
OBJ

for file in missing.stl "a folder.stl" empty.stl truncated.stl huge.stl random.stl empty.glb random.glb missing.step empty.step \
            random.step truncated.step empty.obj one.xyz; do
  expect 3 "papilla: error: .*${file}" "$papilla" inspect "$file"
done
for file in missing.png empty.png random.png "a folder.stl"; do
  expect 3 "papilla: error: .*${file}" "$papilla" analyze "$file"
  expect 3 "papilla: error: .*${file}" "$papilla" height "$file" -o out.png
done
expect 3 'random.png' "$papilla" bake one.obj -m grain.json -o out.glb --report report
[[ ! -e report ]] || fail "a bake that ended with an error left its report's folder"
expect 3 'wrong.json: at /materials/g/stiffness' "$papilla" bake one.obj -m wrong.json -o out.glb
expect 3 'broken.json' "$papilla" plan one.obj -m broken.json
expect 3 'no/such' "$papilla" synthesize grain --kind leather --size 32 -o no/such/folder.png
expect 2 'out.obj' "$papilla" bake one.obj -m grain.json -o out.obj
for point in 1,2 1,2,3,4 nan,0,0 inf,0,0 1e999,0,0 x,y,z; do
  expect 2 '--inside' "$papilla" inspect one.obj --inside "$point"
  expect 2 '--inside' "$papilla" repair one.obj -o out.obj --inside "$point"
done
expect 2 '--inside' "$papilla" unwrap one.obj -o out.obj --inside 0,0,nan
expect 2 '--inside' "$papilla" bake one.obj -m grain.json -o out.glb --inside 0,0,-inf
expect 2 '--keep-sides' "$papilla" repair one.obj -o out.obj --inside 0,0,0 --keep-sides
expect 2 '' "$papilla" bake
expect 2 '' "$papilla" frobnicate
expect 2 "unknown option '--no-such-option'" "$papilla" inspect --no-such-option=red one.obj
expect 2 "unexpected word 'b=c.stl'" "$papilla" inspect one.obj b=c.stl
expect 2 '^papilla: error: --materials is required' "$papilla" bake -o out.glb -- one.obj
expect 2 'tolerance' "$papilla" simplify one.obj --tolerance nan -o out.obj
for file in missing.glb empty.glb random.glb one.obj; do
  expect 3 "$file" "$player" "$file" --device sim --seconds 0.1
done
expect 3 'random.stl' "$papilla" evaluate weld random.stl -o evaluated
[[ ! -e evaluated ]] || fail "an evaluation that ended with an error left its folder"
[[ ! -e out.glb ]] || fail "a bake that ended with an error left out.glb"
find . -name '.papilla-*' | grep . && fail "temporary files are left"
finish "bad input"
