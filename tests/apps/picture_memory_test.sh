#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a picture may take: exit code 3 and one line with file, size and option before it is decoded; bands where a verb
# reads in bands.
# usage: picture_memory_test.sh PAPILLA FOLDER
set -u
papilla=$1
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$2"

# refused TEXT COMMAND...
refused() {
  local text=$1 got
  shift
  "$@" >out.txt 2>err.txt </dev/null
  got=$?
  if [[ $got != 3 || $(wc -l <err.txt) != 1 ]] || ! grep -q -- "$text" err.txt; then
    fail "exit $got: $*: $(cat err.txt)"
  fi
}

# grey FILE WIDTH HEIGHT: announces that many pixels of one level.
grey() { { printf 'P5\n%d %d\n255\n' "$2" "$3"; head -c $(($2 * $3)) /dev/zero | tr '\0' '\143'; } >"$1"; }

grey large.pgm 4500 1000
size='large.pgm: 4500 x 1000 pixels of 1 channels take .* MB of memory, more than the 40.0 MB that --max-memory allows'
for method in variational pentland tsai-shah intensity; do
  "$papilla" height large.pgm -o small.exr --method $method --roughness residual --max-memory 40000000 >height.txt ||
    fail "not reduced by $method"
  grep -q 'read as means over [45] x [45]' height.txt || fail "$method: $(cat height.txt)"
done
refused "$size" "$papilla" prepare large.pgm -o out.png --max-memory 40000000
[[ -e out.png ]] && fail "an output of a picture that was refused"
"$papilla" height large.pgm -o out.png --method intensity --max-memory 40000000 -q --json height.json || fail "not in bands"
"$papilla" analyze large.pgm --max-memory 40M --only class -q || fail "not analysed in bands"

# Where a picture is the grain, or the input of a measurement.
printf 'v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n' >one.obj
printf '{"materials": {"g": {"texture": "large.pgm", "size_mm": [45, 10]}}, "assign": [{"part": "*", "material": "g"}]}' >rules.json
refused "$size" "$papilla" bake one.obj -m rules.json -o out.glb --max-memory 40000000
for kind in fractal symmetry height; do
  refused "$size" "$papilla" evaluate $kind large.pgm -o out --seconds 1 --max-memory 40000000
done

# 100000 x 100000 pixels in a file of 100 bytes, whatever --max-memory says.
printf 'P5\n100000 100000\n255\nshort' >claims.pgm
refused 'claims.pgm: claims 100000 x 100000 pixels' "$papilla" analyze claims.pgm --max-memory 100G
# An animation that announces 30000 x 30000 pixels, whose reader takes memory when it opens the file.
printf 'GIF89a\x30\x75\x30\x75\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\x30\x75\x30\x75\0\x02\x02\x4c\x01\0;' >claims.gif
refused 'claims.gif: 30000 x 30000 pixels take 3600.0 MB' "$papilla" height claims.gif -o out.png --max-memory 1G

# Less memory than --max-memory allows: named, not "out of memory" alone.
grey whole.pgm 4000 4000
(ulimit -v 800000 && refused 'whole.pgm: no memory is left' "$papilla" height whole.pgm -o out.png --method variational \
  --roughness residual --max-memory 100G && exit $failures) || failures=$((failures + 1))

for wrong in 0 -1 much 1X; do
  "$papilla" analyze large.pgm --max-memory=$wrong 2>err.txt >out.txt && fail "--max-memory $wrong"
done

finish "memory of pictures"
