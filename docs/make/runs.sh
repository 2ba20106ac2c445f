#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the programs on data of their own for the pictures and curves of docs/methods: runs.sh BIN DATA FOLDER
set -euo pipefail
bin=$1 data=$2 out=$3
make=$(dirname "${BASH_SOURCE[0]}")
papilla() { "$bin/papilla" "$@" --quiet; }
evaluate() { papilla evaluate "$@" --seconds 60; }
mkdir -p "$out"/{unwrap,texture,meshing,contact}

# Maps of one chart.
awk -f "$make/sheet.awk" >"$out/sheet.obj"
for method in auto best maillot levy lscm arap tutte mvc; do
  papilla unwrap "$out/sheet.obj" --method "$method" --charts keep -o "$out/unwrap/$method.glb" --picture "$out/unwrap/$method.png"
done
for method in triplanar planar intermediate environment; do
  papilla unwrap "$out/sheet.obj" --method "$method" -o "$out/unwrap/$method.glb" --picture "$out/unwrap/$method.png"
done
papilla tessellate "$data/cockpit.step" -o "$out/cockpit.glb" --chord 1
papilla unwrap "$data/cockpit.step" --chord 1 --method natural -o "$out/unwrap/natural.glb" --picture "$out/unwrap/natural.png"
papilla unwrap "$out/cockpit.glb" -o "$out/meshing/charts.glb" --picture "$out/meshing/charts.png" --trace "$out/meshing/charts.csv"
evaluate param "$out/sheet.obj" -o "$out/param"
evaluate charts "$out/sheet.obj" -o "$out/charts"

# Surfaces of known dimension, a lit grain with its true relief.
for dimension in 2.2 2.5 2.8; do
  papilla synthesize fractal --dimension "$dimension" --size 1025 -o "$out/texture/fractal-$dimension.png"
done
papilla synthesize grain --kind quads6 --size 256 -o "$out/texture/grain.png" --relief "$out/texture/grain.exr"
papilla synthesize grain --kind spheres6 --size 512 -o "$out/texture/lattice.png"
evaluate fractal "$out/texture/fractal-2.5.png" -o "$out/fractal"
evaluate symmetry "$out/texture/lattice.png" -o "$out/symmetry"
evaluate height "$out/texture/grain.exr" -o "$out/height"
papilla analyze "$out/texture/grain.png" --pitch 0.1 --pictures "$out/texture/grain"
for method in variational pentland tsai-shah intensity; do
  papilla height "$out/texture/grain.png" --pitch 0.15625 --method "$method" -o "$out/texture/$method.exr" --pictures "$out/texture/$method"
done

# CAD to triangles and on.
evaluate tessellation "$data/cockpit.step" -o "$out/tessellation"
awk -f "$make/soup.awk" "$out/sheet.obj" >"$out/soup.obj"
evaluate weld "$out/soup.obj" -o "$out/weld"
evaluate simplification "$out/sheet.obj" -o "$out/simplification"
papilla repair "$out/soup.obj" -o "$out/meshing/repaired.obj" --weld 1
papilla simplify "$out/sheet.obj" -o "$out/meshing/simplified.obj" --tolerance 0.5
for chord in 10 1; do papilla tessellate "$data/cockpit.step" -o "$out/meshing/chord-$chord.glb" --chord "$chord"; done
papilla inspect "$out/sheet.obj" --picture "$out/meshing/sheet.png"
papilla inspect "$out/soup.obj" --picture "$out/meshing/soup.png"
for mesh in repaired.obj simplified.obj chord-10.glb chord-1.glb; do
  papilla inspect "$out/meshing/$mesh" --picture "$out/meshing/${mesh%.*}.png"
done

# A stroke over leather.
for kind in $(sed -n 's/.*"grain\/\([a-z0-9]*\)\.png".*/\1/p' "$data/cockpit.materials.json" | sort -u); do
  mkdir -p "$out/contact/grain"
  papilla synthesize grain --kind "$kind" -o "$out/contact/grain/$kind.png"
done
cp "$data/cockpit.materials.json" "$out/contact/materials.json"
papilla bake "$data/cockpit.step" -m "$out/contact/materials.json" -o "$out/contact/cockpit.glb" --chord 0.5
evaluate contact "$out/contact/cockpit.glb" -o "$out/contact-evaluation"
play() { "$bin/papilla-player" "$out/contact/cockpit.glb" --quiet "$@"; }
play --seconds 2 --record "$out/contact/stroke.csv"
reports=() controlled=()
for device in $("$bin/papilla-player" --list-devices --json - | sed -n 's/.*"device": "\(sim:[^"]*\)".*/\1/p'); do
  report=$out/contact/${device#sim:}
  play --seconds 1 --device "$device" --motion tap --json "$report.json" --record "$report.csv"
  play --seconds 1 --device "$device" --motion tap --passivity-control --json "$report-controlled.json" --record "$report-controlled.csv"
  reports+=("$report.json") controlled+=("$report-controlled.json")
done
node "$make/devices_csv.mjs" "$out/contact/devices.csv" "${reports[@]}"
node "$make/devices_csv.mjs" "$out/contact/controlled.csv" "${controlled[@]}"

# Three simulated participants of known thresholds choose the rougher of two surfaces.
papilla study new -o "$out/study" --experiments dimension --models lateral,orthogonal --repetitions 8 --participants 3
papilla study simulate "$out/study/STUDY.json" -o "$out/study/simulated" --seed 7
papilla study analyse "$out/study/STUDY.json" "$out"/study/simulated/*.csv --pictures "$out/study/pictures"
