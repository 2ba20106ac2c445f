#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Does the jobs of papilla split on Slurm, as job arrays, and puts their results together.
#
#   papilla split SCENE -m MATERIALS.json -o jobs         # once, on a machine that sees the cluster's file system
#   workflows/slurm/array.sh [--tasks N] [--rounds N] [--wait] jobs scene.glb [OPTION OF papilla merge ...]
#
#   --tasks N   tasks of an array; jobs are dealt to them, the costliest first. Default: one a job, up to MaxArraySize
#   --rounds N  arrays that follow one another, default 2: a later one does what has no whole result, whatever ended it
#   --wait      return when all is done, with the exit code of papilla merge
#
# The last of the submitted jobs merges; it ends with 3 and names the jobs that have no whole result.
# The same command again resumes: jobs with a whole result answer at once.
# What a job is killed by (memory, a lost machine) is tried three times within a round.
# Slurm's own options go by its variables: SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT, SBATCH_MEM_PER_CPU, ...
# Jobs share the cache that PAPILLA_CACHE names, with each other and with other bakes.
# PAPILLA names the program, when it is not the papilla of PATH. What jobs print goes to jobs/logs/.
set -euo pipefail

readonly papilla=${PAPILLA:-papilla}
readonly tries=3

die() { printf 'array.sh: %s\n' "$*" >&2; exit 2; }

# The ids of a folder's jobs, the costliest first.
job_ids() {
  sed -n 's/^{"id":"\([^"]*\)",.*"cost_seconds":\([0-9.e+-]*\)}$/\2 \1/p' "$1/manifest.jsonl" |
    LC_ALL=C sort -k1,1gr -k2,2 | cut -d ' ' -f 2
}

# One job; again when it was killed, which says nothing about its input.
run_job() {
  local folder=$1 id=$2 try code
  for ((try = 1; ; ++try)); do
    code=0
    "$papilla" bake --job "$folder/$id" --quiet --threads "${SLURM_CPUS_PER_TASK:-1}" </dev/null || code=$?
    ((code > 128 && try < tries)) || return "$code"
    echo "$id: killed, exit code $code; again" >&2
  done
}

# The part of the jobs that falls to this task of the array. A job that fails keeps no other from running.
run_task() {
  local folder=$1 tasks=$2 id failed=0
  while read -r id; do
    run_job "$folder" "$id" || { failed=1; echo "$id: failed" >&2; }
  done < <(job_ids "$folder" | awk -v tasks="$tasks" -v task="$SLURM_ARRAY_TASK_ID" '(NR - 1) % tasks == task')
  return "$failed"
}

largest_array() { scontrol show config | sed -n 's/^MaxArraySize *= *//p'; }

submit() {
  local tasks='' rounds=2 jobs limit round previous=''
  local -a waiting=()
  while (($#)); do
    case $1 in
      --tasks) tasks=${2-}; shift ;;
      --rounds) rounds=${2-}; shift ;;
      --wait) waiting=(--wait) ;;
      -*) die "unknown option $1" ;;
      *) break ;;
    esac
    shift
  done
  (($# >= 2)) || die 'usage: array.sh [--tasks N] [--rounds N] [--wait] JOBS OUTPUT [OPTION OF papilla merge ...]'
  [[ -r $1/manifest.jsonl ]] || die "$1/manifest.jsonl: no such file; papilla split makes it"
  command -v "$papilla" >/dev/null || die "$papilla: no such program; PAPILLA names it"
  [[ -z $tasks || $tasks =~ ^[1-9][0-9]*$ ]] || die "--tasks: '$tasks' is no number from 1"
  [[ $rounds =~ ^[1-9][0-9]*$ ]] || die "--rounds: '$rounds' is no number from 1"

  local folder=$1
  folder=$(realpath "$folder")
  shift
  jobs=$(job_ids "$folder" | wc -l)
  ((jobs > 0 && jobs == $(wc -l <"$folder/manifest.jsonl"))) || die "$folder/manifest.jsonl: not a manifest of papilla split"
  limit=$(largest_array)
  [[ -n $tasks ]] || tasks=$jobs
  tasks=$((tasks < jobs ? tasks : jobs))
  tasks=$((tasks < limit ? tasks : limit))
  mkdir -p "$folder/logs"

  for ((round = 1; round <= rounds; ++round)); do
    previous=$(sbatch --parsable --job-name=papilla --array="0-$((tasks - 1))" --requeue --open-mode=append \
      --output="$folder/logs/%A_%a.txt" ${previous:+--dependency=afterany:"$previous"} "$0" --task "$folder" "$tasks")
    previous=${previous%%;*}  # the cluster's name may follow
    echo "round $round: job $previous, $tasks tasks for $jobs jobs"
  done
  echo "merge: follows job $previous; what it prints goes to $folder/logs/merge.txt"
  sbatch --job-name=papilla-merge --requeue --output="$folder/logs/merge.txt" --dependency=afterany:"$previous" \
    "${waiting[@]}" "$0" --merge "$folder" "$@"
}

case ${1-} in
  -h | --help) sed -n 's/^# \?//p' "$0" | sed 1d | sed '/^PAPILLA names/q' ;;
  --task) run_task "$2" "$3" ;;
  --merge) exec "$papilla" merge "$2" -o "${@:3}" ;;
  *) submit "$@" ;;
esac
