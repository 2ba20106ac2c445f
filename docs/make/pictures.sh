#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of README.md and docs/ from what the programs write: pictures.sh BIN DEMO RUNS OUT
#   DEMO is what ./run demo leaves, RUNS what runs.sh does.
set -euo pipefail
bin=$1 demo=$2 runs=$3 out=$4
make=$(dirname "${BASH_SOURCE[0]}")
report=$demo/report

# Scene and checker above, two close-ups and a layout below.
oiiotool --create 1800x1163 3 \
  "$report/scene.png" --ch R,G,B --resize 900x563 --paste +0+0 \
  "$report/scene-checker.png" --ch R,G,B --resize 900x563 --paste +900+0 \
  "$report/close-up-leather.png" --ch R,G,B --resize 600x600 --paste +0+563 \
  "$report/close-up-hard_grain.png" --ch R,G,B --resize 600x600 --paste +600+563 \
  "$report/uv-seat_cushion.png" --ch R,G,B --fit 600x600 --paste +1200+563 \
  --compression png:9 -d uint8 -o "$out/cockpit.png"

cp "$runs/meshing/charts.png" "$out/charts.png"
cp "$runs/texture/grain/symmetry.png" "$out/symmetry.png"
cp "$runs/param/evaluate-param-1.svg" "$out/evaluate-param.svg"
for sheet in types library; do
  "$bin/papilla" texture --sheet "$sheet" -o "$runs/sheet-$sheet" --quiet
  cp "$runs/sheet-$sheet/sheet.png" "$out/texture-$sheet.png"
done

node "$make/screenshot.mjs" "$report/index.html" "$out/report-page.png"
