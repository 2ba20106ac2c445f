# SPDX-License-Identifier: GPL-3.0-or-later
# For tests that are sourced with it and tidy.sh: the sample cockpit, coarse, as one bake, which what the fleet makes is
# compared with, and jobs that are caught in the middle of their work.
readonly scene=$source/data/cockpit.step materials=$source/tests/workflows/materials.json
readonly -a shape=(--chord 0.5)
export PAPILLA_CACHE=none  # What is tested is done, and not remembered from the run before.

bake_whole() { "$papilla" bake "$scene" -m "$materials" "${shape[@]}" -o "$1" --quiet; }

# Makes held_papilla.sh ready; jobs that it holds do not outlive the test.
hold_jobs_in() {
  mkdir -p "$1"
  HOLD=$1
  tidy_also end_held HOLD
  export HOLD REAL_PAPILLA=$papilla
}
end_held() { end_those_with "HOLD=$HOLD"; }

# The next job that is long enough is stopped in its work; sets pid, array, task and job.
catch_job() {
  rm -f "$HOLD/held"
  touch "$HOLD/wanted"
  within 300 test -e "$HOLD/held"
  read -r pid array task job <"$HOLD/held"
  echo "caught: $job, process $pid, task $array/$task"
}
