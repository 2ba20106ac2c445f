#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run_blender.sh MODULE...: runs in_blender.py; 77 where there is no Blender.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if ! command -v blender >/dev/null; then
  echo "there is no program blender: ./run test installs Debian's"
  exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Add-ons and settings of this run go where no other Blender looks.
export BLENDER_USER_RESOURCES=$scratch BLENDER_USER_SCRIPTS=$scratch/scripts BLENDER_USER_CONFIG=$scratch/config
mkdir -p "$PAPILLA_WORK" "$scratch/scripts/addons" "$scratch/config"
blender -b --factory-startup --python-exit-code 1 --python "$here/in_blender.py" -- "$@"
