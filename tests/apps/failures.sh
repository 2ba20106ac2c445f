# shellcheck shell=bash
# SPDX-License-Identifier: GPL-3.0-or-later
# For the tests beside it. source failures.sh FOLDER: goes to $folder, made anew. fail WORDS...: says and counts a failure.
# finish WORDS...: ends the test with what it has seen.
folder=$1 failures=0
export PAPILLA_CACHE=none  # What is tested is done, and not remembered from the run before.
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder" || exit 1

fail() {
  echo "FAILED: $*" >&2
  failures=$((failures + 1))
}

finish() {
  echo "$*; $failures failures"
  exit $((failures > 0))
}
