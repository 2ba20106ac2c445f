#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# No output of any verb is written over an input or another output: exit code 2 before anything is written.
# usage: own_files_test.sh PAPILLA PLAYER FOLDER
set -u
papilla=$1 player=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"
cases=0

state() { find . -not -name 'err.txt' -type f -print0 | sort -z | xargs -0 sha256sum; }

# refused OPTION COMMAND...: exit code 2, one line that names the option, and nothing has changed.
refused() {
  local before
  before=$(state)
  refused_late "$@"
  [[ $(state) == "$before" ]] || fail "files changed: ${*:2}"
}

# refused_late FILE COMMAND...: the same where the name is found out during the work; FILE has not changed.
refused_late() {
  local option=$1 got before=
  shift
  cases=$((cases + 1))
  [[ ! -f $option ]] || before=$(sha256sum "$option")
  "$@" >/dev/null 2>err.txt </dev/null
  got=$?
  if [[ $got != 2 || $(wc -l <err.txt) != 1 ]] || ! grep -qE -- "^papilla(-player)?: error: .*(written over|is the same file)" err.txt ||
    ! grep -qF -- "$option" err.txt; then
    fail "exit $got: $*: $(cat err.txt)"
  fi
  [[ ! -f $option || $(sha256sum "$option") == "$before" ]] || fail "$option was written over: $*"
}

printf 'mtllib one.mtl\nv 0 0 0\nv 10 0 0\nv 0 10 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl g\nf 1/1 2/2 3/3\n' >one.obj
printf 'newmtl g\nmap_Kd map.png\n' >one.mtl
"$papilla" synthesize grain --kind leather --size 32 -o map.png -q || fail "no picture"
cp map.png grain.png && cp map.png picture.png
"$papilla" repair one.obj -o scene.glb -q || fail "no scene"
printf '{"materials": {"g": {"texture": "grain.png", "size_mm": [40, 40], "stiffness": 300}}, "assign": [{"part": "*", "material": "g"}]}' >rules.json
printf '{"layers": [{"recipe": "dots"}], "libraries": ["lib.recipes"], "size": 16, "time": [0, 1]}' >config.json
printf 'dots image|picpath=picture.png\n' >lib.recipes
printf '{"command": ["papilla", "inspect", "one.obj"]}\n' >lines.jsonl
printf '{"centre": [0, 0, 0], "radius": 100}' >volume.json
printf 't,x,y,z\n0,0,0,0.01\n0.01,0,0,0.01\n' >hand.csv
"$papilla" bake scene.glb -m rules.json -o tagged.glb -q || fail "nothing baked"
printf 'ISO-10303-21;\n' >part.step
printf '{}' >own.json
printf 't,x,y,z,force_x,force_y,force_z\n0,0,0,0,0,0,0\n1,0,0,0,0,0,1\n' >stroke.csv
"$papilla" split scene.glb -m rules.json -o jobs -q || fail "no jobs"
"$papilla" bake --job jobs/"$(ls jobs/inputs)" -q || fail "no job"
printf '{}' >study.json && printf 'study\n' >answers.csv

# What each verb reads and writes: VERB | arguments | inputs among them | option of each output.
table='inspect    | one.obj --reach volume.json --view volume2.json  | one.obj volume.json volume2.json | --picture --json
tessellate | part.step                                       | part.step                        | --output --json
repair     | one.obj                                         | one.obj                          | --output --json
simplify   | one.obj --ratio 1 --reach volume.json --view volume2.json | one.obj volume.json volume2.json | --output --json
unwrap     | one.obj                                         | one.obj                          | --output --trace --picture --json
measure    | one.obj                                         | one.obj                          | --picture --colored --csv --json
analyze    | grain.png                                       | grain.png                        | --json
prepare    | grain.png                                       | grain.png                        | --output --json
synthesize | fractal --like grain.png --size 32              | grain.png                        | --output --relief --json
height     | grain.png                                       | grain.png                        | --output --normal --json
texture    | dots --library lib.recipes -o made --size 8     | lib.recipes                      | --json --glsl --wgsl
weather    | scene.glb -c config.json                        | scene.glb config.json            | --output --json
fit        | stroke.csv                                      | stroke.csv                       | --output --picture --json
plan       | scene.glb -m rules.json --reach volume.json --view volume2.json | scene.glb rules.json volume.json volume2.json | --json
bake       | scene.glb -m rules.json --library lib.recipes --reach volume.json --view volume2.json | scene.glb rules.json lib.recipes volume.json volume2.json | --output --json
split      | scene.glb -m rules.json --library lib.recipes -o made | scene.glb rules.json lib.recipes | --json
batch      | lines.jsonl                                     | lines.jsonl                      | --json
merge      | jobs                                            | jobs/bake.json jobs/manifest.jsonl scene.glb | --output --json
demo       | -o made                                         |                                  | --json
cache      | stats                                           |                                  | --json
materials  | check own.json                                  | own.json                         | --output --picture --json
study      | analyse study.json answers.csv                  | study.json answers.csv           | --output --answers --json
studio     | scene.glb -m rules.json --library lib.recipes --reach volume.json --view volume2.json --no-open | scene.glb rules.json lib.recipes volume.json volume2.json | --json
view       | scene.glb --tags scene2.glb --no-open           | scene.glb scene2.glb             | --output --json
evaluate   | param one.obj  -o made                          | one.obj                          | --json'
cp volume.json volume2.json
cp scene.glb scene2.glb

