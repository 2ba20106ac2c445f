#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The table of docs/methods/photograph-model.md: photographs by this program against those by Blender's Cycles (Debian's
# blender, tested with 3.4): cycles.sh BIN FOLDER. Without Blender it says so and ends.
set -euo pipefail
bin=$1 out=$2
make=$(dirname "${BASH_SOURCE[0]}")
command -v blender >/dev/null || { echo "cycles.sh: no blender, nothing compared"; exit 0; }
mkdir -p "$out"
echo "| relief | elevation | pixels' centres | means over pixels | with scattered light |"
echo "|---|---|---|---|---|"
for kind in sine ovals6 quads6 fourier leather; do
  "$bin/papilla" synthesize grain --kind "$kind" --size 320 --size-mm 20 --height-mm 0.6 -o "$out/$kind.png" --relief "$out/$kind.exr" -q
  for light in 25:0.8368,0.3438,0.4226 40:-0.6040,-0.4709,0.6428 55:0.2219,-0.5287,0.8192; do
    "$bin/papilla" synthesize photo "$out/$kind.exr" --pitch 0.0625 --ambient 0 --light="${light#*:}" -o "$out/photo.exr" -q
    row=$(blender -b --factory-startup -noaudio --python "$make/cycles.py" -- "$out/$kind.exr" 0.0625 "$out/photo.exr" "${light#*:}" |
      sed -n 's/^cycles: //p')
    echo "| $kind | ${light%%:*} $row"
  done
done
