#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# papilla batch: many inputs, manifests, what is skipped, what is refused, how it ends.
# usage: batch_test.sh PAPILLA DATA FOLDER
set -u
papilla=$1 data=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"

has() { grep -qE -- "$2" "$1" || fail "no '$2' in $1: $(cat "$1")"; }
no_temporaries() { [[ -z $(find . -name '.papilla-*') ]] || fail "temporary files are left: $(find . -name '.papilla-*')"; }

mkdir in in/more
cp "$data/exchange/slider.stl" in/one.stl
cp "$data/exchange/slider.stl" 'in/the other.stl'
cp "$data/exchange/slider.stl" in/more/one.stl

# A verb for many inputs.
code 0 '' "$papilla" batch repair in/*.stl --json result.json -- -o 'out/{stem}.glb' --json 'json/{name}.json'
for name in one 'the other'; do
  "$papilla" repair "in/$name.stl" -o direct.glb -q
  cmp -s "out/$name.glb" direct.glb || fail "$name is another file than without batch"
  [[ -s json/$name.stl.json ]] || fail "no JSON of $name"
done
has out.txt '^done .*repair in/one.stl -o out/one.glb'
has out.txt '^2 lines in .*: 2 done$'
has result.json '"exit_code": 0'
has result.json '"place": "in/the other.stl"'
code 0 '' "$papilla" batch repair in/one.stl in/more/one.stl -q -- -o '{folder}/made/{stem}.ply'
[[ -s in/made/one.ply && -s in/more/made/one.ply && ! -s out.txt ]] || fail "{folder}: $(cat out.txt)"
code 2 "out/\{sten\}.glb': \{sten\} is none of .*; did you mean '\{stem\}'" "$papilla" batch repair in/*.stl -- -o 'out/{sten}.glb'
code 2 'batch repair: no input is named' "$papilla" batch repair -- -o 'out/{stem}.glb'
code 2 "in/one.stl: repair: unknown option '--wild'; did you mean '--weld'" "$papilla" batch repair in/*.stl -- -o 'x{stem}.glb' --wild 1
code 2 "batch: unknown option '-o'; options of the verb that runs for each input go behind --" "$papilla" batch repair in/one.stl -o one.glb
code 2 "in/one.stl: --output is required" "$papilla" batch repair in/*.stl
code 2 "'in/one.stl' is no verb, and a manifest goes alone" "$papilla" batch in/one.stl in/more/one.stl

# What is there is skipped, unless it is older than what it is made from.
run=("$papilla" batch repair in/*.stl --skip-existing --json result.json -- -o 'out/{stem}.glb')
code 0 '' "${run[@]}"
has out.txt ': 2 skipped$'
has result.json '"skipped": 2'
touch -d '1 hour ago' out/one.glb
code 0 '' "${run[@]}"
has out.txt '^done .* -o out/one.glb'
has out.txt ': 1 done, 1 skipped$'
rm 'out/the other.glb'
code 0 '' "${run[@]}"
has out.txt '^done .*in/the other.stl'
code 0 '' "$papilla" batch inspect in/*.stl --skip-existing
has out.txt ': 2 done$'  # Nothing is written: there is nothing to be there.

# The jobs of a split bake, longest first; all together are the whole bake.
cat >rules.json <<'JSON'
{"materials": {"cap": {"texture": "grain:leather", "size_mm": [30, 20], "stiffness": 600},
               "column": {"texture": "wood", "size_mm": [60, 40], "stiffness": 900}},
 "assign": [{"part": "knob_cap", "material": "cap"}, {"part": "steering_column", "material": "column"}]}
JSON
scene=$data/exchange/knobs.step
"$papilla" bake "$scene" -m rules.json -o whole.glb --effort fast -q || fail "no bake"
"$papilla" split "$scene" -m rules.json -o jobs --effort fast -q || fail "no jobs"
code 0 '' "$papilla" batch jobs/manifest.jsonl --jobs 1 --json result.json
has out.txt '^2 lines in .*: 2 done$'
has result.json '"id": ".*knob_cap"'
longest=$(sed -E 's/.*"id": ?"([^"]*)".*"cost_seconds": ?([0-9.e+-]*).*/\2 \1/' jobs/manifest.jsonl | sort -rg | head -n 1 | cut -d' ' -f2)
[[ $(head -n 1 out.txt) == *"$longest" ]] || fail "$longest is the longest and not first: $(cat out.txt)"
"$papilla" merge jobs -o merged.glb -q || fail "no merge"
cmp -s whole.glb merged.glb || fail "merged is another file than the whole"

