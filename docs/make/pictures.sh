#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of README.md and docs/ from what the programs write: pictures.sh BIN DEMO RUNS OUT
#   DEMO is what ./run demo leaves, RUNS what runs.sh does.
set -euo pipefail
bin=$1 demo=$2 runs=$3 out=$4
make=$(dirname "${BASH_SOURCE[0]}")
report=$demo/report

# Scene and checker above, two close-ups and a layout below.
oiiotool --pattern constant:color=1,1,1 1800x1163 3 \
  "$report/scene.png" --ch R,G,B --resize 900x563 --swap --paste +0+0 \
  "$report/scene-checker.png" --ch R,G,B --resize 900x563 --swap --paste +900+0 \
  "$report/close-up-leather.png" --ch R,G,B --resize 600x600 --swap --paste +0+563 \
  "$report/close-up-soft_skin.png" --ch R,G,B --resize 600x600 --swap --paste +600+563 \
  "$report/uv-seat_cushion.png" --ch R,G,B --resize 0x600 --swap --paste +1327+563 \
  --compression jpeg:90 -d uint8 -o "$out/cockpit.jpg"

PYTHONPATH=$bin/../python MPLBACKEND=Agg /usr/bin/python3 "$make/../../examples/python/distortion_of_methods.py" "$out/python-methods.png"
# Blender writes where it is told by whole paths only.
PAPILLA_PICTURE=$(realpath -m "$out/blender.png") PAPILLA_WORK=$(realpath -m "$runs/blender") \
  PAPILLA_PROGRAM=$(realpath "$bin/papilla") PAPILLA_ADDON=$(realpath "$bin/../blender/papilla_blender.zip") \
  PAPILLA_MATERIAL_LIBRARY=$(realpath "$make/../../data/materials") "$make/../../tests/blender/run_blender.sh" window
cp "$runs/meshing/charts.png" "$out/charts.png"
cp "$runs/texture/grain/symmetry.png" "$out/symmetry.png"
cp "$runs/param/evaluate-param-1.svg" "$out/evaluate-param.svg"
cp "$runs/study/pictures/dimension-psychometric.svg" "$out/study.svg"
for sheet in types library; do
  "$bin/papilla" texture --sheet "$sheet" -o "$runs/sheet-$sheet" --quiet
  oiiotool "$runs/sheet-$sheet/sheet.png" --compression jpeg:90 -o "$out/texture-$sheet.jpg"
done

# Four photographs of one grain, the relief of them and the confidence.
grain=$runs/photographs
mkdir -p "$grain"
"$bin/papilla" synthesize grain --kind quads8 --size 400 -o "$grain/grain.png" --relief "$grain/truth.exr" --quiet
seed=0
while read -r name light; do
  seed=$((seed + 1))
  "$bin/papilla" synthesize photo "$grain/truth.exr" -o "$grain/$name.jpg" "--light=$light" --albedo-noise 0.08 --uneven-light 0.15 \
    --vignette 0.1 --blur-px 0.7 --noise 0.01 --seed $seed --quiet
done <<<"right 0.77,0,0.64
below 0,0.77,0.64
left -0.77,0,0.64
above 0,-0.77,0.64"
echo '{"lights": [[0.77, 0, 0.64], [0, 0.77, 0.64], [-0.77, 0, 0.64], [0, -0.77, 0.64]]}' >"$grain/lights.json"
"$bin/papilla" height "$grain"/{right,below,left,above}.jpg --lights "$grain/lights.json" --pitch 0.1 -o "$grain/relief.exr" \
  --pictures "$grain/report" --quiet
oiiotool --pattern constant:color=1,1,1 800x200 3 \
  "$grain/right.jpg" --ch 0,0,0 --resize 200x200 --swap --paste +0+0 "$grain/below.jpg" --ch 0,0,0 --resize 200x200 --swap --paste +200+0 \
  "$grain/left.jpg" --ch 0,0,0 --resize 200x200 --swap --paste +400+0 "$grain/above.jpg" --ch 0,0,0 --resize 200x200 --swap --paste +600+0 \
  --compression jpeg:90 -d uint8 -o "$out/four-photographs.jpg"
oiiotool "$grain/report/relief.png" --compression jpeg:90 -o "$out/four-photographs-relief.jpg"

node "$make/force_models.mjs" "$make/../evidence/forces.md" "$out/force-models.svg"
node "$make/texture_gallery.mjs" "$bin" docs
node "$make/screenshot.mjs" "$report/index.html" "$out/report-page.png"