while IFS='|' read -r verb arguments inputs outputs; do
  read -ra arguments <<<"$arguments"
  read -ra inputs <<<"$inputs"
  read -ra outputs <<<"$outputs"
  verb=${verb// /}
  for output in "${outputs[@]}"; do
    rest=()  # What the verb can't do without.
    [[ $output != --output && " ${outputs[*]} " == *' --output '* ]] && rest=(--output out.glb)
    for input in "${inputs[@]}"; do
      refused "$output" "$papilla" "$verb" "${arguments[@]}" "${rest[@]}" "$output" "$input"
    done
    [[ $output == --json ]] && continue
    refused --json "$papilla" "$verb" "${arguments[@]}" "${rest[@]}" "$output" same.out --json ./same.out
  done
  ((${#inputs[@]})) || continue
  # The same file under another name.
  ln -f "${inputs[0]}" hard.link
  ln -sf "${inputs[0]}" soft.link
  for link in hard.link soft.link "../${folder##*/}/${inputs[0]}"; do
    refused --json "$papilla" "$verb" "${arguments[@]}" "${rest[@]}" --json "$link"
  done
  rm -f hard.link soft.link
done <<<"$table"

# Every verb and every option that names a file to write is in the table.
while read -r verb; do
  row=$(grep -E "^$verb " <<<"$table") || { fail "the verb $verb is not tried"; continue; }
  while read -r option; do
    grep -qE -- " $option( |\$)" <<<"${row##*|}" || fail "the output $option of $verb is not tried"
  done < <("$papilla" "$verb" --help | sed -nE 's/^  (-[A-Za-z],)?(--[a-z-]+) (FILE|FILE\|-|OUT|PNG|HTML|[A-Z]\.csv)( .*| *)$/\2/p' |
    grep -vE '^--(library|materials|layers|like|tags)$')
done < <("$papilla" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/\1/p')

# Files of folders, and files that other files name.
refused --json "$papilla" bake scene.glb -m rules.json -o out.glb --report made --json made/report.json
refused --json "$papilla" weather scene.glb -c config.json -o out.glb --report made --json made/index.html
refused --json "$papilla" analyze grain.png --pictures made --json made/symmetry.png
refused --json "$papilla" height grain.png -o height.png --pictures made --json made/relief.png
refused --json "$papilla" repair one.obj -o out.glb --json one.mtl
refused --json "$papilla" repair one.obj -o out.glb --json map.png
refused --json "$papilla" bake scene.glb -m rules.json -o out.glb --json grain.png
refused --json "$papilla" weather scene.glb -c config.json -o out.glb --json lib.recipes
refused --json "$papilla" weather scene.glb -c config.json -o out.glb --json picture.png

# Names that a verb makes up itself.
cp one.obj old.obj && printf 'newmtl g\n' >new.mtl && sed -i 's/one.mtl/new.mtl/' old.obj
refused_late new.mtl "$papilla" repair old.obj -o new.obj
cp grain.png h-opposite.png
refused_late h-opposite.png "$papilla" height h-opposite.png -o h.png --alternative
mkdir wood && cp grain.png wood/color.png
refused_late wood/color.png "$papilla" texture 'image|picpath=wood/color.png' -o wood --size 8 --channels color
cp scene.glb s.0000.glb
refused_late s.0000.glb "$papilla" weather s.0000.glb -c config.json -o s.glb

for output in --record --json; do
  for input in tagged.glb hand.csv; do
    refused "$output" "$player" tagged.glb --trajectory hand.csv "$output" "$input"
  done
done
refused --json "$player" tagged.glb --record same.csv --json same.csv
refused --json "$player" tagged.glb --live same.sock --json same.sock
refused --vibration "$player" tagged.glb --record same.wav --vibration same.wav

# What is no file may be named as often as one likes, and results may be written again.
for _ in 1 2; do
  "$papilla" measure one.obj --csv /dev/null --json /dev/null --picture one.png -q || fail "devices are no files"
done
finish "$cases cases"
