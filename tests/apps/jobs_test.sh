#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# split, bake --job, merge: the bytes of the whole bake, and what is said of what is wrong; --cache and papilla cache.
# usage: jobs_test.sh PAPILLA DATA FOLDER
set -u
papilla=$1 data=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"

cat >rules.json <<'JSON'
{"materials": {"cap": {"texture": "grain:leather", "size_mm": [30, 20], "stiffness": 600},
               "column": {"texture": "wood", "size_mm": [60, 40], "stiffness": 900}},
 "assign": [{"part": "knob_cap", "material": "cap"}, {"part": "steering_column", "material": "column"}]}
JSON
scene=$data/exchange/knobs.step
"$papilla" bake "$scene" -m rules.json -o whole.glb --effort fast -q || fail "no bake"

# The whole way, part by part.
code 0 '' "$papilla" split "$scene" -m rules.json -o jobs --effort fast --json split.json
[[ $(wc -l <jobs/manifest.jsonl) == 2 ]] || fail "not two jobs"
code 3 'jobs: 2 of 2 jobs have no whole result: .*knob_cap has no result' "$papilla" merge jobs -o merged.glb
[[ ! -e merged.glb ]] || fail "a scene without its jobs"
for job in jobs/inputs/*; do code 0 '' "$papilla" bake --job "jobs/${job##*/}"; done
code 0 '' "$papilla" bake --job "jobs/${job##*/}" && grep -q 'was done' out.txt || fail "done twice"
code 0 '' "$papilla" merge jobs -o merged.glb --report report
cmp -s whole.glb merged.glb || fail "merged is another file than the whole"
[[ -s report/index.html && -s report/report.json ]] || fail "no report"

# A job that is missing, one that is damaged.
first=$(basename "$(ls -d jobs/inputs/*knob_cap)")
truncate -s -1 "jobs/results/$first"
code 3 "1 of 2 jobs have no whole result: $first its result is damaged" "$papilla" merge jobs -o again.glb
code 0 '' "$papilla" merge jobs -o partly.glb --allow-missing --json partly.json
grep -q "\"job\": \"$first\"" partly.json || fail "the job left out is not named: $(cat partly.json)"
cmp -s whole.glb partly.glb && fail "nothing is left out"
code 0 '' "$papilla" bake --job "jobs/$first"
code 0 '' "$papilla" merge jobs -o again.glb
cmp -s whole.glb again.glb || fail "another file after the job was done again"
truncate -s -1 "jobs/inputs/$first"
code 3 "jobs/inputs/$first: is no job's input, or damaged" "$papilla" bake --job "jobs/$first"
code 3 'jobs/inputs/none' "$papilla" bake --job jobs/none

# Parts together; a glTF scene, which is edited in place.
code 0 '' "$papilla" bake whole.glb -m rules.json -o twice.glb
code 0 '' "$papilla" split whole.glb -m rules.json -o few --by triangles=100000
[[ $(wc -l <few/manifest.jsonl) == 1 ]] || fail "not one job"
code 0 '' "$papilla" bake --job "few/$(ls few/inputs)"
code 0 '' "$papilla" merge few -o merged-twice.glb
cmp -s twice.glb merged-twice.glb || fail "an edited file is another one when merged"

# What can't be asked for.
code 2 "--by: 'triangles=0' is neither part nor" "$papilla" split "$scene" -m rules.json -o jobs2 --by triangles=0
code 2 'SCENE' "$papilla" bake "$scene" --job jobs/x
code 2 'is required' "$papilla" bake "$scene" -m rules.json
code 3 'no/bake.json' "$papilla" merge no -o merged.glb
cp rules.json old.json && sed -i 's/600/601/' rules.json
code 3 'rules.json is another one since the split' "$papilla" merge jobs -o merged.glb
cp old.json rules.json

# The cache: the same bytes from it, and what is damaged is named.
for run in 1 2; do
  code 0 '' "$papilla" bake "$scene" -m rules.json -o "cached$run.glb" --effort fast --cache cache --json "cached$run.json"
  cmp -s whole.glb "cached$run.glb" || fail "another file with a cache"
done
grep -q '"uv": 2' cached2.json || fail "nothing was found: $(cat cached2.json)"
code 0 '' "$papilla" plan "$scene" -m rules.json --cache cache && grep -q 'from the cache: 2 of 2 grains' out.txt ||
  fail "plan does not know the cache: $(cat out.txt)"
code 0 '' "$papilla" cache verify --cache cache
entry=$(find cache/uv -type f | head -1)
printf x | dd of="$entry" bs=1 seek=100 conv=notrunc status=none
code 3 '' "$papilla" cache verify --cache cache
grep -qF "$entry: damaged, removed" out.txt || fail "the damaged entry is not named: $(cat out.txt)"
code 0 '' "$papilla" cache stats --cache cache && grep -q tessellation out.txt || fail "no statistics"
code 0 '' "$papilla" cache clear --cache cache
[[ -z $(find cache -type f) ]] || fail "entries are left"
code 2 'there is no cache' "$papilla" cache stats --cache none
code 3 "--cache: 'rules.json' is no folder" "$papilla" inspect "$scene" --cache rules.json
code 3 "PAPILLA_CACHE_LIMIT: 'much' is no size" env PAPILLA_CACHE_LIMIT=much "$papilla" inspect "$scene" --cache cache
code 0 '' "$papilla" bake "$scene" -m rules.json -o limited.glb --effort fast --cache cache --cache-limit 200k
(($(du -sb cache | cut -f1) < 400000)) || fail "the limit is not kept: $(du -sb cache)"

# Jobs share a cache that is named, with each other and with whole bakes; the user's is none of theirs.
export XDG_CACHE_HOME=$PWD/home
code 0 '' "$papilla" bake "$scene" -m rules.json -o cached3.glb --effort fast --cache shared
code 0 '' "$papilla" split "$scene" -m rules.json -o shared-jobs --effort fast --cache shared --json split.json
tr -d ' \n' <split.json | grep -qE '"made":\{("[a-z]+":0,?)*\}' ||
  fail "split made what the cache has: $(cat split.json)"
for job in shared-jobs/inputs/*; do
  code 0 '' env PAPILLA_CACHE="$PWD/shared" "$papilla" bake --job "shared-jobs/${job##*/}"
  grep -qE 'cache: ([0-9]+) of \1 results found in .*/shared' out.txt || fail "a job made what the cache has: $(cat out.txt)"
done
rm -r few/results/* few/store/measure
code 0 '' env -u PAPILLA_CACHE "$papilla" bake --job "few/$(ls few/inputs)"
[[ -d few/store/measure ]] || fail "nothing was done again"
[[ ! -e home/papilla ]] || fail "a job wrote into the user's cache"
code 0 '' "$papilla" merge shared-jobs -o shared.glb
cmp -s whole.glb shared.glb || fail "another file with a shared cache"
finish "jobs and cache"
