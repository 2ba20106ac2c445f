#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The player feels what bake wrote: player_contact_test.sh PLAYER FILE.glb
set -eu
command -v node >/dev/null || exit 77
# A machine that is busy pauses the loop, which is no fault of what is felt.
for _ in {1..30}; do
  json=$("$1" "$2" --device sim --seconds 1 --json -)
  if node -e 'process.exit(JSON.parse(process.argv[1]).pauses.count ? 1 : 0)' "$json"; then break; fi
done
node -e '
const r = JSON.parse(process.argv[1]);
const check = (ok, what) => { if (!ok) { console.error("FAILED: " + what + ": " + process.argv[1]); process.exit(1); } };
check(r.rate_hz === 1000 && r.ticks === 1000, "one second at 1 kHz");
check(r.contact_ticks > 500, "contact most of the time");
check(r.lost_contact_ticks === 0, "no contact lost");
check(r.max_force_n > 0 && r.max_force_n <= 3.4, "force within the limit of the device");
check(r.height_maps.loaded > 0 && r.height_maps.missing === 0, "every height map found");
' "$json"
said=$("$1" "$2" --surface real --touched 1e30,0,0,0,1e30,0,0,0,1e30 2>&1) && { echo "FAILED: a place beyond 1000 km is taken"; exit 1; }
[[ $said == *"--touched: 1e30 is not from"* ]] || { echo "FAILED: $said"; exit 1; }
echo "contact as expected"
