#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Names with control characters can neither steer the terminal nor fake a line: whatever a verb prints of them, on
# stdout, stderr and in reports, is escaped. usage: shown_names_test.sh PAPILLA PLAYER FOLDER
set -u
papilla=$1 player=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"
seen=0

# A title for the window, a line of its own, a carriage return, a right-to-left override, CSI as one character.
evil=$'e\x1b]0;x\x07v\nfaked: line\rz\u202e\u009b2Jl'
json=$(printf '%s' "$evil" | sed ':a;N;$!ba;s/\n/\\n/g;s/\x1b/\\u001b/g;s/\x07/\\u0007/g;s/\r/\\r/g')

# clean FILE: no control character but line feeds, no mark of direction, no line that a name began.
clean() {
  # Lines of CSV end in CR LF.
  if sed 's/\r$//' "$1" | LC_ALL=C grep -qP '[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\xa8-\xae]|\xe2\x81[\xa6-\xa9]|\xd8\x9c' ||
    grep -q '^faked' "$1"; then
    fail "$2: $(head -c 2000 "$1" | cat -v)"
  fi
  ! grep -qF '\u001b]0;x' "$1" || seen=$((seen + 1))
}

# shows CODE COMMAND...: the exit code, and everything printed is clean.
shows() {
  local code=$1 got file
  shift
  rm -rf out && mkdir out
  "$@" >out.txt 2>err.txt </dev/null
  got=$?
  [[ $got == "$code" ]] || fail "exit $got, not $code: $(cat -v err.txt)"
  clean out.txt "$*" && clean err.txt "$*"
  while IFS= read -r -d '' file; do clean "$file" "$* ($file)"; done < <(find out -name '*.json' -print0 -o -name '*.csv' -print0)
}

points='AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'
printf '{"asset":{"version":"2.0","copyright":"%s"},"extensionsUsed":["%s"],"buffers":[{"byteLength":36,
  "uri":"data:application/octet-stream;base64,%s"}],"bufferViews":[{"buffer":0,"byteLength":36}],
  "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
  "meshes":[{"name":"%s","primitives":[{"attributes":{"POSITION":0},"material":0}],"extensions":{"%s":{}}}],
  "nodes":[{"mesh":0,"name":"%s"}],"scenes":[{"nodes":[0]}],"images":[{"uri":"%s.png","name":"%s"}],
  "textures":[{"source":0,"name":"%s"}],"materials":[{"name":"%s","pbrMetallicRoughness":
  {"baseColorTexture":{"index":0}},"extras":{"haptic":{"version":1,"stiffness":1e9,"staticFriction":-1,
  "height":{"image":"%s","sha256":"00","scale":1e-4,"metresPerUV":[1,1]}}}}]}' \
  "$json" "$json" "$points" "$json" "$json" "$json" "${json//]/_}" "$json" "$json" "$json" "$json" >"a $evil.gltf"
file="a $evil.gltf"
printf '{"materials": {"m": {"stiffness": 300}}, "assign": [{"part": "*", "material": "m"}]}' >rules.json
printf '{"materials": {"%s": {"stiffness": "x"}}}' "$json" >wrong.json
printf '{"layers": [{"recipe": "noise", "materials": ["*"]}], "size": 16}' >config.json

shows 0 "$papilla" inspect "$file" --picture "out/p $evil.png" --json out/a.json --reach 0,0,0,10000
shows 0 "$papilla" inspect "$file" --json -
shows 0 "$papilla" repair "$file" -o "out/a $evil.glb" --json out/a.json
shows 0 "$papilla" simplify "$file" --ratio 1 -o out/a.glb --json -
shows 0 "$papilla" unwrap "$file" -o out/a.glb --json -
shows 0 "$papilla" unwrap "$file" -o out/a.glb --trace out/t.csv --json out/a.json
cp out/a.glb uv.glb
shows 0 "$papilla" measure uv.glb --csv out/m.csv --json out/a.json
shows 0 "$papilla" plan "$file" -m rules.json --json out/a.json
shows 0 "$papilla" bake "$file" -m rules.json -o "out/b $evil.glb" --report "out/r $evil"
shows 0 "$papilla" view "$file" -o "out/v $evil.html" --no-open
shows 0 "$papilla" weather uv.glb -c config.json -o "out/w $evil.glb" --json out/a.json
shows 0 "$papilla" synthesize grain --kind leather --size 32 -o "out/g $evil.png"
cp "out/g $evil.png" "g $evil.png"
shows 0 "$papilla" analyze "g $evil.png" --only class --json out/a.json
shows 0 "$papilla" height "g $evil.png" -o "out/h $evil.png"
shows 0 "$papilla" prepare "g $evil.png" -o "out/h $evil.png"
shows 0 "$papilla" evaluate weld "$file" -o "out/e $evil"
shows 3 "$papilla" plan "$file" -m wrong.json
shows 3 "$papilla" inspect "missing $evil.glb"
shows 3 "$papilla" texture "no $evil" -o out
shows 2 "$papilla" inspect "$file" --nothing "$evil"
shows 2 "$papilla" inspect "$file" --json "$file"
shows 0 "$player" "$file" --seconds 0.05 --json out/a.json
shows 0 "$player" "$file" --seconds 0.05 --json -
shows 3 "$player" "missing $evil.glb"
shows 2 "$player" "$file" --motion "$evil"

# The names themselves stay as they are in what is written.
grep -q "$(printf '\\\\u001b]0;x')" <(strings -n 4 "uv.glb") || fail "a name was changed on its way"
((seen >= 20)) || fail "the names were printed in $seen places only"
finish "$seen places show names"
