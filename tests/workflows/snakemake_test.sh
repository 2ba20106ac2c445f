#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# workflows/snakemake, ended in the middle of a job and begun again, on this machine or on a Slurm of its own; the merged
# bytes are those of the whole bake. snakemake_test.sh local|slurm PAPILLA SOURCE_FOLDER WORK_FOLDER
set -euo pipefail
readonly profile=$1 papilla=$2 source=$3 work=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/tidy.sh"
. "$here/cluster.sh"
. "$here/bake_whole.sh"
need snakemake
[[ $profile == local ]] || need "${cluster_programs[@]}" python3

rm -rf "$work"
mkdir -p "$work"
cd "$work"
trap 'end_test run*.txt .snakemake/slurm_logs/*/* "${cluster-none}"/*.log' EXIT
trap 'exit 143' TERM INT HUP
hold_jobs_in "$work/hold"
export USER=${USER:-$(id -un)} XDG_CACHE_HOME=$work/user-cache
[[ $profile == local ]] || start_cluster

# One machine has no room for the memory that the profile asks of a node.
flow() {
  local -a small=()
  [[ $profile == local ]] || small=(--default-resources mem_mb=100 runtime=10 --latency-wait 5)
  exec snakemake --snakefile "$source/workflows/snakemake/Snakefile" --profile "$source/workflows/snakemake/profiles/$profile" \
    "${small[@]}" --nocolor --config papilla="$here/held_papilla.sh" scene="$scene" materials="$materials" by=triangles=10000 \
    output=scene.glb bake_options="${shape[*]}" merge_options=--quiet
}

bake_whole whole.glb
(flow) >run1.txt 2>&1 &
snakemake=$!
catch_job
[[ ! -e scene.glb ]] || fail 'there is an output before all jobs are done'
# Snakemake is lost, too; on Slurm its job lives on for a while and is not waited for.
kill -KILL "$snakemake"
wait "$snakemake" || true
kill -KILL "$pid"
if [[ $profile == slurm ]]; then
  scancel --user="$USER"
  within 60 sh -c 'test -z "$(squeue -h)"'
fi
[[ ! -e jobs/results/${job##*/} ]] || fail "$job was killed, but has a result"

snakemake --snakefile "$source/workflows/snakemake/Snakefile" --unlock --config jobs=jobs >unlock.txt 2>&1
(flow) >run2.txt 2>&1 || fail 'begun again: ended with an error'
cmp whole.glb scene.glb || fail 'other bytes than the whole bake'

echo '== nothing is done twice'
(flow) >run3.txt 2>&1
grep -q 'Nothing to be done' run3.txt || fail 'a third run has something to do'
passed=yes
