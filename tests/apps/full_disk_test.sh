#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A full disk: exit code 3 and one line with the system's reason, or the bytes that are needed, whatever is written.
# usage: full_disk_test.sh PAPILLA PLAYER FOLDER
set -u
papilla=$1 player=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"

# full OUTPUT COMMAND...
full() {
  local output=$1 got
  shift
  "$@" 2>err.txt </dev/null
  got=$?
  if [[ $got != 3 || $(wc -l <err.txt) != 1 ]] ||
    ! grep -Eq "$output.*: (No space left on device|takes [0-9]+ bytes, [0-9]+ are free on its file system)" err.txt; then
    fail "exit $got: $*: $(cat err.txt)"
  fi
}

printf 'v 0 0 0\nv 10 0 0\nv 0 10 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' >one.obj
"$papilla" synthesize grain --kind leather --size 64 -o grain.png -q || fail "no picture"
printf '{"materials": {"g": {"stiffness": 300}}, "assign": [{"part": "*", "material": "g"}]}' >rules.json
"$papilla" bake one.obj -m rules.json -o tagged.glb -q || fail "nothing baked"

for arguments in 'inspect one.obj' 'inspect one.obj --json -' 'texture --list reference' '--help' '--version' 'inspect --help'; do
  # shellcheck disable=SC2086
  full 'standard output' "$papilla" $arguments >/dev/full
done
full 'standard output' "$player" tagged.glb --seconds 0.05 >/dev/full
full 'standard output' "$player" tagged.glb --seconds 0.05 --json - >/dev/full
full 'standard output' "$player" --help >/dev/full
full 'standard output' "$player" --list-devices >/dev/full
full /dev/full "$papilla" inspect one.obj --json /dev/full -q
full /dev/full "$player" tagged.glb --seconds 0.05 --record /dev/full -q
full /dev/full "$player" tagged.glb --seconds 0.05 --record /dev/full --json - >run.json
# One document: the report, with the error.
python3 - run.json <<'PYTHON' || fail "run.json: $(head -c 300 run.json)"
import json, sys
report = json.load(open(sys.argv[1]))
assert report["exit_code"] == 3 and "/dev/full" in report["error"] and report["ticks"] > 0, report
PYTHON

# Progress that nobody can read is no error.
"$papilla" unwrap one.obj -o a.glb --progress json -q 2>/dev/full || fail "exit $? where progress can't be written"

# Longer than 4096 pixels: its relief is written row by row.
{ printf 'P5\n5000 100\n255\n'; head -c 500000 /dev/urandom; } >long.pgm
for extension in png tif exr; do
  ln -s /dev/full "long.$extension"
  full "long.$extension" "$papilla" height long.pgm -o "long.$extension" --method intensity -q
done

mkdir disk
if mount -t tmpfs -o size=16k none disk 2>/dev/null; then
  trap 'umount "$folder/disk"' EXIT
  mkdir disk/folder
  head -c 100000 /dev/zero >disk/rest 2>/dev/null
  for command in "$papilla repair one.obj -o disk/a.glb" "$papilla repair one.obj -o disk/a.stl" "$papilla repair one.obj -o disk/a.ply" \
    "$papilla repair one.obj -o disk/a.off" "$papilla repair one.obj -o disk/a.obj" "$papilla inspect one.obj --picture disk/a.png" \
    "$papilla measure one.obj --csv disk/a.csv" "$papilla measure one.obj --json disk/a.json" "$papilla view one.obj -o disk/a.html --no-open" \
    "$papilla bake one.obj -m rules.json -o disk/a.glb" "$papilla synthesize grain --size 64 -o disk/a.png" \
    "$papilla synthesize grain --size 64 -o disk/a.tif" "$papilla height grain.png -o disk/a.exr" \
    "$papilla texture noise --size 64 --steps 2 --video -o disk/folder" "$papilla unwrap one.obj -o a.glb --trace disk/a.csv" \
    "$player tagged.glb --seconds 0.5 --record disk/a.csv"; do
    # shellcheck disable=SC2086
    full disk/ $command -q
    [[ -z $(find disk -name '.papilla-*' -o -name 'a.*') ]] || fail "$command left $(find disk -type f)"
  done
  # There is space for a block, but not for the result, whose size is known.
  rm disk/rest
  awk 'BEGIN { for (y = 0; y < 15; ++y) for (x = 0; x < 15; ++x) print "v", x, y, (x * y) % 3
    for (y = 0; y < 14; ++y) for (x = 1; x < 15; ++x) { a = 15 * y + x; print "f", a, a + 1, a + 16; print "f", a, a + 16, a + 15 } }' >grid.obj
  for extension in stl glb obj ply off; do
    for command in repair "simplify --ratio 0.99" unwrap "bake -m rules.json"; do
      [[ $extension == glb || $command == repair || $extension == stl && $command == simplify* ]] || continue
      # shellcheck disable=SC2086
      full disk/a $papilla $command grid.obj -o disk/a.$extension -q
      grep -q 'takes [1-9][0-9]* bytes, ' err.txt || fail "$command, $extension: $(cat err.txt)"
      [[ -z $(ls disk/a.* disk/.papilla-* 2>/dev/null) ]] || fail "$command left $(ls -a disk)"
    done
  done
  full disk/a "$papilla" repair grid.obj -o disk/a.stl -q
  grep -q 'takes 19684 bytes, ' err.txt || fail "392 triangles of STL: $(cat err.txt)"
else
  echo "no right to mount a small disk: only /dev/full was tried"
fi
finish "full disk"
