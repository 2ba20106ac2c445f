#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Programs and plug-ins are built so that a fault of memory is hard to use: position independent, full RELRO, no executable stack, stack
# protectors, _FORTIFY_SOURCE, and on x86-64 landing pads for indirect jumps. usage: check_hardening.sh PROGRAM...
set -euo pipefail

breaches=0
breach() {
  echo "$1: $2"
  breaches=$((breaches + 1))
}

for program in "$@"; do
  header=$(readelf -hW "$program") segments=$(readelf -lW "$program")
  dynamic=$(readelf -dW "$program") symbols=$(readelf -W --dyn-syms "$program")
  grep -qE 'Type: +DYN' <<<"$header" || breach "$program" 'is not position independent'
  grep -q 'GNU_RELRO' <<<"$segments" || breach "$program" 'has no RELRO'
  grep -qE 'BIND_NOW|Flags:.*NOW' <<<"$dynamic" || breach "$program" 'binds symbols late, so that RELRO is partial'
  grep -qE 'GNU_STACK.* RW ' <<<"$segments" || breach "$program" 'has an executable stack'
  grep -q '__stack_chk_fail' <<<"$symbols" || breach "$program" 'has no stack protector'
  grep -qE '__[a-z]+_chk(@|$)' <<<"$symbols" || breach "$program" 'has no _FORTIFY_SOURCE'
  if grep -q 'X86-64' <<<"$header"; then
    # Functions of the start-up files have some, too.
    pads=$(objdump -d --no-show-raw-insn "$program" | grep -c 'endbr64') || true
    ((pads > 100)) || breach "$program" "has $pads landing pads only"
  fi
done
((breaches == 0))
