#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures that nothing can be read from, through every verb that takes a picture: a result without a number that is not
# finite, or exit code 3 and one line. The table lists what happened.
# usage: bad_pictures.sh PAPILLA TABLE.md FOLDER
set -u
papilla=$1 table=$2 work=$3
rm -rf "$work" && mkdir -p "$work" "$(dirname "$table")" && cd "$work" || exit 1
ulimit -v 8000000 # kB
results=0 refused=0 failures=0
rows=rows.txt
: >"$rows"

# grey FILE WIDTH HEIGHT LEVEL: one grey level everywhere.
grey() { { printf 'P5\n%d %d\n255\n' "$2" "$3"; head -c $(($2 * $3)) /dev/zero | tr '\0' "\\$(printf '%03o' "$4")"; } >"$1"; }
# pfm FILE BITS: 40 x 40 floats of 0.5 with one value given as little-endian bytes.
pfm() {
  { printf 'Pf\n40 40\n-1.0\n'; for _ in $(seq 800); do printf '\0\0\0\77'; done
    printf "%b" "$2"; for _ in $(seq 799); do printf '\0\0\0\77'; done; } >"$1"
}
grey flat.pgm 64 64 128
grey black.pgm 64 64 0
grey saturated.pgm 64 64 255
grey one.pgm 1 1 99
grey line.pgm 500 1 99
grey column.pgm 1 500 99
grey tiny.pgm 5 4 99
grey wide.pgm 16384 2 99
grey huge.pgm 16384 16384 99
{ printf 'P5\n48 48\n255\n'; seq 2000 | sha512sum | head -c 128; seq 9999 | head -c 2176; } >rubble.pgm
pfm nan.pfm '\0\0\300\177'
pfm infinite.pfm '\0\0\200\177'
pfm giant.pfm '\377\377\177\177'
printf 'P5\n64 64\n255\nshort' >truncated.pgm
printf 'P5\n-3 64\n255\n' >negative.pgm
printf 'P5\n2000000000 2000000000\n255\n' >claims.pgm
: >empty.png
head -c 400 /dev/zero >zeros.png
printf 'no picture' >text.jpg

# try NAME FILE COMMAND...: adds a row; a result must not hold NaN or infinity.
try() {
  local name=$1 file=$2 code lines message
  shift 2
  timeout 120 "$@" --quiet --json result.json >out.txt 2>err.txt </dev/null
  code=$?
  lines=$(wc -l <err.txt)
  if ((code == 0)); then
    results=$((results + 1))
    message=result
    # JSON has no such numbers: they would be written as null or as words.
    if grep -qiE '\b-?(nan|inf)\b' result.json; then message="WRONG: a number that is not finite"; failures=$((failures + 1)); fi
  else
    refused=$((refused + 1))
    message=$(sed 's/^papilla: error: //; s/|/\\|/g' err.txt)
    if ((code != 3 || lines != 1)); then
      message="WRONG: exit $code, $lines lines: $message"
      failures=$((failures + 1))
    fi
  fi
  [[ $message == WRONG* ]] && echo "$name $file: $message"
  printf '| %s | %s | %s | %s |\n' "$file" "$name" "$code" "$message" >>"$rows"
  rm -f result.json out.png
}

for file in flat.pgm black.pgm saturated.pgm one.pgm line.pgm column.pgm tiny.pgm wide.pgm rubble.pgm nan.pfm infinite.pfm \
            giant.pfm truncated.pgm negative.pgm claims.pgm empty.png zeros.png text.jpg missing.png; do
  try analyze "$file" "$papilla" analyze "$file"
  try "analyze strip" "$file" "$papilla" analyze "$file" --only symmetry --pattern strip
  try "analyze rosette" "$file" "$papilla" analyze "$file" --only symmetry --pattern rosette
  for method in variational pentland tsai-shah intensity; do
    try "height $method" "$file" "$papilla" height "$file" -o out.png --method "$method" --light 0.01,0.01,1
  done
  try "height synthesized" "$file" "$papilla" height "$file" -o out.png --roughness synthesized --pitch 0.1 --cut auto
  try prepare "$file" "$papilla" prepare "$file" -o out.png
  try "synthesize --like" "$file" "$papilla" synthesize fractal --like "$file" -o out.png
  try "evaluate height" "$file" "$papilla" evaluate height "$file" -o evaluation
done
try "height variational" huge.pgm "$papilla" height huge.pgm -o out.png --method variational
grey strip.pgm 200000 1 99
grey tower.pgm 1 200000 99
for file in strip.pgm tower.pgm; do
  try analyze "$file" "$papilla" analyze "$file"
  for method in variational pentland tsai-shah intensity; do
    try "height $method" "$file" "$papilla" height "$file" -o out.exr --method "$method"
  done
done
try analyze huge.pgm "$papilla" analyze huge.pgm --only symmetry
try "height tsai-shah" huge.pgm "$papilla" height huge.pgm -o out.png --method tsai-shah
try "light from behind" rubble.pgm "$papilla" height rubble.pgm -o out.png --method variational --light 0,0,-1
try "light along the ground" rubble.pgm "$papilla" height rubble.pgm -o out.png --method variational --light 1,0,1e-9
try "light of no length" rubble.pgm "$papilla" height rubble.pgm -o out.png --method variational --light 0,0,0

{
  echo "# Bad pictures"
  echo
  echo "Written by \`tests/apps/bad_pictures.sh\`: every verb that takes a picture, on pictures that nothing can be read from, with 8 GB of"
  echo "address space and two minutes. $((results + refused)) runs: $results with a result, $refused refused with one line, $failures otherwise."
  echo
  echo "| picture | verb | exit | result or message |"
  echo "|---|---|---|---|"
  cat "$rows"
} >"$table"
echo "$((results + refused)) runs: $results results, $refused refused, $failures wrong"
((failures == 0))
