#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Damaged, invalid and odd files of other people: each is read, or refused with exit code 3 and one line that names it.
# usage: bad_input_files.sh PAPILLA TABLE.md FOLDER   (the folder that PAPILLA_SHARED_DATA names; skips without it)
set -u
papilla=$1 table=$2 work=$3 data=${PAPILLA_SHARED_DATA:-}
[[ -d $data ]] || { echo "PAPILLA_SHARED_DATA is not set"; exit 77; }
mkdir -p "$work" "$(dirname "$table")" || exit 1
ulimit -v 4000000  # kB: the program's libraries take 1.5 GB of addresses; what a file claims must not be taken.

read_files=0 refused=0 failures=0
rows=$work/rows.txt
: >"$rows"

# The result of one file as a row of the table.
check() {
  local file=$1 name=${1#"$data"/} code lines message
  timeout 60 "$papilla" inspect "$file" --json "$work/out.json" --quiet >"$work/out.txt" 2>"$work/err.txt" </dev/null
  code=$?
  lines=$(wc -l <"$work/err.txt")
  if ((code == 0)); then
    message=$(grep -A3 '"totals"' "$work/out.json" | sed -n 's/.*"triangles": \([0-9]*\).*/\1 triangles/p')
    read_files=$((read_files + 1))
  else
    message=$(sed "s|^papilla: error: ||; s|$file|FILE|; s/|/\\\\|/g" "$work/err.txt")
    refused=$((refused + 1))
    if ((code != 3 || lines != 1)) || ! grep -qF -- "$file" "$work/err.txt"; then
      failures=$((failures + 1))
      message="WRONG: exit $code, $lines lines: $message"
      echo "$name: $message"
    fi
  fi
  printf '| %s | %s | %s |\n' "$name" "$code" "$message" >>"$rows"
}

while IFS= read -r file; do check "$file"; done < <(
  find "$data/mesh/defects" "$data/gltf-invalid" "$data/gltf-generator" -type f \
    \( -iname '*.stl' -o -iname '*.obj' -o -iname '*.ply' -o -iname '*.off' -o -iname '*.gltf' -o -iname '*.glb' \) | sort)

{
  echo "# Bad input"
  echo
  echo "Written by \`tests/apps/bad_input_files.sh\`: \`papilla inspect\` on every file, with 4 GB of address space and a minute."
  echo "$((read_files + refused)) files: $read_files read, $refused refused with one line, $failures otherwise."
  echo
  echo "| file | exit | triangles or message |"
  echo "|---|---|---|"
  cat "$rows"
} >"$table"
echo "$((read_files + refused)) files: $read_files read, $refused refused, $failures wrong"
((read_files > 0 && failures == 0))
