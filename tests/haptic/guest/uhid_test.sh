#!/bin/sh
# SPDX-License-Identifier: MIT
# Boots a kernel with the player and fake HID devices under plain emulation. Exit code 77 when qemu, cpio or a kernel with
# uhid is missing. A kernel package that is only unpacked is found through PAPILLA_GUEST_KERNEL, the folder that holds
# its boot/ and lib/.
# usage: uhid_test.sh INIT PLAYER PLATE_MAKER
set -eu
init=$1 player=$2 make_plate=$3
root=${PAPILLA_GUEST_KERNEL:-/}

skip() { echo "skipped: $*"; exit 77; }
for tool in qemu-system-x86_64 cpio gzip ldd; do
  command -v "$tool" >/dev/null || skip "no $tool"
done
[ "$(uname -m)" = x86_64 ] || skip "no x86-64 machine"

kernel='' modules=''
for candidate in "$root"/boot/vmlinuz-*; do
  release=${candidate##*/vmlinuz-}
  for folder in "$root/lib/modules/$release" "$root/usr/lib/modules/$release"; do
    if [ -r "$candidate" ] && [ -r "$folder/kernel/drivers/hid/uhid.ko" ]; then
      kernel=$candidate modules=$folder
    fi
  done
done
[ -n "$kernel" ] || skip "no kernel with the module uhid in $root"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/root"
cp "$init" "$work/root/init"
cp "$player" "$work/root/player"
"$make_plate" "$work/root/plate.glb"
for module in hid hid-generic uhid; do
  [ ! -r "$modules/kernel/drivers/hid/$module.ko" ] || cp "$modules/kernel/drivers/hid/$module.ko" "$work/root/"
done
for library in $(ldd "$init" "$player" | grep -o '/[^ :]*' | grep '\.so' | sort -u); do
  mkdir -p "$work/root$(dirname "$library")"
  cp -L "$library" "$work/root$library"
done
(cd "$work/root" && find . | cpio -o -H newc 2>/dev/null | gzip -1) >"$work/initrd.gz"

timeout "${PAPILLA_GUEST_SECONDS:-240}" qemu-system-x86_64 -accel tcg,thread=multi -cpu max -m 512 -smp 2 -nographic \
  -no-reboot -nodefaults -serial stdio -kernel "$kernel" -initrd "$work/initrd.gz" \
  -append "console=ttyS0 panic=-1 tsc=unstable quiet" </dev/null >"$work/log" 2>&1 || true
grep -a '^guest:' "$work/log" || { cat "$work/log"; exit 1; }
grep -aq '^guest: all passed' "$work/log" || { cat "$work/log"; exit 1; }
