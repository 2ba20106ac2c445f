#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Bakes knobs with grain in every coding, for readers of others: bake_compressed.sh PAPILLA DATA FOLDER
set -euo pipefail
papilla=$1 data=$2
rm -rf "$3" && mkdir -p "$3" && cd "$3"
cat >rules.json <<'JSON'
{"materials": {"cap": {"texture": "grain:leather", "size_mm": [30, 20], "stiffness": 600},
               "column": {"texture": "wood", "size_mm": [60, 40], "stiffness": 900}},
 "assign": [{"part": "knob_cap", "material": "cap"}, {"part": "steering_column", "material": "column"}]}
JSON
for coding in none meshopt draco quantize; do
  "$papilla" bake "$data/exchange/knobs.step" -m rules.json -o "$coding.glb" --effort fast --compress "$coding" \
    --images webp --cache cache -q
done
