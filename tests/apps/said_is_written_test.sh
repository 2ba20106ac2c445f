#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What repair and unwrap say of their output is what inspect and measure read from it: on the files of EXCHANGE, and on
# those that other people collected in the folder named by PAPILLA_SHARED_DATA.
# usage: said_is_written_test.sh PAPILLA EXCHANGE FOLDER
set -u
papilla=$1 exchange=$2 folder=$3 shared=${PAPILLA_SHARED_DATA:-}
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder" || exit 1
failures=0 cases=0
fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# said FILE FORMAT VERB: runs the verb; its report is in said.json. A file may be refused.
said() {
  rm -f "out.$2"
  local got
  timeout 300 "$papilla" "$3" "$1" -o "out.$2" --json said.json --quiet >/dev/null 2>err.txt </dev/null
  got=$?
  ((got <= 4)) || fail "$3 $1 to $2: exit code $got"
  return "$got"
}

# same NAME: what was said is what was found.
same() {
  cases=$((cases + 1))
  [[ -s said.txt ]] || fail "$1: nothing was said"
  diff said.txt found.txt >diff.txt || fail "$1: said (<) and found (>): $(cat diff.txt)"
}

repaired() {
  said "$1" "$2" repair || return
  "$papilla" inspect "out.$2" --json found.json --quiet >/dev/null || fail "$1: $2 can't be read"
  sed -n '/^  "after": {/,/^  }/p' said.json | grep '^    ' | tr -d ', ' >said.txt
  sed -n '/^  "totals": {/,/^  }/p' found.json | grep '^    ' | grep -v drawn_triangles | tr -d ', ' >found.txt
  same "repair $1 to $2"
}

counts='triangles|charts|flipped|mirrored_charts|degenerate_3d|degenerate_uv|overlapping_triangles'
unwrapped() {
  said "$1" "$2" unwrap || return
  "$papilla" measure "out.$2" --json found.json --quiet >/dev/null || fail "$1: $2 can't be measured"
  sed -n '/^  "distortion": {/,/^  }/p' said.json | grep -E "^    \"($counts)\":" | tr -d ', ' >said.txt
  grep -E "^  \"($counts)\":" found.json | tr -d ', ' >found.txt
  same "unwrap $1 to $2"
}

folders=("$exchange")
if [[ $shared ]]; then folders+=("$shared/mesh" "$shared/gltf" "$shared/param"); fi
while IFS= read -r file; do
  for format in glb stl; do repaired "$file" "$format"; done
  for format in glb obj; do unwrapped "$file" "$format"; done
done < <(find "${folders[@]}" -type f -regextype posix-extended -iregex '.*\.(step|stl|obj|ply|off|glb)' | sort)
echo "$cases outputs, $failures say what they don't hold"
((failures == 0 && cases > 0))
