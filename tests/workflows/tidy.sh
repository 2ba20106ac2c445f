# SPDX-License-Identifier: MIT
# For tests that are sourced with it and start processes that outlive them: these are ended however the test ends, by
# itself, by a signal, or killed by the time limit of ctest, which no trap sees.

# Ends the test as skipped when the given programs are not all there.
need() {
  local program
  for program in "$@"; do
    command -v "$program" >/dev/null || { echo "skipped: $program is not installed; ./run test installs it"; exit 77; }
  done
}

fail() { echo "FAILED: $*"; exit 1; }

# Waits until a command succeeds: within SECONDS COMMAND ...
within() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    ((SECONDS < end)) || { echo "gave up waiting for: $*" >&2; return 1; }
    sleep 0.1
  done
}

# Whether the process runs whose number a file holds.
is_alive() { [[ -s $1 ]] && kill -0 "$(<"$1")" 2>/dev/null; }

parent_of() { sed 's/.*) . \([0-9]*\) .*/\1/' "/proc/$1/stat"; }

# Kills the processes that were started with NAME=VALUE in their environment, and Slurm's keepers of them.
end_those_with() {
  local file pid
  for file in /proc/[0-9]*/environ; do
    pid=${file//[^0-9]/}
    ((pid != $$ && pid != BASHPID)) || continue
    grep -qzxF -- "$1" "$file" 2>/dev/null || continue
    local keeper
    keeper=$(parent_of "$pid" 2>/dev/null) || continue
    [[ $(cat "/proc/$keeper/comm" 2>/dev/null) != slurmstepd ]] || kill -KILL "$keeper" 2>/dev/null
    kill -KILL "$pid" 2>/dev/null
  done
  return 0
}

tidy_calls=()

# FUNCTION is called when the test ends, with what the named variables hold now: tidy_also FUNCTION VARIABLE ...
# The guard is nobody's child, so that it is not killed with the test, and has none of its environment.
tidy_also() {
  tidy_calls=("$1" "${tidy_calls[@]}")
  local script
  script="$(declare -f within is_alive parent_of end_those_with "$1"; declare -p "${@:2}"); tail --pid=$$ -f /dev/null; $1"
  (env -i PATH="$PATH" setsid bash -c "$script" </dev/null >/dev/null 2>&1 &)
}

# At the end of a test: says what the given files hold when it did not pass, and tidies.
end_test() {
  local call file
  if [[ ${passed-no} != yes ]]; then
    for file in "$@"; do
      [[ ! -f $file ]] || { echo "--- $file"; tail -n 40 "$file"; }
    done
  fi
  for call in "${tidy_calls[@]}"; do "$call" || true; done
}
