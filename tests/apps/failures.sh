# shellcheck shell=bash
# SPDX-License-Identifier: GPL-3.0-or-later
# For the tests beside it. source failures.sh FOLDER: goes to $folder, made anew. fail WORDS...: says and counts a failure.
# code WANTED PATTERN COMMAND...: the exit code, and a line of stderr; leaves out.txt and err.txt. finish WORDS...: ends the
# test with what it has seen.
folder=$1 failures=0
export PAPILLA_CACHE=none  # What is tested is done, and not remembered from the run before.
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder" || exit 1

fail() {
  echo "FAILED: $*" >&2
  failures=$((failures + 1))
}

code() {
  local -r wanted=$1 pattern=$2
  shift 2
  "$@" >out.txt 2>err.txt </dev/null
  local -r got=$?
  [[ $got == "$wanted" ]] || fail "exit $got instead of $wanted: $*: $(cat err.txt)"
  [[ -z $pattern ]] || grep -qE -- "$pattern" err.txt || fail "no '$pattern' in: $(cat err.txt)"
}

finish() {
  echo "$*; $failures failures"
  exit $((failures > 0))
}
