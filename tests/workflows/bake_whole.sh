# SPDX-License-Identifier: GPL-3.0-or-later
# For tests that are sourced with it: the sample cockpit, coarse, as one bake, which what the fleet makes is compared with.
readonly scene=$source/data/cockpit.step materials=$source/tests/workflows/materials.json
readonly -a shape=(--chord 0.5)

bake_whole() { "$papilla" bake "$scene" -m "$materials" "${shape[@]}" -o "$1" --cache none --quiet; }

# The next job that starts is stopped in its work; sets pid, array, task and job.
catch_job() {
  rm -f "$HOLD/held"
  touch "$HOLD/wanted"
  within 120 test -e "$HOLD/held"
  read -r pid array task job <"$HOLD/held"
  echo "caught: $job, process $pid, task $array/$task"
}

# Of a failed test: what the jobs and daemons said.
show_logs() {
  local file
  for file in "$@"; do
    [[ -e $file ]] && { echo "--- $file"; tail -n 40 "$file"; }
  done
  return 0
}
