#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run_blender.sh NAME: runs NAME_test.py in Blender without a window, or in_window.py in one; 77 where there is no Blender.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if ! command -v blender >/dev/null; then
  echo "there is no program blender: ./run test installs Debian's"
  exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Add-ons and settings of this run go where no other Blender looks.
export BLENDER_USER_SCRIPTS=$scratch/scripts BLENDER_USER_CONFIG=$scratch/config
mkdir -p "$PAPILLA_WORK" "$scratch/scripts/addons" "$scratch/config"
if [[ $1 != window ]]; then
  blender -b --factory-startup --python-exit-code 1 --python "$here/in_blender.py" -- "$1_test"
  exit
fi
if ! command -v Xvfb >/dev/null; then
  echo "there is no program Xvfb: ./run test installs it"
  exit 77
fi
said=$scratch/said
Xvfb -displayfd 1 -screen 0 1280x900x24 -nolisten tcp >"$scratch/display" 2>/dev/null &
trap 'kill $! 2>/dev/null; wait $! 2>/dev/null || true; rm -rf "$scratch"' EXIT
for _ in {1..300}; do
  [[ -s $scratch/display ]] && break
  sleep 0.1
done
DISPLAY=:$(<"$scratch/display") LIBGL_ALWAYS_SOFTWARE=1 blender --factory-startup --enable-event-simulate \
  --window-geometry 0 0 1280 900 --python "$here/in_window.py" 2>&1 | tee "$said"
if grep -q Traceback "$said"; then
  echo "FAILED: a panel could not be drawn"
  exit 1
fi
