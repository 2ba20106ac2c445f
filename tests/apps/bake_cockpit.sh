#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Bakes the sample cockpit, coarsely: bake_cockpit.sh PAPILLA DATA_FOLDER OUTPUT_FOLDER
set -eu
papilla=$1 data=$2 out=$3
rm -rf "$out"
mkdir -p "$out/grain"
cp "$data/cockpit.materials.json" "$out/materials.json"
for kind in $(sed -n 's/.*"grain\/\([a-z0-9]*\)\.png".*/\1/p' "$out/materials.json" | sort -u); do
  "$papilla" synthesize grain --kind "$kind" --size 128 -o "$out/grain/$kind.png" --quiet
done
"$papilla" bake "$data/cockpit.step" -m "$out/materials.json" -o "$out/cockpit.glb" --chord 0.5 --report "$out/report" --pictures
test -s "$out/report/index.html"
for picture in scene scene-checker uv-dash_skin relief-leather; do
  test -s "$out/report/$picture.png"
done
test -s "$out/report/report.json"
