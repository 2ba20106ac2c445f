#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What runs until it is stopped ends at --time-limit, too, which --timeout is another name of.
# usage: time_limit_test.sh PAPILLA FOLDER
set -u
papilla=$1
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$2"

printf 'mtllib one.mtl\nv 0 0 0\nv 10 0 0\nv 0 10 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl g\nf 1/1 2/2 3/3\n' >one.obj
printf 'newmtl g\n' >one.mtl
printf '{"layers": [{"recipe": "dust"}], "size": 16}' >config.json

# ends COMMAND...: with exit code 0; 124 is that of `timeout`, long after the limit.
ends() { timeout 120 "$@" >out.txt 2>&1 </dev/null || fail "exit $?: $*: $(cat out.txt)"; }

ends "$papilla" weather one.obj -c config.json -o old.glb --live --no-open --timeout 5
[[ -s old.glb ]] || fail "weather --live wrote nothing"
ends "$papilla" view one.obj --follow no.sock --no-open --time-limit 5
grep -q '^following the player at' out.txt || fail "view --follow: $(cat out.txt)"

"$papilla" weather one.obj -c config.json -o none.glb --live --no-open --timeout 0 2>err.txt >out.txt
[[ $? == 4 ]] || fail "not cancelled: $(cat err.txt)"
[[ ! -e none.glb ]] || fail "a cancelled build wrote its output"
awk 'BEGIN { for (y = 0; y < 15; ++y) for (x = 0; x < 15; ++x) print "v", x, y, (x * y) % 3
  for (y = 0; y < 14; ++y) for (x = 1; x < 15; ++x) { a = 15 * y + x; print "f", a, a + 1, a + 16; print "f", a, a + 16, a + 15 } }' >grid.obj
# Reading that takes longer than the limit still leads to a result.
printf '{"materials": {"g": {"texture": "leather", "size_mm": [40, 40]}}, "assign": [{"part": "*", "material": "g"}]}' \
  >materials.json
for verb in unwrap "bake -m materials.json" repair "simplify --ratio 0.5" "simplify --budget 1"; do
  rm -f at-once.glb
  # shellcheck disable=SC2086
  "$papilla" $verb grid.obj -o at-once.glb --time-limit 0 --json out.json >out.txt 2>err.txt || fail "$verb: $(cat err.txt)"
  [[ -s at-once.glb ]] || fail "$verb wrote nothing"
  grep -q '"stop": "time_limit"' out.json || fail "$verb: $(cat out.json)"
  grep -q "ended by the time limit" out.txt || fail "$verb: $(cat out.txt)"
done
for verb in repair "simplify --ratio 0.5"; do
  # shellcheck disable=SC2086
  "$papilla" $verb one.obj -o done.glb --time-limit 100 --json out.json >out.txt 2>err.txt || fail "$verb: $(cat err.txt)"
  grep -q '"stop": "converged"' out.json || fail "$verb: $(cat out.json)"
  grep -q "ended by the time limit" out.txt && fail "$verb: $(cat out.txt)"
done
finish "time limits"
