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

ends "$papilla" weather one.obj -c config.json -o old.glb --live --timeout 5
[[ -s old.glb ]] || fail "weather --live wrote nothing"
ends "$papilla" view one.obj --follow no.sock --no-open --time-limit 5
grep -q '^following the player at' out.txt || fail "view --follow: $(cat out.txt)"

"$papilla" weather one.obj -c config.json -o none.glb --live --timeout 0 2>err.txt >out.txt
[[ $? == 4 ]] || fail "not cancelled: $(cat err.txt)"
[[ ! -e none.glb ]] || fail "a cancelled build wrote its output"
finish "time limits"