# Lines that are none: named before anything begins.
cp in/one.stl line.stl
good='{"command": ["papilla", "repair", "line.stl", "-o", "line.glb"]}'
rubbish() {
  printf '%s\n\n%s\n' "$good" "$1" >lines.jsonl
  code 3 "^papilla: error: lines.jsonl: line 3: $2" "$papilla" batch lines.jsonl
  [[ ! -e line.glb ]] || fail "a line has run before $1"
}
rubbish '{"command": ' 'byte 13 is no JSON'
rubbish '["papilla"]' 'must be an object'
rubbish '{"comand": []}' 'has no "command"'
rubbish '{"command": "papilla inspect x"}' '"command" must be a list of texts'
rubbish '{"command": ["papilla"]}' '"command" must be a list of texts'
rubbish '{"command": ["papilla", "inspect", 1]}' '"command" must be a list of texts'
rubbish '{"command": ["rm", "-r", "x"]}' "\"command\" begins with 'rm' instead of 'papilla'"
rubbish '{"command": ["papilla", "inspect", "a\u0000b"]}' '"command": a text has the character 0'
rubbish '{"command": ["papilla", "inspct", "x"]}' "unknown verb 'inspct'; did you mean 'inspect'"
rubbish '{"command": ["papilla", "inspect", "x", "--bogus"]}' "inspect: unknown option '--bogus'"
rubbish '{"command": ["papilla", "inspect", "x", "--chord", "0"]}' '--chord: 0 is not from'
rubbish '{"command": ["papilla", "batch", "lines.jsonl"]}' "a batch can't run another one"
rubbish '{"command": ["papilla", "repair", "--help"]}' 'asks for help and does nothing'
rubbish '{"command": ["papilla", "inspect", "x", "--config", "no.json"]}' 'no.json: does not exist'
rubbish '{"command": ["papilla", "inspect", "x"], "id": 3}' '"id" must be a text'
rubbish '{"command": ["papilla", "inspect", "x"], "cost_seconds": -1}' '"cost_seconds" must be 0 or more'
code 3 'no.jsonl: does not exist' "$papilla" batch no.jsonl
: >lines.jsonl
code 0 '' "$papilla" batch lines.jsonl
has out.txt '^0 lines'

# One file, two lines.
two() {
  printf '%s\n%s\n' "$1" "$2" >lines.jsonl
  code 2 "$3" "$papilla" batch lines.jsonl
  [[ ! -e line.glb ]] || fail "a line has run before one is refused"
}
two "$good" '{"command": ["papilla", "repair", "in/one.stl", "-o", "./out/../line.glb"]}' \
  'line 2: ./out/../line.glb is the same file as line.glb of lines.jsonl: line 1, which is written too'
two '{"command": ["papilla", "inspect", "line.glb"]}' "$good" 'line 2: line.glb: would be written over line.glb of lines.jsonl: line 1, which is read'
echo '{"output": "line.glb"}' >options.json
two "$good" '{"command": ["papilla", "repair", "in/one.stl", "--config", "options.json"]}' 'is the same file as line.glb'
two '{"command": ["papilla", "texture", "wood", "-o", "made"]}' '{"command": ["papilla", "texture", "dust", "-o", "./made"]}' \
  'line 2: ./made is the same file as made'
code 2 'in/more/one.stl: out/one.glb is the same file as out/one.glb of in/one.stl' \
  "$papilla" batch repair in/one.stl in/more/one.stl -- -o 'out/{stem}.glb'

# A line that fails.
printf 'solid x\n' >bad.stl
printf '%s\n' '{"command": ["papilla", "repair", "bad.stl", "-o", "bad.glb"]}' "$good" \
  '{"command": ["papilla", "simplify", "in/one.stl", "-o", "few.glb", "--budget", "1", "--strict"]}' >lines.jsonl
code 3 '^papilla: lines.jsonl: line 1: exit code 3: papilla: error: bad.stl' "$papilla" batch lines.jsonl -j 1 --json result.json
has out.txt ': 1 failed, 2 not run$'
has result.json '"not_run": 2'
[[ ! -e line.glb ]] || fail "a line began after one had failed"
code 4 '' "$papilla" batch lines.jsonl -k --json result.json
has out.txt ': 1 done, 2 failed$'
has result.json '"messages": "papilla: error: bad.stl'
[[ -s line.glb ]] || fail "--keep-going does not"

# Ended in the middle: what runs ends, too, and the rest is done later. The first line takes minutes.
slow='{"command": ["papilla", "evaluate", "contact", "-o", "slow", "--json", "slow.json"]}'
for signal in INT TERM; do
  rm -rf line.glb slow
  : >out.txt  # what an earlier one has done is not waited for
  printf '%s\n' "$slow" "$good" '{"command": ["papilla", "evaluate", "contact", "-o", "later", "--json", "later.json"]}' \
    '{"command": ["papilla", "repair", "in/one.stl", "-o", "after.glb"]}' >lines.jsonl
  "$papilla" batch lines.jsonl -j 2 >out.txt 2>err.txt </dev/null &
  batch=$!
  until grep -q '^done' out.txt; do kill -0 $batch || break; done
  kill -"$signal" $batch
  wait $batch
  got=$?
  [[ $got == $((128 + $(kill -l "$signal"))) ]] || fail "SIG$signal: exit $got: $(cat err.txt)"
  has out.txt ': 1 done, [12] ended, [12] not run$'
  [[ -s line.glb && ! -e slow.json && ! -e later.json && ! -e after.glb ]] || fail "SIG$signal: $(ls)"
  ! grep -qs slow.json /proc/[0-9]*/cmdline || fail "SIG$signal: a line still runs"
  no_temporaries
done
sed -i '/evaluate/d' lines.jsonl
code 0 '' "$papilla" batch lines.jsonl --skip-existing
has out.txt ': 1 done, 1 skipped$'
"$papilla" repair in/one.stl -o direct.glb -q && cmp -s after.glb direct.glb || fail "resumed, and another file"

# The time limit ends lines, too.
echo "$slow" >lines.jsonl
code 4 '' "$papilla" batch lines.jsonl --time-limit 0.2 --json result.json
has out.txt ': 1 ended$'
has result.json '"exit_code": 143'
no_temporaries
finish "batch"
