#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# workflows/slurm/array.sh on a real Slurm: a job is killed, a task cancelled, the node lost in the middle, a result
# damaged; the merged bytes are those of the whole bake. slurm_test.sh PAPILLA SOURCE_FOLDER WORK_FOLDER
set -euo pipefail
readonly papilla=$1 source=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/tidy.sh"
. "$here/cluster.sh"
. "$here/bake_whole.sh"
need "${cluster_programs[@]}" python3

rm -rf "$work"
mkdir -p "$work"
cd "$work"
trap 'end_test jobs/logs/* "${cluster-none}"/*.log' EXIT
trap 'exit 143' TERM INT HUP
hold_jobs_in "$work/hold"
export PAPILLA=$here/held_papilla.sh
start_cluster

array() { "$source/workflows/slurm/array.sh" "$@"; }

bake_whole whole.glb
"$papilla" split "$scene" -m "$materials" "${shape[@]}" -o jobs --quiet

echo '== a job is killed, a task cancelled, the node lost'
array --tasks 4 --wait jobs out.glb --quiet >submitted.txt &
submitter=$!
catch_job
kill -KILL "$pid"
killed=$job
catch_job
cancelled=${array}_$task
scancel "$cancelled"
within 60 sh -c "! kill -0 $pid"
catch_job
lost=${array}_$task
lose_node "$pid"
start_node
wait "$submitter" || fail 'the merge ended with an error'
cmp whole.glb out.glb || fail 'disturbed: other bytes than the whole bake'
grep -q "killed, exit code 137; again" jobs/logs/*.txt || fail "$killed was not tried again"
[[ $(scontrol show job "$cancelled") == *JobState=CANCELLED* ]] || fail "$cancelled was not cancelled"
[[ $(scontrol show job "$lost") == *Restarts=1* ]] || fail "$lost was not started again"

echo '== a result is damaged'
result=$(find jobs/results -type f | sort | head -1)
truncate -s -1 "$result"
code=0
"$papilla" merge jobs -o damaged.glb 2>error.txt || code=$?
((code == 3)) && grep -q "$(basename "$result")" error.txt || fail "merge of a damaged result: $code $(<error.txt)"
array --tasks 4 --rounds 1 --wait jobs out3.glb --quiet
cmp whole.glb out3.glb || fail 'mended: other bytes than the whole bake'

echo '== what can not be submitted'
code=0
array --tasks 0 jobs out4.glb 2>error.txt || code=$?
((code == 2)) && grep -q -- '--tasks' error.txt || fail '--tasks 0'
code=0
array nowhere out4.glb 2>error.txt || code=$?
((code == 2)) && grep -q 'nowhere/manifest.jsonl' error.txt || fail 'no such folder'
passed=yes
