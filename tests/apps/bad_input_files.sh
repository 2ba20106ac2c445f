#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Damaged, invalid and odd files: each is read, or refused with exit code 3 and one line that names it. They are damaged
# copies of the files in EXCHANGE, and what other people collected in the folder named by PAPILLA_SHARED_DATA.
# usage: bad_input_files.sh PAPILLA EXCHANGE TABLE.md WORK_FOLDER
set -u
papilla=$1 exchange=$2 table=$3 work=$4 shared=${PAPILLA_SHARED_DATA:-}
rm -rf "$work/damaged"
mkdir -p "$work/damaged" "$(dirname "$table")" || exit 1
ulimit -v 4000000  # kB: the program's libraries take 1.5 GB of addresses; what a file claims must not be taken.

read_files=0 refused=0 failures=0
rows=$work/rows.txt
: >"$rows"

# The result of one file as a row of the table.
check() {
  local file=$1 name=${1#"$work/"} code lines message
  name=${name#"${shared:+$shared/}"}
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

# damage FILE: copies that end early, and copies with 64 bytes overwritten somewhere.
damage() {
  local file=$1 copy size part
  size=$(stat -c %s "$file")
  for part in 2 7 13; do
    copy=$work/damaged/ends-at-$part-of-16-$(basename "$file")
    head -c $((size * part / 16)) "$file" >"$copy"
    copy=$work/damaged/overwritten-at-$part-of-16-$(basename "$file")
    cp "$file" "$copy"
    printf '\377-9e99 "{[/%.0s' 1 2 3 4 5 | dd of="$copy" bs=1 seek=$((size * part / 16)) conv=notrunc status=none
  done
}

for file in "$exchange"/*.*; do damage "$file"; done
folders=("$work/damaged")
if [[ $shared ]]; then folders+=("$shared/mesh/defects" "$shared/gltf-invalid" "$shared/gltf-generator"); fi
while IFS= read -r file; do check "$file"; done < <(
  find "${folders[@]}" -type f -regextype posix-extended \
    -iregex '.*\.(step|igs|brep|stl|obj|ply|off|gltf|glb)' | sort)

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
